"""Mirroring: what the same motion looks like with left and right exchanged."""

from dataclasses import replace

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.array_types import Quaternions, Vectors
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import Skeleton

MIRRORED = "-mirrored"
"""What the name of a mirrored copy ends in."""


def mirror_pose(skeleton: Skeleton, pose: Pose) -> Pose:
    """Reflect poses in the plane x = 0; twice gives the pose again.

    Global positions become `(-x, y, z)`, global rotations `(w, x, -y, -z)`, and each joint takes
    its partner's. Exact for skeletons whose rest pose is symmetric.
    """
    _, turned = kinematics.forward(skeleton, pose.hips, pose.rotations)
    reflected = _reflect_rotation(turned)[..., skeleton.mirror, :]
    return Pose(
        _reflect_position(pose.root_position),
        _reflect_rotation(pose.root_rotation),
        _reflect_position(pose.hips),
        kinematics.to_local(skeleton, reflected),
    )


def mirror_clip(clip: Clip) -> Clip:
    """Reflect a clip; `-mirrored` ends its name, tags `left` and `right` change places."""
    swap = {"left": "right", "right": "left"}
    return replace(
        clip,
        name=f"{clip.name}{MIRRORED}",
        pose=mirror_pose(clip.skeleton, clip.pose),
        contacts=clip.contacts[:, [2, 3, 0, 1]],
        tags=tuple(
            replace(tag, name="-".join(swap.get(word, word) for word in tag.name.split("-")))
            for tag in clip.tags
        ),
    )


def _reflect_position(v: Vectors) -> Vectors:
    return v * np.array([-1.0, 1.0, 1.0], v.dtype)


def _reflect_rotation(q: Quaternions) -> Quaternions:
    return q * np.array([1.0, 1.0, -1.0, -1.0], q.dtype)
