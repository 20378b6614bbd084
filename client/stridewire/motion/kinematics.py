"""Forward kinematics: from local rotations to where the joints are."""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions, Vectors
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton


def forward(
    skeleton: Skeleton, hips: Vectors, rotations: Quaternions
) -> tuple[Vectors, Quaternions]:
    """Return positions `(..., J, 3)` and rotations `(..., J, 4)` of the joints in the hips' space.

    Loops over the depth of the tree, not over joints.

    Args:
        skeleton: J joints.
        hips: `(..., 3)` position of the first joint, metres.
        rotations: `(..., J, 4)` local rotations.
    """
    offsets = skeleton.offsets.astype(rotations.dtype)
    positions = np.empty((*rotations.shape[:-1], 3), rotations.dtype)
    turned = np.empty_like(rotations)
    positions[..., 0, :] = hips
    turned[..., 0, :] = rotations[..., 0, :]
    for joints, parents in skeleton.levels:
        turned[..., joints, :] = quaternion.multiply(
            turned[..., parents, :], rotations[..., joints, :]
        )
    parents = np.array(skeleton.parents[1:], np.intp)
    bones = quaternion.rotate(
        turned[..., parents, :], np.broadcast_to(offsets[1:], positions[..., 1:, :].shape)
    )
    for joints, parents in skeleton.levels:
        positions[..., joints, :] = positions[..., parents, :] + bones[..., joints - 1, :]
    return positions, turned


def forward_world(skeleton: Skeleton, pose: Pose) -> tuple[Vectors, Quaternions]:
    """Return positions `(..., J, 3)` and rotations `(..., J, 4)` of the joints in the world."""
    hips, turn = pose.world_hips
    rotations = pose.rotations.copy()
    rotations[..., 0, :] = turn
    return forward(skeleton, hips, rotations)


def to_local(skeleton: Skeleton, rotations: Quaternions) -> Quaternions:
    """Return local rotations from rotations `(..., J, 4)` in the hips' space: `forward` undone."""
    parents = np.array(skeleton.parents[1:], np.intp)
    out = rotations.copy()
    out[..., 1:, :] = quaternion.multiply(
        quaternion.conjugate(rotations[..., parents, :]), rotations[..., 1:, :]
    )
    return out
