"""What is refused, told by field, before anything is stitched."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from stridewire._errors import InvalidRequestError
from stridewire._messages import BvhText, ClipSpan, RootPath, StitchQuery
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.library import Library
from stridewire_engine.stitching import answer
from unit.stitching.clips import broken, cuts_of, nan

TIMES = np.linspace(0.0, 100.0, 5)
WAY = np.zeros((5, 2))


def refuse_bvh(text: str, name: str) -> Clip:
    """Stand for a reader that finds nothing to read."""
    raise ValueError(f"{name}: no MOTION section")


def refused(library: Library, query: StitchQuery) -> dict[str, str]:
    """Return what is wrong with a query, by field."""
    with pytest.raises(InvalidRequestError) as raised:
        answer(lambda _: library, refuse_bvh, query)
    return {v.field: v.description for v in raised.value.violations}


@pytest.mark.parametrize(
    ("given", "field", "said"),
    [
        ({"stitcher": "glue"}, "stitcher", "stance"),
        ({"window_s": 0.05}, "window_s", "0.1 to 2"),
        ({"window_s": 2.1}, "window_s", "0.1 to 2"),
        ({"window_s": float("nan")}, "window_s", "0.1 to 2"),
        ({"window_s": 0.4, "shift_s": 0.5}, "shift_s", "to window_s, 0.4"),
        ({"shift_s": 0.0}, "shift_s", "more than 0"),
        ({"passes": 0}, "passes", "1 to 8"),
        ({"passes": 9}, "passes", "1 to 8"),
        ({"search_frames": 61}, "search_frames", "to 60"),
        ({"search_frames": -1}, "search_frames", "to 60"),
        ({"strength": 1.1}, "strength", "0 to 1"),
        ({"strength": float("nan")}, "strength", "0 to 1"),
        ({"joint_mask": {"Tail": 1.0}}, "joint_mask[Tail]", "no such joint"),
        ({"joint_mask": {"Head": 2.0}}, "joint_mask[Head]", "0 to 1"),
        ({"start_s": -1.0}, "start_s", "from 0"),
        ({"start_s": 2.0, "end_s": 1.0}, "end_s", "not after"),
        ({"path": RootPath(WAY[:1], TIMES[:1])}, "path.positions_xz", "2 to"),
        ({"path": RootPath(WAY[:4], TIMES)}, "path.positions_xz", "for 5 times"),
        ({"path": RootPath(WAY * np.nan, TIMES)}, "path.positions_xz", "not finite"),
        ({"path": RootPath(WAY, TIMES[::-1])}, "path.times_s", "ascending"),
        ({"path": RootPath(WAY, TIMES / 100.0)}, "path.times_s", "the motion lasts"),
        ({"path": RootPath(WAY, TIMES, TIMES[:2])}, "path.facings_yaw", "5 finite"),
    ],
)
def test_numbers(small_library: Library, given: dict[str, Any], field: str, said: str) -> None:
    """Out of range, none, or for something that is not there."""
    wrong = refused(small_library, StitchQuery(cuts_of(small_library), **given))
    assert list(wrong) == [field]
    assert said in wrong[field]


@pytest.mark.parametrize("count", [0, 1, 65, 10_000])
def test_the_number_of_clips(small_library: Library, count: int) -> None:
    """Two to 64; ten thousand are refused before one is looked up."""
    wrong = refused(small_library, StitchQuery([ClipSpan("nobody")] * count))
    assert f"{count} clips; allowed are 2 to 64" in wrong["clips"]


@pytest.mark.parametrize("frames", range(1, 10))
def test_clips_of_less_than_ten_frames(small_library: Library, frames: int) -> None:
    """Each is named with its number of frames."""
    clips = cuts_of(small_library)
    wrong = refused(small_library, StitchQuery([clips[0], clips[1].cut(0, frames)]))
    assert f"{frames} frames at 60 frames/s; expected at least 10" in wrong["clips[1]"]


def test_ten_frames_are_enough(small_library: Library) -> None:
    """At 60 frames/s, and at any rate that makes as many at 60."""
    clips = cuts_of(small_library, frames=10)
    slow = replace(clips[1].cut(0, 6), frame_rate=30.0)
    answer(lambda _: small_library, refuse_bvh, StitchQuery([clips[0], slow, *clips[1:]]))


@pytest.mark.parametrize("name", ["root_position", "root_rotation", "hips", "rotations"])
def test_numbers_that_are_none(small_library: Library, name: str) -> None:
    """A NaN in a clip that was sent is named by clip and block."""
    clips = cuts_of(small_library)
    bad = broken(clips[1], **{name: nan})
    wrong = refused(small_library, StitchQuery([clips[0], bad]))
    block = "root" if name.startswith("root") else name
    assert list(wrong) == [f"clips[1].inline.poses.{block}"]


def test_clips_of_other_skeletons(small_library: Library) -> None:
    """Named, with what to do; a skeleton without toes cannot be stitched at all."""
    clips = cuts_of(small_library)
    bigger = replace(clips[1], skeleton=clips[1].skeleton.scaled(1.1))
    wrong = refused(small_library, StitchQuery([clips[0], bigger]))
    assert "give BVH text" in wrong["clips[1]"]
    names = tuple(n.replace("Toe", "Flipper") for n in clips[0].skeleton.names)
    odd = Skeleton(names, clips[0].skeleton.parents, clips[0].skeleton.offsets)
    strange = [replace(c, skeleton=odd) for c in clips]
    wrong = refused(small_library, StitchQuery(strange))
    assert "lacks LeftToe, RightToe" in wrong["clips[0].inline"]


def test_text_that_is_no_motion(small_library: Library) -> None:
    """What the reader says, under the clip's field."""
    wrong = refused(small_library, StitchQuery([BvhText("hello"), cuts_of(small_library)[0]]))
    assert "no MOTION section" in wrong["clips[0].bvh"]


def test_spans_outside_of_their_clip(small_library: Library) -> None:
    """Named with how long the clip is."""
    name = small_library.clips[0].name
    wrong = refused(small_library, StitchQuery([ClipSpan(name), ClipSpan(name, 2.0, 1e6)]))
    assert "goes from 0 to" in wrong["clips[1].span"]
