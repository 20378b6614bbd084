"""`stridewire render`: motion in, pictures out, errors in a sentence."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from stridewire.commands import main
from stridewire.formats.bvh_writing import write_bvh
from stridewire.formats.writing import write_clip
from stridewire.motion.clip import Clip


@pytest.fixture
def bvh(tmp_path: Path, swaying_clip: Clip) -> Path:
    """Return the swaying clip as a file."""
    write_bvh(tmp_path / "sway.bvh", swaying_clip)
    return tmp_path / "sway.bvh"


def test_the_picture_lies_beside_the_motion_by_default(bvh: Path) -> None:
    """Without --out the ending changes; what was drawn is said."""
    result = CliRunner().invoke(main, ["render", str(bvh)])
    assert result.exit_code == 0, result.output
    assert bvh.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    assert "2.0 s" in result.output
    assert "121 frames" in result.output


def test_a_rate_replaces_that_of_the_file(bvh: Path) -> None:
    """At half the rate the motion lasts twice as long."""
    result = CliRunner().invoke(main, ["render", str(bvh), "--rate", "30"])
    assert "4.0 s" in result.output


def test_json_is_one_object(bvh: Path, tmp_path: Path) -> None:
    """Programs read what was drawn, of the span asked for."""
    out = tmp_path / "out.png"
    arguments = ["render", str(bvh), "--out", str(out), "--start", "0.5", "--end", "1.0", "--json"]
    result = CliRunner().invoke(main, arguments)
    facts = json.loads(result.output)
    assert (facts["picture"], facts["frames"], facts["joints"]) == (str(out), 31, 22)
    assert out.exists()


def test_animate_writes_a_moving_picture(bvh: Path, tmp_path: Path) -> None:
    """Of the span asked for; the contact sheet is left out."""
    out = tmp_path / "sway.webp"
    arguments = ["render", str(bvh), "--animate", str(out), "--end", "0.2", "--json"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    assert json.loads(result.output)["picture"] == str(out)
    assert out.read_bytes()[8:12] == b"WEBP"
    assert not bvh.with_suffix(".png").exists()


def test_a_glb_is_drawn(tmp_path: Path, swaying_clip: Clip) -> None:
    """Any format that can be read."""
    write_clip(tmp_path / "sway.glb", swaying_clip)
    result = CliRunner().invoke(main, ["render", str(tmp_path / "sway.glb")])
    assert result.exit_code == 0, result.output
    assert (tmp_path / "sway.png").exists()


@pytest.mark.parametrize(
    ("content", "arguments", "message"),
    [
        ("no bvh at all", [], "expected a BVH file"),
        (None, ["--rate", "0"], "--rate"),
        (None, ["--start", "5"], "holds no frame"),
        (None, ["--animate", "a.mp4"], "expected .webp or .gif"),
        (None, ["--animate", "a.gif", "--out", "a.png"], "give one"),
    ],
)
def test_what_cannot_be_drawn_is_a_sentence(
    bvh: Path, content: str | None, arguments: list[str], message: str
) -> None:
    """No traceback: a failing exit code and what is wrong."""
    if content is not None:
        bvh.write_text(content)
    result = CliRunner().invoke(main, ["render", str(bvh), *arguments])
    assert result.exit_code == 2
    assert message in result.output
    assert not bvh.with_suffix(".png").exists()


def test_a_missing_file_is_a_sentence(tmp_path: Path) -> None:
    """The name that was given is in the message."""
    result = CliRunner().invoke(main, ["render", str(tmp_path / "none.bvh")])
    assert result.exit_code == 1
    assert "none.bvh" in result.output
