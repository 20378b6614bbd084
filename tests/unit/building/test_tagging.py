"""Tags: speed, direction, turning and posture tell them; names of files add what they cannot."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.clip import Clip, TagSpan
from stridewire.motion.mirror import mirror_clip
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.tagging import file_tags, measured_tags, only_tagged, tag, without


def gliding(
    speed: Callable[[np.ndarray], np.ndarray] | float,
    angle: float = 0.0,
    turning: float = 0.0,
    height: float = 0.95,
    arms: float = 70.0,
    seconds: float = 6.0,
) -> Clip:
    """Return an upright figure that glides.

    Args:
        speed: m/s, or a function of time.
        angle: Direction of motion against the facing, degrees, positive to the left.
        turning: Degrees/s, positive to the left.
        height: Of the hips, metres.
        arms: How far they hang down from a T-pose, degrees.
        seconds: Length.
    """
    t = np.arange(round(60 * seconds)) / 60.0
    pace = speed(t) if callable(speed) else np.full(len(t), speed)
    yaw = np.deg2rad(turning) * t
    course = yaw + np.deg2rad(angle)
    step = pace[:, None] * np.stack([np.sin(course), 0 * t, np.cos(course)], axis=-1) / 60.0
    hips = np.cumsum(step, axis=0) + np.array([0.0, height, 0.0])
    rotations = quaternion.identity(len(t), len(REFERENCE), dtype=np.float64)
    rotations[:, 0] = quaternion.from_yaw(yaw)
    for part, down in {"LeftArm": -arms, "RightArm": arms}.items():
        turn = quaternion.from_axis_angle((0.0, 0.0, 1.0), np.deg2rad(down))
        rotations[:, REFERENCE.index(part)] = turn
    pose = extract_root(REFERENCE, hips, rotations, 60.0)
    return Clip("glide", REFERENCE, 60.0, pose, np.zeros((len(t), 4), bool))


def tags_in_the_middle(clip: Clip) -> set[str]:
    """Return the tags that hold halfway."""
    middle = len(clip) // 2
    return {span.name for span in measured_tags(clip) if span.start <= middle < span.end}


@pytest.mark.parametrize(
    ("clip", "tags"),
    [
        (gliding(0.0), {"idle"}),
        (gliding(1.2), {"walk"}),
        (gliding(2.5), {"jog"}),
        (gliding(4.0), {"run"}),
        (gliding(1.0, angle=180.0), {"backward"}),
        (gliding(1.0, angle=90.0), {"sidestep", "sidestep-left"}),
        (gliding(1.0, angle=-90.0), {"sidestep", "sidestep-right"}),
        (gliding(1.2, turning=80.0), {"walk", "turn", "turn-left"}),
        (gliding(0.0, turning=-80.0), {"idle", "turn", "turn-right"}),
        (gliding(0.5, height=0.4), {"low"}),
        (gliding(0.1, height=0.75), {"low"}),
        (gliding(2.5, height=0.75), {"jog"}),
        (gliding(0.1, height=1.5), {"aloft"}),
        (gliding(0.5, arms=0.0), {"gesture"}),
        (gliding(1.5, arms=-60.0), {"gesture"}),
        (gliding(3.0, arms=-60.0), {"jog"}),
    ],
)
def test_motion_tells_the_tag(clip: Clip, tags: set[str]) -> None:
    """Steady motion has the tags of its speed, direction and turning."""
    assert tags_in_the_middle(clip) == tags


def test_setting_off_and_stopping_are_spans_around_the_change() -> None:
    """A start lies around the end of standing, a stop around its beginning."""
    clip = gliding(lambda t: 1.5 * ((t > 2.0) & (t < 6.0)), seconds=8.0)
    spans = {s.name: s for s in measured_tags(clip) if s.name in ("start", "stop")}
    assert spans["start"].start < 2.0 * 60 < spans["start"].end < 3.2 * 60
    assert 4.8 * 60 < spans["stop"].start < 6.0 * 60 < spans["stop"].end


def test_a_single_step_is_neither_start_nor_stop() -> None:
    """Shifting aside at half a metre per second between two stands is no start."""
    clip = gliding(lambda t: 0.5 * ((t > 2.0) & (t < 3.0)))
    assert not {"start", "stop"} & {span.name for span in measured_tags(clip)}


def test_waving_is_no_standing() -> None:
    """A hand that is faster than a gait swings it takes `idle` away, and only around it."""
    clip = gliding(0.0)
    t = np.arange(len(clip)) / 60.0
    swing = np.where((t > 2.0) & (t < 4.0), 0.8 * np.sin(2.0 * np.pi * 2.0 * t), 0.0)
    elbow = quaternion.from_axis_angle((0.0, 1.0, 0.0), -0.8 - swing)
    clip.pose.rotations[:, REFERENCE.index("LeftArm")] = quaternion.multiply(
        clip.pose.rotations[:, REFERENCE.index("LeftArm")], elbow
    )
    spans = measured_tags(clip)
    wave = next(span for span in spans if span.name == "gesture")
    assert 1.5 * 60 < wave.start < 2.1 * 60
    assert 3.9 * 60 < wave.end < 4.5 * 60
    idle = [(span.start, span.end) for span in spans if span.name == "idle"]
    assert idle == [(0, wave.start), (wave.end, len(clip))]


def test_clips_of_some_kinds_only() -> None:
    """Most frames must be of them, and no word may say otherwise."""
    walk = tag(gliding(1.2), "stroll")
    assert only_tagged(walk, ["walk", "idle"])
    assert not only_tagged(walk, ["run"])
    assert not only_tagged(tag(gliding(1.2), "dance"), ["walk"])
    half = tag(gliding(lambda t: 1.2 + 3.0 * (t > 3.0)), "stroll")
    assert not only_tagged(half, ["walk"])


def test_mirrored_motion_has_mirrored_tags() -> None:
    """Left and right change places in tags, as measured and as mirrored."""
    clip = gliding(1.2, turning=80.0)
    mirrored = mirror_clip(clip)
    assert tags_in_the_middle(mirrored) == {"walk", "turn", "turn-right"}


@pytest.mark.parametrize(
    ("words", "tags"),
    [
        ("fallAndGetUp1_subject4", {"fall"}),
        ("obstacles4_subject2_jog", {"obstacles"}),
        ("14_01 boxing", {"fight"}),
        ("salsa dance", {"dance"}),
        ("walk1_subject1", set()),
        ("position opposition", set()),
    ],
)
def test_words_of_names_become_tags(words: str, tags: set[str]) -> None:
    """Beginnings of words count, not letters within them; walking is measured, not read."""
    assert {span.name for span in file_tags(words, 100)} == tags


def test_spans_are_cut_out_of_clips() -> None:
    """What is left comes in pieces of two seconds or more, contacts and other tags with them."""
    walk = replace(gliding(1.2), tags=())
    frames = len(walk)
    assert without(walk, ["low"]) == [walk]
    spans = (TagSpan("walk", 0, frames), TagSpan("low", 150, 170), TagSpan("low", 200, frames))
    (piece,) = without(replace(walk, tags=spans), ["low"])
    assert len(piece) == 150
    assert piece.name == f"{walk.name}-1"
    assert piece.tags == (TagSpan("walk", 0, 150),)
    assert without(replace(walk, tags=spans), ["walk"]) == []
