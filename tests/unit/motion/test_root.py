"""The root: smoothing as SciPy's, and a split that loses nothing."""

import numpy as np
import pytest
from scipy.signal import savgol_filter

from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.root import extract_root, savitzky_golay
from stridewire.motion.skeleton import REFERENCE, Skeleton, SkeletonError


@pytest.mark.parametrize(("frames", "window"), [(200, 31), (200, 61), (61, 61), (12, 11)])
def test_smoothing_is_scipys(rng: np.random.Generator, frames: int, window: int) -> None:
    """Local polynomials inside, the outermost window's polynomial at the ends."""
    values = rng.normal(size=(frames, 3))
    expected = savgol_filter(values, window, 3, axis=0, mode="interp")
    np.testing.assert_allclose(savitzky_golay(values, window), expected, atol=1e-9)


@pytest.mark.parametrize(("frames", "window"), [(1, 31), (3, 31), (4, 31), (6, 31), (9, 31)])
def test_short_clips_are_smoothed_with_what_fits(frames: int, window: int) -> None:
    """A cubic comes out as it went in, however few frames there are."""
    x = np.linspace(-1.0, 1.0, frames)[:, None]
    cubic = 1.0 + x - 2.0 * x**2 + x**3
    np.testing.assert_allclose(savitzky_golay(cubic, window), cubic, atol=1e-9)


def test_root_and_pose_together_are_the_motion(swaying_clip: Clip) -> None:
    """Putting the root back gives every joint where it was."""
    hips, turn = swaying_clip.pose.world_hips
    rotations = swaying_clip.pose.rotations.copy()
    rotations[:, 0] = turn
    pose = extract_root(REFERENCE, hips, rotations, 60.0)
    before, _ = kinematics.forward(REFERENCE, hips, rotations)
    after, _ = kinematics.forward_world(REFERENCE, pose)
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_the_root_lies_on_the_ground_under_the_chest(swaying_clip: Clip) -> None:
    """Height 0, near Spine2, turned about y alone."""
    hips, turn = swaying_clip.pose.world_hips
    rotations = swaying_clip.pose.rotations.copy()
    rotations[:, 0] = turn
    pose = extract_root(REFERENCE, hips, rotations, 60.0)
    assert not pose.root_position[:, 1].any()
    assert not pose.root_rotation[:, [1, 3]].any()
    positions, _ = kinematics.forward(REFERENCE, hips, rotations)
    chest = positions[:, REFERENCE.index("Spine2")]
    assert np.abs(pose.root_position - chest)[:, [0, 2]].max() < 0.05


def test_heading_survives_the_seam_of_the_angle() -> None:
    """Turning through 180 degrees smooths directions, not angles."""
    frames = 240
    yaw = np.linspace(0.5 * np.pi, 1.5 * np.pi, frames)
    rotations = quaternion.identity(frames, len(REFERENCE), dtype=np.float64)
    rotations[:, 0] = quaternion.from_yaw(yaw)
    hips = np.tile([0.0, 0.95, 0.0], (frames, 1))
    pose = extract_root(REFERENCE, hips, rotations, 60.0)
    found = np.unwrap(quaternion.to_yaw(pose.root_rotation))
    np.testing.assert_allclose(found, yaw, atol=np.radians(0.5))


def test_a_skeleton_without_spine2_is_refused() -> None:
    """The message names the joint that is missing."""
    one = Skeleton(("Hips",), (-1,), np.zeros((1, 3)))
    with pytest.raises(SkeletonError, match="Spine2"):
        extract_root(one, np.zeros((9, 3)), quaternion.identity(9, 1, dtype=np.float64), 60.0)
