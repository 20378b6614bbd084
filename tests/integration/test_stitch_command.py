"""`stridewire stitch`: files in, one motion out, mistakes in one line."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from stridewire.commands import main
from stridewire.formats.bvh_writing import write_bvh
from stridewire.formats.reading import read_motion
from stridewire_engine.library import Library


@pytest.fixture
def files(small_library: Library, tmp_path: Path) -> list[Path]:
    """Return BVH files of three pieces of synthetic clips."""
    pieces = (("walk-1.4", 110, 230), ("walk-1.7", 150, 250), ("walk-1.4", 170, 300))
    paths = []
    for i, (name, start, end) in enumerate(pieces):
        paths.append(tmp_path / f"{i}.bvh")
        write_bvh(paths[-1], small_library.clip(name).cut(start, end))
    return paths


def run(*arguments: object) -> Result:
    """Run the command line in this process."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def test_files_become_one_motion(files: list[Path], tmp_path: Path) -> None:
    """The frames of all, at 60 frames/s; seams, methods, figures before and after are told."""
    out = tmp_path / "out.bvh"
    done = run("stitch", *files, "--out", out, "--json")
    assert done.exit_code == 0, done.output
    facts = json.loads(done.stdout)
    assert facts["frames"] == 350 == len(read_motion(out))
    assert [seam["frame"] for seam in facts["seams"]] == [120, 220]
    assert facts["after"]["seam_step_cm_s"] < 0.2 * facts["before"]["seam_step_cm_s"]
    assert read_motion(out).frame_rate == pytest.approx(60.0)


def test_it_tells_people(files: list[Path], tmp_path: Path) -> None:
    """A table of figures and a line a seam."""
    done = run("stitch", *files, "--out", tmp_path / "out.bvh", "--stitcher", "spring")
    assert done.exit_code == 0, done.output
    assert "seam at 2.00 s: spring" in done.output
    assert "sliding of planted toes" in done.output


def test_spans_searches_and_pictures(files: list[Path], tmp_path: Path) -> None:
    """FILE@START-END takes a part; a search leaves frames out; a pair of sheets a seam."""
    out, sheets = tmp_path / "out.bvh", tmp_path / "sheets"
    cuts = (f"{files[0]}@0-1", f"{files[2]}@0.5-1.5")
    options = ("--search-seam", 10, "--sheets", sheets, "--json")
    done = run("stitch", *cuts, "--out", out, *options)
    assert done.exit_code == 0, done.output
    facts = json.loads(done.stdout)
    (seam,) = facts["seams"]
    assert facts["frames"] == 122 - seam["cut_before"] - seam["cut_after"]
    assert sorted(p.name for p in sheets.iterdir()) == [
        "out-seam-1-after.png",
        "out-seam-1-before.png",
    ]


def test_a_path_is_imposed(files: list[Path], tmp_path: Path) -> None:
    """The hips stay above the path that a CSV gives."""
    out, path = tmp_path / "out.bvh", tmp_path / "path.csv"
    path.write_text("0,0,0\n3,0,3.5\n6,0,7\n")
    done = run("stitch", files[0], files[2], "--out", out, "--path", path)
    assert done.exit_code == 0, done.output
    end = read_motion(out).root_positions[-1] / 100.0
    assert end[2] == pytest.approx(3.5 * (249 / 60) / 3, abs=0.1)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--strength", 2), "strength: 2; allowed are 0 to 1"),
        (("--passes", 0), "passes: 0; allowed are 1 to 8"),
        (("--window", 0.4, "--shift", 0.5), "shift_s: 0.5"),
        (("--mask", "Tail=1"), "no joint 'Tail'"),
        (("--path", "PATH"), "expected seconds, x, z"),
        (("absent.bvh",), "absent.bvh"),
        (("FILE@1-99",), "lasts from 0 to"),
        (("FILE@0-0.1",), "7 frames at 60 frames/s; expected at least 10"),
    ],
)
def test_mistakes_are_named(
    files: list[Path], tmp_path: Path, options: tuple[object, ...], said: str
) -> None:
    """One line that says what was given and what is expected, and no file."""
    out, path = tmp_path / "out.bvh", tmp_path / "path.csv"
    path.write_text("0,1\n1,2\n")
    given = [str(o).replace("FILE", str(files[0])).replace("PATH", str(path)) for o in options]
    done = run("stitch", files[0], files[1], *given, "--out", out)
    assert done.exit_code != 0
    assert said in done.output
    assert "Traceback" not in done.output
    assert not out.exists()


def test_other_skeletons_are_brought_onto_the_reference(capture: Path, tmp_path: Path) -> None:
    """Files of different captures become one motion on one skeleton."""
    files = [
        next((capture / "lafan1" / "clips").glob("walk*.bvh")),
        next((capture / "exporters" / "pfnn").rglob("*.bvh")),
    ]
    done = run("stitch", *files, "--out", tmp_path / "out.bvh", "--json")
    assert done.exit_code == 0, done.output
    rotations = read_motion(tmp_path / "out.bvh").rotations
    assert np.isfinite(rotations).all()
    assert rotations.shape[1] == 22
