"""Contact sheets: a PNG comes out, it shows what it should, and mistakes are named."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from stridewire import StridewireError
from stridewire.drawing import contact_sheet
from stridewire.drawing.palette import LEFT, PLANTED, RIGHT
from stridewire.drawing.strips import _lanes, _spans
from stridewire.motion.clip import Clip, TagSpan

PIXEL = 0.02
"""How far a channel of a pixel may be from the colour asked for."""


def pixels(picture: Path, colour: str, below: float = 0.0) -> int:
    """Count pixels of a colour in the part of a picture below a fraction of its height."""
    image = imread(picture)[..., :3]
    image = image[int(below * len(image)) :]
    return int(np.all(np.abs(image - to_rgb(colour)) < PIXEL, axis=-1).sum())


def test_a_sheet_shows_both_sides_and_planted_feet(tmp_path: Path, swaying_clip: Clip) -> None:
    """Colours of left, right and planted limbs are in the picture, in balance."""
    contact_sheet(swaying_clip, tmp_path / "sheet.png")
    left, right = (pixels(tmp_path / "sheet.png", c) for c in (LEFT, RIGHT))
    assert min(left, right) > 3000
    assert 0.5 < left / right < 2.0
    assert pixels(tmp_path / "sheet.png", PLANTED) > 300


def test_no_contact_no_disc(tmp_path: Path, swaying_clip: Clip) -> None:
    """Discs come from contacts: without them only the legend is green."""
    none = replace(swaying_clip, contacts=np.zeros_like(swaying_clip.contacts))
    contact_sheet(none, tmp_path / "sheet.png")
    assert pixels(tmp_path / "sheet.png", PLANTED, below=0.05) == 0


def test_columns_and_rows_make_the_size(tmp_path: Path, swaying_clip: Clip) -> None:
    """More rows are taller, fewer columns narrower; every size can be drawn."""
    contact_sheet(swaying_clip, tmp_path / "wide.png", columns=6, rows=1)
    contact_sheet(swaying_clip, tmp_path / "tall.png", columns=4, rows=3, title="three rows")
    wide, tall = imread(tmp_path / "wide.png").shape, imread(tmp_path / "tall.png").shape
    assert wide[1] > tall[1]
    assert wide[0] < tall[0]


@pytest.mark.parametrize("frames", [1, 2, 5])
def test_clips_shorter_than_the_sheet_are_drawn(
    tmp_path: Path, swaying_clip: Clip, frames: int
) -> None:
    """Frames repeat where there are fewer than panels."""
    contact_sheet(swaying_clip.cut(0, frames), tmp_path / "short.png")
    assert (tmp_path / "short.png").stat().st_size > 10_000


def test_same_clip_same_picture(tmp_path: Path, swaying_clip: Clip) -> None:
    """Nothing but the clip decides the pixels."""
    contact_sheet(swaying_clip, tmp_path / "one.png")
    contact_sheet(swaying_clip, tmp_path / "two.png")
    np.testing.assert_array_equal(imread(tmp_path / "one.png"), imread(tmp_path / "two.png"))


def test_too_few_columns_are_refused(tmp_path: Path, swaying_clip: Clip) -> None:
    """The strips below need four figures' width."""
    with pytest.raises(ValueError, match="4 or more columns"):
        contact_sheet(swaying_clip, tmp_path / "sheet.png", columns=2)


def test_without_matplotlib_the_error_says_what_to_install(
    tmp_path: Path, swaying_clip: Clip, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The base install has no matplotlib."""
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(StridewireError, match=r"pip install 'stridewire\[server\]'"):
        contact_sheet(swaying_clip, tmp_path / "sheet.png")


def test_planted_bars_are_runs_of_flags() -> None:
    """Runs at both ends and single frames are bars."""
    flags = np.array([1, 1, 0, 1, 0, 0, 1], bool)
    assert _spans(flags, 10.0) == [(0.0, 0.2), (0.3, 0.1), (0.6, 0.1)]


def test_tags_that_overlap_get_lanes_of_their_own() -> None:
    """A lane is used again when its tag has ended."""
    tags = (TagSpan("walk", 0, 100), TagSpan("turn", 20, 40), TagSpan("stop", 40, 60))
    assert _lanes(tags) == [0, 1, 1]
