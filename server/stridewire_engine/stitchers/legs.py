"""Legs: where their joints are in a pose, and bending them so that ankles reach their targets."""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Indices, Quaternions, Vectors
from stridewire.motion.contacts import rest_heights
from stridewire.motion.skeleton import Skeleton
from stridewire.motion.two_bone_ik import two_bone_ik

_SIDES = ("Left", "Right")
REACH = 0.985
"""Share of its length to which a leg is stretched where the clip does not stretch it further."""
_MOST_ROLL = 0.9
"""A foot rolls over its toe by so many radians at most."""
SOFT_REACH = 0.03
"""So many metres before a leg is stretched the foot begins to roll."""


class Legs(NamedTuple):
    """Joints of both legs of a skeleton and their offsets; arrays over left and right."""

    thigh: Indices
    shin: Indices
    foot: Indices
    toe: Indices
    offsets: Floats
    """`(4, 2, 3)` float32 rest offsets of thigh, shin, foot, toe."""
    toe_height: float
    """Height of a toe joint at rest, metres."""
    length: float
    """From the hip joint to the ankle of a straight leg, metres."""

    @property
    def joints(self) -> Indices:
        """`(6,)` thighs, shins and feet."""
        return np.concatenate([self.thigh, self.shin, self.foot])

    @classmethod
    def of(cls, skeleton: Skeleton) -> "Legs":
        """Find the legs of a skeleton in the reference's names."""
        joints = [
            skeleton.indices([f"{side}{part}" for side in _SIDES])
            for part in ("UpLeg", "Leg", "Foot", "Toe")
        ]
        offsets = np.stack([skeleton.offsets[joint] for joint in joints]).astype(np.float32)
        thigh, shin, foot, toe = joints
        height = float(rest_heights(skeleton, toe)[0])
        length = float(np.linalg.norm(offsets[1:3, 0], axis=-1).sum())
        return cls(thigh, shin, foot, toe, offsets, height, length)


class LegPose(NamedTuple):
    """Joints of both legs in the root's frame: positions `(N, 2, 3)`, rotations `(N, 2, 4)`."""

    hip: Vectors
    knee: Vectors
    ankle: Vectors
    toe: Vectors
    thigh: Quaternions
    shin: Quaternions
    foot: Quaternions

    def lowered(self, drop: Floats) -> "LegPose":
        """Return the same legs `drop` `(N,)` metres lower."""
        down = np.zeros((*drop.shape, 1, 3), self.hip.dtype)
        down[..., 0, 1] = drop
        return self._replace(
            hip=self.hip - down, knee=self.knee - down, ankle=self.ankle - down, toe=self.toe - down
        )


def leg_pose(legs: Legs, hips: Vectors, rotations: Quaternions) -> LegPose:
    """Return where the legs of poses are: hips `(N, 3)`, local rotations `(N, J, 4)`."""
    pelvis = rotations[:, :1]
    thigh = quaternion.multiply(pelvis, rotations[:, legs.thigh])
    shin = quaternion.multiply(thigh, rotations[:, legs.shin])
    foot = quaternion.multiply(shin, rotations[:, legs.foot])
    hip = hips[:, None] + quaternion.rotate(pelvis, legs.offsets[0])
    knee = hip + quaternion.rotate(thigh, legs.offsets[1])
    ankle = knee + quaternion.rotate(shin, legs.offsets[2])
    toe = ankle + quaternion.rotate(foot, legs.offsets[3])
    return LegPose(hip, knee, ankle, toe, thigh, shin, foot)


def turn_feet(legs: Legs, pose: LegPose, turn: Vectors) -> LegPose:
    """Return the same legs with feet turned about their ankles by rotation vectors `(N, 2, 3)`."""
    foot = quaternion.multiply(quaternion.from_scaled_axis(turn.astype(np.float32)), pose.foot)
    return pose._replace(foot=foot, toe=pose.ankle + quaternion.rotate(foot, legs.offsets[3]))


def raise_heels(pose: LegPose, toes: Vectors, reach: Floats) -> tuple[LegPose, Vectors]:
    """Roll feet over their toes where legs would be too short, as walkers do.

    The foot turns about its toe in the plane of toe, ankle and hip joint, just so far that the
    ankle is within reach.

    Args:
        pose: The legs, the hips where they are to be.
        toes: `(N, 2, 3)` where the toes are to be, in the root's frame.
        reach: `(N, 2)` longest distance from the hip joint to the ankle.

    Returns:
        The legs with turned feet, and `(N, 2, 3)` where the ankles are to be.
    """
    foot = pose.ankle - pose.toe
    up = pose.hip - toes
    length, distance = _length(foot), np.maximum(_length(up), 1e-6)
    cosine = quaternion.dot(foot, up) / np.maximum(length * distance, 1e-9)
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    stretch = smooth_min(_length(toes + foot - pose.hip), reach, SOFT_REACH)
    nearest = (distance**2 + length**2 - stretch**2) / np.maximum(2.0 * distance * length, 1e-9)
    widest = np.arccos(np.clip(nearest, -1.0, 1.0))
    excess = np.minimum(np.maximum(angle - widest, 0.0), _MOST_ROLL)
    axis = quaternion.cross(foot, up)
    axis = axis / np.maximum(_length(axis), 1e-9)[..., None]
    turn = quaternion.from_scaled_axis((axis * excess[..., None]).astype(foot.dtype))
    turned = quaternion.rotate(turn, foot)
    rolled = pose._replace(foot=quaternion.multiply(turn, pose.foot), toe=pose.ankle - turned)
    return rolled, toes + turned


def bend(
    legs: Legs, pose: LegPose, rotations: Quaternions, ankles: Vectors
) -> tuple[Quaternions, Vectors]:
    """Bend legs so that their ankles reach targets; feet keep their rotation in the root's frame.

    Args:
        legs: Of the skeleton.
        pose: The legs now, the hips where they are to be.
        rotations: `(N, J, 4)` local.
        ankles: `(N, 2, 3)` targets in the root's frame.

    Returns:
        `(N, J, 4)` local rotations and `(N, 2, 3)` where the ankles came to lie.
    """
    ahead = np.broadcast_to(np.array([0.0, 0.0, 1.0], pose.ankle.dtype), pose.ankle.shape)
    forward = quaternion.rotate(pose.shin, ahead)
    limb = two_bone_ik(pose.hip, pose.knee, pose.ankle, pose.thigh, pose.shin, ankles, forward)
    bent = rotations.copy()
    pelvis = rotations[:, :1]
    bent[:, legs.thigh] = quaternion.multiply(quaternion.conjugate(pelvis), limb.upper)
    bent[:, legs.shin] = quaternion.multiply(quaternion.conjugate(limb.upper), limb.lower)
    bent[:, legs.foot] = quaternion.multiply(quaternion.conjugate(limb.lower), pose.foot)
    return bent, limb.end


def smooth_min(a: Floats, b: Floats, width: float) -> Floats:
    """Return the smaller of both, rounded off where they differ by less than `width`."""
    near = np.maximum(width - np.abs(a - b), 0.0)
    return np.asarray(np.minimum(a, b) - near * near / (4.0 * width))


def _length(v: Vectors) -> Floats:
    return np.asarray(np.sqrt(quaternion.dot(v, v)))
