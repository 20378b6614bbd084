"""Feet: what stands at both ends stays between them, and nothing goes into the ground.

A foot that stands on one spot at both ends is kept there by two-bone inverse kinematics; other feet
are lifted where they would be lower than at both ends and at rest. Both corrections are nothing at
the ends and continuous in the weight.
"""

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.contacts import rest_heights
from stridewire.motion.skeleton import REFERENCE
from stridewire.motion.two_bone_ik import two_bone_ik
from stridewire_engine.networks.blend.postures import Postures

_LEGS = REFERENCE.indices(
    [f"{side}{joint}" for side in ("Left", "Right") for joint in ("UpLeg", "Leg", "Foot", "Toe")]
).reshape(2, 4)
_STANDING_HEIGHT = 0.05
"""A standing foot's toe is at most so much above its height at rest; metres."""
_SAME_SPOT, _OTHER_SPOT = 0.02, 0.05
"""A toe that moved less stands, one that moved more does not; metres."""
_MOVED = 1e-7


def keep_feet(between: Postures, start: Postures, end: Postures, weights: Floats) -> Postures:
    """Return postures whose feet stand where they stood, and above the ground y = 0.

    Args:
        between: `(P,)`, the starts at weight 0 and the ends at weight 1.
        start: `(P,)`.
        end: `(P,)`.
        weights: `(P, J)`; legs whose joints do not share the hips' weight are left alone.
    """
    three = kinematics.forward(
        REFERENCE,
        np.stack([between.hips, start.hips, end.hips]),
        np.stack([between.rotations, start.rotations, end.rotations]),
    )
    (positions, turned), first, last = zip(*three, strict=True)
    hip, knee, ankle, toe = (_LEGS[:, i] for i in range(4))
    stands = _stands(first[0][:, toe], last[0][:, toe])[..., None]
    share = weights[:, :1, None]
    spot = first[0][:, ankle] * (1.0 - share) + last[0][:, ankle] * share
    sole = quaternion.slerp(first[1][:, ankle], last[1][:, ankle], share[..., 0])
    target = positions[:, ankle] * (1.0 - stands) + spot * stands
    foot = quaternion.nlerp(turned[:, ankle], sole, stands[..., 0])
    target = target + _lift(target, foot, first[0], last[0])
    moved = np.linalg.norm(target - positions[:, ankle], axis=-1) > _MOVED
    moved &= _whole(weights)
    if not moved.any():
        return between
    limb = two_bone_ik(
        positions[:, hip],
        positions[:, knee],
        positions[:, ankle],
        turned[:, hip],
        turned[:, knee],
        target,
        quaternion.rotate(turned[:, knee], np.broadcast_to([0.0, 0.0, 1.0], target.shape)),
    )
    return Postures(between.hips, _turn_legs(between, turned, limb.upper, limb.lower, foot, moved))


def _stands(first: Vectors, last: Vectors) -> Floats:
    """Return how surely toes `(P, 2)` stand on one spot at both ends, 0 to 1."""
    lowest = rest_heights(REFERENCE, _LEGS[:, 3]) + _STANDING_HEIGHT
    low = (first[..., 1] < lowest) & (last[..., 1] < lowest)
    way = np.linalg.norm((last - first)[..., [0, 2]], axis=-1)
    x = np.clip((_OTHER_SPOT - way) / (_OTHER_SPOT - _SAME_SPOT), 0.0, 1.0)
    return np.where(low, x * x * (3.0 - 2.0 * x), 0.0)


def _lift(ankle: Vectors, foot: Quaternions, first: Vectors, last: Vectors) -> Vectors:
    """Return by how much ankles `(P, 2, 3)` rise so that neither they nor toes are too low."""
    joints = _LEGS[:, 2:]
    offset = np.broadcast_to(REFERENCE.offsets[joints[:, 1]], ankle.shape)
    toe = ankle + quaternion.rotate(foot, offset)
    rest = rest_heights(REFERENCE, joints.reshape(-1)).reshape(joints.shape)
    allowed = np.minimum(np.minimum(first[:, joints, 1], last[:, joints, 1]), rest)
    height = np.stack([ankle[..., 1], toe[..., 1]], axis=-1)
    up = np.zeros_like(ankle)
    up[..., 1] = np.maximum(allowed - height, 0.0).max(axis=-1)
    return up


def _whole(weights: Floats) -> Flags:
    """Tell which legs `(P, 2)` move with the hips, somewhere between the ends."""
    hips = weights[:, :1]
    inside = (hips > 0.0) & (hips < 1.0)
    return np.asarray(inside & np.all(weights[:, _LEGS] == hips[..., None], axis=-1))


def _turn_legs(
    between: Postures,
    turned: Quaternions,
    upper: Quaternions,
    lower: Quaternions,
    foot: Quaternions,
    moved: Flags,
) -> Quaternions:
    """Return local rotations with new rotations of thighs, shanks and feet in the hips' space."""
    parent = np.broadcast_to(turned[:, :1], upper.shape)
    chain = (parent, upper, lower, foot)
    rotations = between.rotations.copy()
    for i in range(3):
        joints = _LEGS[:, i]
        local = quaternion.multiply(quaternion.conjugate(chain[i]), chain[i + 1])
        rotations[:, joints] = np.where(moved[..., None], local, rotations[:, joints])
    return rotations
