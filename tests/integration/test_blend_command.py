"""`stridewire blend` and its kin: files in, a BVH out, mistakes in one line."""

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
def walk(small_library: Library, tmp_path: Path) -> Path:
    """Return a BVH file of a synthetic clip."""
    path = tmp_path / "walk.bvh"
    write_bvh(path, small_library.clip(small_library.clips[0].name))
    return path


def run(*arguments: object) -> Result:
    """Run the command line in this process."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def test_two_moments_become_a_file(walk: Path, tmp_path: Path) -> None:
    """A frame for each weight; the ends are the frames of the source."""
    out = tmp_path / "between.bvh"
    done = run("blend", "--start", f"{walk}@0.5", "--end", f"{walk}@1", "--out", out, "--json")
    assert done.exit_code == 0, done.output
    facts = json.loads(done.output)
    assert (facts["frames"], facts["method"]) == (5, "neural")
    source, blended = read_motion(walk), read_motion(out)
    assert len(blended) == 5
    for at, frame in ((0, 30), (-1, 60)):
        dots = np.abs(np.sum(blended.rotations[at] * source.rotations[frame], axis=-1))
        np.testing.assert_allclose(dots, 1.0, atol=1e-4)


def test_the_linear_method_and_a_mask(walk: Path, tmp_path: Path) -> None:
    """Options reach the blend: the head keeps the start's rotation."""
    out = tmp_path / "between.bvh"
    ends = ("--start", f"{walk}@0.5", "--end", f"{walk}@1")
    options = ("--method", "slerp", "--mask", "Head=0", "--weights", "0,1")
    done = run("blend", *ends, *options, "--out", out)
    assert done.exit_code == 0, done.output
    assert "slerp" in done.output
    blended = read_motion(out)
    head = blended.skeleton.index("Head")
    np.testing.assert_allclose(blended.rotations[0, head], blended.rotations[1, head], atol=1e-4)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--weights", "0,2"), "expected numbers from 0 to 1"),
        (("--weights", "half"), "expected numbers from 0 to 1"),
        (("--mask", "Tail=1"), "no joint 'Tail'"),
        (("--mask", "Head=7"), "a share from 0 to 1"),
        (("--mask", "Head=0", "--mask", "Head=1"), "Head is given 2 times"),
        (("--start", "walk.bvh"), "expected FILE@SECONDS"),
        (("--start", "WALK@1e9"), "lasts from 0 to"),
        (("--start", "absent.bvh@1"), "absent.bvh"),
    ],
)
def test_mistakes_are_named(
    walk: Path, tmp_path: Path, options: tuple[str, ...], said: str
) -> None:
    """One line that says what was given and what is expected, and no file."""
    out = tmp_path / "between.bvh"
    given = [option.replace("WALK", str(walk)) for option in options]
    done = run("blend", "--start", f"{walk}@0.5", "--end", f"{walk}@1", *given, "--out", out)
    assert done.exit_code != 0
    assert said in done.output
    assert not out.exists()


def test_absent_data_is_named(tmp_path: Path) -> None:
    """Evaluating and training without split.csv say what the folder should hold."""
    pytest.importorskip("torch")
    for command in (("evaluate", "blend"), ("train", "blend", "--out", tmp_path / "run")):
        done = run(*command, "--data", tmp_path)
        assert done.exit_code != 0
        assert "no split.csv" in done.output


def test_an_empty_run_is_named(tmp_path: Path) -> None:
    """Exporting a folder that is no run says what it should be."""
    pytest.importorskip("torch")
    done = run("export", "blend", tmp_path, "--data", tmp_path)
    assert done.exit_code != 0
    assert "stridewire train blend --out" in done.output
