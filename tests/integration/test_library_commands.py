"""`stridewire library`: a folder of files becomes a library, each bad file a sentence."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from tests.unit.building.figures import source

from stridewire.formats.bvh_writing import write_source_bvh
from stridewire_engine.commands.library import library


def run(*args: str | Path) -> Result:
    """Run the command."""
    return CliRunner().invoke(library, [str(arg) for arg in args])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with two walks, a walk on a rig of Z up, and two files that are none."""
    folder = tmp_path / "in"
    folder.mkdir()
    for name, motion in {
        "walk": source(),
        "slow": source(frame_rate=30.0),
        "zup": source(scale=39.37, z_up=True),
    }.items():
        write_source_bvh(folder / f"{name}.bvh", replace(motion, path=folder / f"{name}.bvh"))
    (folder / "broken.bvh").write_text("MOTION\n")
    (folder / "readme.txt").write_text("no motion")
    text = (folder / "walk.bvh").read_text()
    (folder / "short.bvh").write_text("\n".join(text.split("\n")[:-239]))
    return folder


def test_build_says_of_each_file_what_became_of_it(folder: Path, tmp_path: Path) -> None:
    """Good files are imported, bad ones named with the reason, and the library opens."""
    result = run("build", folder, "--out", tmp_path / "lib", "--licence", "mine", "--jobs", "1")
    assert result.exit_code == 0, result.output
    assert "imported 3 of 5 files (2 in cm, 1 in inch), refused 2" in result.output
    assert f"refused: {folder / 'broken.bvh'}" in result.output
    assert "expected at least 0.25 s" in result.output
    assert "zup.bvh: Z is up" in result.output
    info = run("info", tmp_path / "lib", "--json")
    facts = json.loads(info.output)
    assert facts["clips"] == 6
    assert facts["licence"] == "mine"
    assert facts["seconds_by_tag"]["walk"] > 0.0


def test_a_giant_needs_its_unit(tmp_path: Path) -> None:
    """Refused with the option that helps; with it imported; an unknown unit is a usage error."""
    giant = tmp_path / "giant.bvh"
    write_source_bvh(giant, source(scale=185.0))
    refused = run("build", giant, "--out", tmp_path / "lib")
    assert "--unit" in refused.output
    assert refused.exit_code == 1
    assert run("build", giant, "--out", tmp_path / "lib", "--unit", "cm").exit_code == 0
    assert run("build", giant, "--out", tmp_path / "lib", "--unit", "cow").exit_code == 2
    assert "--unit" in run("profile", giant).output


def test_build_without_a_single_good_file_fails(folder: Path, tmp_path: Path) -> None:
    """Nothing is written, and the exit status says so."""
    result = run("build", folder / "broken.bvh", "--out", tmp_path / "lib")
    assert result.exit_code == 1
    assert "no clip is left" in result.output
    assert not (tmp_path / "lib").exists()


def test_build_by_split(folder: Path, tmp_path: Path) -> None:
    """Only files of the split are taken; an unknown split is a usage error that names the known."""
    splits = tmp_path / "split.csv"
    splits.write_text("data,subject,split\nin,*,train\n")
    args = ("build", folder, "--out", tmp_path / "lib", "--split-file", splits, "--split")
    assert run(*args, "train").exit_code == 0
    unknown = run(*args, "test")
    assert unknown.exit_code == 2
    assert "has train" in unknown.output
    assert run(*args[:-1]).exit_code == 2


def test_build_of_tagged_clips_only(folder: Path, tmp_path: Path) -> None:
    """Clips without the tag are left out."""
    result = run("build", folder / "walk.bvh", "--out", tmp_path / "lib", "--tagged", "run")
    assert result.exit_code == 1
    assert "kept 0 clips of run" in result.output


def test_report_draws_and_says_what_is_missing(folder: Path, tmp_path: Path) -> None:
    """A table, a picture, and what to capture next."""
    run("build", folder / "walk.bvh", "--out", tmp_path / "lib", "--jobs", "1")
    result = run("report", tmp_path / "lib", "--out", tmp_path / "report.png")
    assert result.exit_code == 0, result.output
    assert "capture next:" in result.output
    assert (tmp_path / "report.png").stat().st_size > 10_000
    facts = json.loads(run("report", tmp_path / "lib", "--json").output)
    assert {row["tag"] for row in facts["wanted"]} >= {"run", "idle"}
    assert facts["clips"][0]["name"] == "walk"


def test_profile_prints_a_draft_that_build_takes(folder: Path, tmp_path: Path) -> None:
    """The draft goes back in with --profile."""
    draft = tmp_path / "mine.toml"
    result = run("profile", folder / "zup.bvh", "--out", draft)
    assert result.exit_code == 0, result.output
    assert "the motion has Z up" in draft.read_text()
    built = run("build", folder / "walk.bvh", "--out", tmp_path / "lib", "--profile", draft)
    assert built.exit_code == 0, built.output


def test_profile_of_no_human_says_why(folder: Path) -> None:
    """The reason of the refusal is the message."""
    result = run("profile", folder / "broken.bvh")
    assert result.exit_code == 1
    assert "names no joint" in result.output


def test_info_of_no_library_says_how_to_build_one(tmp_path: Path) -> None:
    """The message has a command."""
    result = run("info", tmp_path / "nothing")
    assert result.exit_code == 1
    assert "stridewire library build" in result.output
