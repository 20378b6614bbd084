"""Mirroring: an involution that exchanges left and right."""

from collections.abc import Callable

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.mirror import mirror_clip, mirror_pose
from stridewire.motion.skeleton import REFERENCE


def test_twice_is_the_pose_again(random_pose: Callable[..., Pose]) -> None:
    """The mirror of the mirror is the pose, up to the signs of quaternions."""
    pose = random_pose(20)
    again = mirror_pose(REFERENCE, mirror_pose(REFERENCE, pose))
    np.testing.assert_allclose(again.root_position, pose.root_position)
    np.testing.assert_allclose(again.hips, pose.hips)
    np.testing.assert_allclose(again.root_rotation, pose.root_rotation)
    dots = np.abs(np.sum(again.rotations * pose.rotations, axis=-1))
    np.testing.assert_allclose(dots, 1.0)


def test_joints_land_where_their_partners_were_reflected(random_pose: Callable[..., Pose]) -> None:
    """World positions are reflected in the plane x = 0, left and right exchanged."""
    pose = random_pose(20)
    before, _ = kinematics.forward_world(REFERENCE, pose)
    after, _ = kinematics.forward_world(REFERENCE, mirror_pose(REFERENCE, pose))
    np.testing.assert_allclose(after, before[:, REFERENCE.mirror] * (-1.0, 1.0, 1.0), atol=1e-9)


def test_a_clip_changes_contacts_and_words_too(swaying_clip: Clip) -> None:
    """Feet and the words left and right change places; the clip says that it is mirrored."""
    mirrored = mirror_clip(swaying_clip)
    assert mirrored.name == "sway-mirrored"
    assert [tag.name for tag in mirrored.tags] == ["walk", "turn-right", "stop"]
    np.testing.assert_array_equal(mirrored.contacts[:, :2], swaying_clip.contacts[:, 2:])
    np.testing.assert_array_equal(mirrored.contacts[:, 2:], swaying_clip.contacts[:, :2])


def test_partners_are_partners_of_each_other() -> None:
    """The table of partners undoes itself and leaves the spine alone."""
    assert (REFERENCE.mirror[REFERENCE.mirror] == np.arange(len(REFERENCE))).all()
    assert REFERENCE.mirror[REFERENCE.index("Neck")] == REFERENCE.index("Neck")
    assert REFERENCE.mirror[REFERENCE.index("LeftToe")] == REFERENCE.index("RightToe")
