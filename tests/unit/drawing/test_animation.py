"""Animated pictures: they move, keep time, show both sides, and repeat."""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image, ImageSequence

from stridewire import StridewireError
from stridewire.drawing import Subject, draw_animation
from stridewire.drawing.palette import LEFT, PLANTED, RIGHT
from stridewire.motion.clip import Clip

SHADES = 0.12
"""How far a channel may be off: pictures are packed with losses."""


@pytest.fixture
def subject(swaying_clip: Clip) -> Subject:
    """Return 0.4 s of the swaying clip."""
    return Subject.of_clip(swaying_clip).between(0.2, 0.6)


def pixels(picture: np.ndarray, colour: str) -> int:
    """Count pixels of about a colour."""
    return int(np.all(np.abs(picture - to_rgb(colour)) < SHADES, axis=-1).sum())


@pytest.mark.parametrize("ending", ["webp", "gif"])
def test_a_picture_moves_in_real_time(tmp_path: Path, subject: Subject, ending: str) -> None:
    """As many pictures as its time holds, each 0.05 s, all different, for ever."""
    path = tmp_path / f"a.{ending}"
    assert draw_animation(subject, path) == 8
    with Image.open(path) as image:
        pictures = [np.asarray(p.convert("RGB")) / 255.0 for p in ImageSequence.Iterator(image)]
        assert image.info["loop"] == 0
        assert image.info["duration"] == 50
    assert len(pictures) == 8
    for one, other in pairwise(pictures):
        assert np.abs(one - other).max() > 0.3
    left, right = (pixels(pictures[0], colour) for colour in (LEFT, RIGHT))
    assert min(left, right) > 1000


def test_planted_feet_have_discs(tmp_path: Path, subject: Subject) -> None:
    """Green where feet are planted, and only there."""
    seen = []
    for planted in (True, False):
        path = tmp_path / f"{planted}.webp"
        flags = np.full_like(subject.planted, planted)
        draw_animation(replace(subject, planted=flags), path)
        with Image.open(path) as image:
            seen.append(pixels(np.asarray(image.convert("RGB")) / 255.0, PLANTED))
    assert seen[0] > 20
    assert seen[1] == 0


def test_any_skeleton_is_drawn(tmp_path: Path, subject: Subject) -> None:
    """Without sides and without a head it is one dark figure."""
    plain = replace(subject, sides=np.zeros_like(subject.sides), head=None)
    draw_animation(plain.between(0.0, 0.1), tmp_path / "a.webp")
    with Image.open(tmp_path / "a.webp") as image:
        picture = np.asarray(image.convert("RGB")) / 255.0
    assert pixels(picture, LEFT) == 0
    assert pixels(picture, "#343a42") > 1000


def test_a_single_frame_is_a_picture(tmp_path: Path, subject: Subject) -> None:
    """The shortest motion there is."""
    assert draw_animation(subject.between(0.0, 0.0), tmp_path / "a.webp") == 1


def test_other_endings_are_refused(tmp_path: Path, subject: Subject) -> None:
    """Before anything is drawn, with those that can be written."""
    with pytest.raises(ValueError, match=r"a\.mp4; expected \.webp or \.gif"):
        draw_animation(subject, tmp_path / "a.mp4")


def test_without_matplotlib_the_error_says_what_to_install(
    tmp_path: Path, subject: Subject, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The base install has no matplotlib."""
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(StridewireError, match=r"pip install 'stridewire\[server\]'"):
        draw_animation(subject, tmp_path / "a.webp")
