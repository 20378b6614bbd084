"""What the network reads of a pair: the same wherever it stands, and enough to write it back."""

from collections.abc import Callable

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions
from stridewire.motion.clip import Pose
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.postures import PairFrame, Postures

MakePose = Callable[..., Pose]


def test_six_numbers_write_a_rotation(random_rotations: Callable[..., Quaternions]) -> None:
    """Forward and up axes give the rotation back, up to its sign."""
    rotations = random_rotations(500)
    again = features.from_six(features.to_six(rotations))
    np.testing.assert_allclose(np.abs(np.sum(again * rotations, axis=-1)), 1.0, atol=1e-12)


def test_six_numbers_are_forward_and_up(random_rotations: Callable[..., Quaternions]) -> None:
    """The first three are the turned +Z axis, the last three the turned +Y axis."""
    rotations = random_rotations(20)
    six = features.to_six(rotations)
    for axis, columns in ((2, slice(0, 3)), (1, slice(3, 6))):
        turned = quaternion.rotate(rotations, np.broadcast_to(np.eye(3)[axis], (20, 3)))
        np.testing.assert_allclose(six[:, columns], turned, atol=1e-12)


def test_skewed_axes_become_a_rotation(rng: np.random.Generator) -> None:
    """Any two axes, as a network gives them, make unit quaternions; forward is kept."""
    axes = rng.normal(size=(50, 6))
    rotations = features.from_six(axes)
    forward = features.to_six(rotations)[:, :3]
    expected = axes[:, :3] / np.linalg.norm(axes[:, :3], axis=-1, keepdims=True)
    np.testing.assert_allclose(forward, expected, atol=1e-9)


def test_inputs_do_not_depend_on_the_place(random_pose: MakePose) -> None:
    """A pair moved, turned and on other ground gives the same inputs of both variants."""
    start, end = random_pose(8), random_pose(8)
    turn = quaternion.from_yaw(np.full(8, 1.1))
    shift = np.array([30.0, 2.0, -7.0])

    def moved(pose: Pose) -> Pose:
        return Pose(
            quaternion.rotate(turn, pose.root_position) + shift,
            quaternion.multiply(turn, pose.root_rotation),
            pose.hips,
            pose.rotations,
        )

    here = _entered(start, end, 0.0)
    there = _entered(moved(start), moved(end), 2.0)
    duration = np.full(8, 0.4)
    for make in (
        lambda a, b: features.inputs(a, b, duration),
        lambda a, b: features.paper_inputs(a, b, duration),
    ):
        np.testing.assert_allclose(make(*here), make(*there), atol=1e-5)


def test_inputs_do_not_depend_on_the_root(random_pose: MakePose) -> None:
    """The same posture split into another root and hips gives the same inputs."""
    start, end = random_pose(4), random_pose(4)
    hips, turned = start.world_hips
    rotations = start.rotations.copy()
    rotations[:, 0] = turned
    other = Pose(np.zeros((4, 3)), quaternion.identity(4, dtype=np.float64), hips, rotations)
    duration = np.zeros(4)
    np.testing.assert_allclose(
        features.inputs(*_entered(start, end, 0.0), duration),
        features.inputs(*_entered(other, end, 0.0), duration),
        atol=1e-5,
    )


def test_frames_are_left_as_they_were_entered(random_pose: MakePose) -> None:
    """`leave` undoes `enter`, also for several postures a pair."""
    poses = Postures.of(random_pose(5, 3))
    frame = PairFrame.of(poses[:, 0], np.full(5, 0.3))
    again = frame.leave(frame.enter(poses))
    np.testing.assert_allclose(again.hips, poses.hips, atol=1e-12)
    np.testing.assert_allclose(again.rotations, poses.rotations, atol=1e-12)


def test_sizes_are_the_papers() -> None:
    """135 numbers a posture, 271 inputs."""
    assert (features.POSTURE_SIZE, features.PAPER_INPUTS) == (135, 271)


def _entered(start: Pose, end: Pose, ground: float) -> tuple[Postures, Postures]:
    first, last = Postures.of(start), Postures.of(end)
    frame = PairFrame.of(first, np.full(len(first.hips), ground))
    return frame.enter(first), frame.enter(last)
