"""Cleaning: rest poses cut, spikes mended, gaps noted, the floor found where toes are planted."""

from dataclasses import replace

import numpy as np
import pytest
from tests.unit.building.figures import source, walking

from stridewire.motion import kinematics, quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.cleaning import (
    clean,
    find_loop,
    floor_height,
    gaps,
    leading_pose,
    mend_spikes,
)

KNEE = REFERENCE.index("LeftLeg")


def turned_by(degrees: float) -> np.ndarray:
    """Return a turn about x."""
    return quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(np.deg2rad(degrees)))


@pytest.mark.parametrize("frames", [1, 2])
def test_a_rest_pose_before_the_motion_is_cut(frames: int) -> None:
    """One or two frames of zero angles before a walk are found; a plain walk has none."""
    motion = source()
    assert leading_pose(motion) == 0
    rotations = motion.rotations.copy()
    rotations[:frames] = (1.0, 0.0, 0.0, 0.0)
    rotations[:frames, REFERENCE.index("LeftArm")] = turned_by(90.0)
    assert leading_pose(replace(motion, rotations=rotations)) == frames


def test_a_start_far_away_is_cut() -> None:
    """A root that jumps by metres begins after the jump."""
    motion = source()
    root = motion.root_positions.copy()
    root[:2] += 500.0
    assert leading_pose(replace(motion, root_positions=root)) == 2


@pytest.mark.parametrize(("frames", "degrees"), [(1, 40.0), (3, 40.0), (8, 150.0)])
def test_spikes_are_bridged(frames: int, degrees: float) -> None:
    """A joint that jumps away and back is put between its neighbours, and a note says where."""
    motion = source()
    rotations = motion.rotations.copy()
    rotations[60 : 60 + frames, KNEE] = quaternion.multiply(
        rotations[60 : 60 + frames, KNEE], turned_by(degrees)
    )
    mended, notes = mend_spikes(replace(motion, rotations=rotations), 60.0)
    apart = np.abs(np.sum(mended.rotations * motion.rotations, axis=-1))
    assert np.rad2deg(2.0 * np.arccos(np.minimum(apart, 1.0))).max() < 3.0
    assert notes == [f"{frames} frame(s) with spikes were mended, the first at 1.00 s in LeftLeg"]


def test_plain_motion_is_left_alone() -> None:
    """A walk has no spikes."""
    motion = source()
    mended, notes = mend_spikes(motion, 60.0)
    assert mended is motion
    assert notes == []


def test_a_jump_for_good_is_named() -> None:
    """What does not come back cannot be bridged; it is said."""
    motion = source()
    rotations = motion.rotations.copy()
    rotations[60:, KNEE] = quaternion.multiply(rotations[60:, KNEE], turned_by(170.0))
    _, notes = mend_spikes(replace(motion, rotations=rotations), 60.0)
    assert notes[0].startswith("1 jump(s) of a joint by more than 90 degrees are left")


def test_gaps_are_noted() -> None:
    """Half a second without any motion is a gap; a walk has none."""
    motion = source()
    assert gaps(motion, 60.0) == []
    rotations = motion.rotations.copy()
    rotations[60:90] = rotations[60]
    notes = gaps(replace(motion, rotations=rotations), 60.0)
    assert notes == ["1 gap(s) without any motion, the first at 1.00 s"]


def test_the_floor_is_under_planted_toes() -> None:
    """A figure that stands 37 cm too high is found to, although one foot steps onto a box."""
    frames = 600
    hips = np.tile([0.0, 0.95 + 0.37, 0.0], (frames, 1))
    rotations = quaternion.identity(frames, len(REFERENCE), dtype=np.float64)
    positions, _ = kinematics.forward(REFERENCE, hips, rotations)
    positions[400:, REFERENCE.index("LeftToe"), 1] += 0.4
    assert floor_height(positions) == pytest.approx(0.37, abs=0.005)


def test_a_figure_that_stands_has_its_feet_planted() -> None:
    """Standing still two metres too high, all four joints of the feet are planted."""
    rotations = quaternion.identity(60, len(REFERENCE), dtype=np.float64)
    clip = clean("stand", np.tile([0.0, 2.95, 0.0], (60, 1)), rotations, 60.0, "")
    assert clip.contacts.all()


def test_loops_are_found() -> None:
    """Whole strides come back to their first pose; half a stride more does not."""
    hips, rotations = walking(round(2 * 60 / 0.9) + 1)
    hips[:, 1] = 0.93
    assert find_loop(clean("walk", hips, rotations, 60.0, "")).loops
    assert not find_loop(clean("walk", hips[:-33], rotations[:-33], 60.0, "")).loops


def test_a_clean_clip_has_a_root_and_sixty_frames() -> None:
    """The root lies on the ground, and the walk keeps its duration."""
    hips, rotations = walking(120, 30.0)
    clip = clean("walk", hips, rotations, 30.0, "walk.bvh")
    assert clip.frame_rate == 60.0
    assert clip.seconds == pytest.approx(119 / 30.0)
    assert (clip.pose.root_position[:, 1] == 0.0).all()
    assert clip.contacts.shape == (len(clip), 4)
    assert clip.source == "walk.bvh"
