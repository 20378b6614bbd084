"""Forward kinematics: the T-pose, hand-computed chains and inverses."""

from collections.abc import Callable

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE, Skeleton


def test_rest_pose_stands_in_a_t() -> None:
    """Without rotations the joints lie at their added offsets: toes low, head high, arms out."""
    positions, _ = kinematics.forward(
        REFERENCE, REFERENCE.offsets[0], quaternion.identity(len(REFERENCE), dtype=np.float64)
    )
    np.testing.assert_allclose(positions[REFERENCE.index("LeftToe")], [0.095, 0.02, 0.135])
    np.testing.assert_allclose(positions[REFERENCE.index("LeftHand")], [0.715, 1.44, 0.0])
    np.testing.assert_allclose(positions[REFERENCE.index("Head")], [0.0, 1.6, 0.01])


def test_a_chain_computed_by_hand() -> None:
    """Two bones of a metre, each turned 90 degrees about z."""
    chain = Skeleton(("a", "b", "c"), (-1, 0, 1), np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0]]))
    quarter = quaternion.from_axis_angle((0.0, 0.0, 1.0), np.full(3, np.pi / 2))
    positions, rotations = kinematics.forward(chain, np.array([0.0, 2.0, 0.0]), quarter)
    np.testing.assert_allclose(positions, [[0, 2, 0], [0, 3, 0], [-1, 3, 0]], atol=1e-12)
    three_quarters = quaternion.from_axis_angle((0.0, 0.0, 1.0), 1.5 * np.pi)
    np.testing.assert_allclose(abs(rotations[2] @ three_quarters), 1.0)


def test_to_local_undoes_forward(random_pose: Callable[..., Pose]) -> None:
    """Local rotations come back from those in the hips' space."""
    pose = random_pose(7, 3)
    _, turned = kinematics.forward(REFERENCE, pose.hips, pose.rotations)
    np.testing.assert_allclose(kinematics.to_local(REFERENCE, turned), pose.rotations, atol=1e-12)


def test_bones_keep_their_length(random_pose: Callable[..., Pose]) -> None:
    """No rotation stretches a bone."""
    positions, _ = kinematics.forward_world(REFERENCE, random_pose(20))
    bones = positions[:, 1:] - positions[:, list(REFERENCE.parents[1:])]
    expected = np.linalg.norm(REFERENCE.offsets[1:], axis=-1)
    np.testing.assert_allclose(np.linalg.norm(bones, axis=-1), expected[None].repeat(20, 0))


def test_the_root_carries_the_whole_body(random_pose: Callable[..., Pose]) -> None:
    """World joints are the root's transform of the joints relative to it."""
    pose = random_pose(10)
    local, _ = kinematics.forward(REFERENCE, pose.hips, pose.rotations)
    world, _ = kinematics.forward_world(REFERENCE, pose)
    expected = pose.root_position[:, None] + quaternion.rotate(pose.root_rotation[:, None], local)
    np.testing.assert_allclose(world, expected, atol=1e-12)


def test_inputs_stay_as_they_were(random_pose: Callable[..., Pose]) -> None:
    """No argument is changed."""
    pose = random_pose(3)
    before = pose.rotations.copy()
    kinematics.forward_world(REFERENCE, pose)
    kinematics.to_local(REFERENCE, pose.rotations)
    np.testing.assert_array_equal(pose.rotations, before)
