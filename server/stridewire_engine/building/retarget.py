"""Retargeting: any human's motion onto the reference skeleton.

Each joint's rotation in the world is carried over through a constant turn between the T-pose of
the reference and the joint's own axes, so limbs keep their directions; the hips move by the ratio
of the legs' lengths.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.profiles import Profile
from stridewire_engine.building.retarget_feet import SIDES, flatten, plant, standing

_SAME = 1e-3
_ALONG = np.cos(np.deg2rad(35.0))

LEG = ("UpLeg", "Leg", "Foot")
"""Endings of the names of hip, knee and ankle."""


@dataclass(frozen=True)
class Retargeted:
    """A motion on the reference skeleton, at the source's frame rate."""

    hips: Vectors
    """`(T, 3)` in the world, metres; the ground is wherever the source had it."""
    rotations: Quaternions
    """`(T, 22, 4)` local, the hips' in the world."""
    scale: float
    """Metres on the reference skeleton per file unit."""
    unchanged: bool = False
    """Whether the file is on the reference skeleton itself, its ground at 0."""


def retarget(source: SourceMotion, profile: Profile, frame_rate: float) -> Retargeted:
    """Carry a motion over to the reference skeleton.

    Args:
        source: Y up, any unit.
        profile: Must name a joint of `source` for each joint of the reference.
        frame_rate: Frames per second of `source`.

    Raises:
        SkeletonError: If the source lacks a joint that the profile names.
    """
    if (scale := _reference_scale(source)) is not None:
        return Retargeted(source.root_positions * scale, source.rotations, scale, unchanged=True)
    joints = source.skeleton.indices([profile.joints[name] for name in REFERENCE.names])
    positions, turned = source.global_poses()
    axes = quaternion.identity(len(REFERENCE), dtype=np.float64)
    for name, turn in profile.axes.items():
        axes[REFERENCE.index(name)] = turn
    turned = quaternion.multiply(turned[:, joints], axes)
    scale = leg_length(REFERENCE.offsets) / leg_length_of(positions[:, joints])
    legs = REFERENCE.indices(["LeftUpLeg", "RightUpLeg"])
    middle = scale * positions[:, joints[legs]].mean(axis=1)
    stands = {}
    for side in SIDES:
        foot = REFERENCE.indices([f"{side}Foot", f"{side}Toe"])
        stands[side] = standing(scale * positions[:, joints[foot]], frame_rate)
        for joint in foot:
            turned[:, joint] = flatten(turned, joint, stands[side], frame_rate)
    below = np.broadcast_to(REFERENCE.offsets[legs].mean(axis=0), middle.shape)
    hips = middle - quaternion.rotate(turned[:, 0], below)
    for side in SIDES:
        toe = joints[REFERENCE.index(f"{side}Toe")]
        turned = plant(hips, turned, side, scale * positions[:, toe], stands[side])
    local = kinematics.to_local(REFERENCE, turned)
    return Retargeted(hips, quaternion.unroll(quaternion.normalize(local)), scale)


def fits(source: SourceMotion, profile: Profile) -> bool:
    """Return whether a skeleton has the profile's joints and its legs the profile's axes."""
    names = source.skeleton.names
    if not set(profile.joints.values()) <= set(names):
        return False
    for side in SIDES:
        for parent, child in pairwise(LEG):
            axes = profile.axes.get(side + parent, quaternion.identity(dtype=np.float64))
            bone = quaternion.rotate(axes, REFERENCE.offsets[REFERENCE.index(side + child)])
            offset = source.skeleton.offsets[names.index(profile.joints[side + child])]
            if bone @ offset < _ALONG * np.linalg.norm(bone) * np.linalg.norm(offset):
                return False
    return True


def _reference_scale(source: SourceMotion) -> float | None:
    """Return metres per unit where the file is on the reference skeleton, else None."""
    skeleton = source.skeleton
    if skeleton.names != REFERENCE.names or skeleton.parents != REFERENCE.parents:
        return None
    scale = leg_length(REFERENCE.offsets) / max(leg_length(skeleton.offsets), 1e-9)
    same = np.abs(skeleton.offsets[1:] * scale - REFERENCE.offsets[1:]).max() < _SAME
    return scale if same and source.translations is None else None


def leg_length(offsets: Vectors) -> float:
    """Return thigh and shin of the reference skeleton's offsets `(22, 3)`, mean of both sides."""
    lower = REFERENCE.indices([side + part for side in ("Left", "Right") for part in LEG[1:]])
    return float(np.linalg.norm(offsets[lower], axis=-1).sum() / 2.0)


def leg_length_of(positions: Vectors) -> float:
    """Return thigh and shin, mean of both sides, median over frames, of joints `(T, 22, 3)`."""
    total: Floats = np.zeros(len(positions))
    for side in ("Left", "Right"):
        hip, knee, ankle = REFERENCE.indices([side + part for part in LEG])
        total += np.linalg.norm(positions[:, knee] - positions[:, hip], axis=-1)
        total += np.linalg.norm(positions[:, ankle] - positions[:, knee], axis=-1)
    return float(np.median(total) / 2.0)
