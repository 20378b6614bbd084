"""Two-bone inverse kinematics: bend a limb so that its end reaches a target."""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Quaternions, Vectors

_POLE = 0.03
"""Where a middle is so little aside, in metres, that its side is chance, `forward` has a say."""


class Limb(NamedTuple):
    """Result of `two_bone_ik`, arrays over the leading shape `(...)`."""

    upper: Quaternions
    """`(..., 4)` rotation of the upper bone, in the space of the inputs."""
    lower: Quaternions
    """`(..., 4)` rotation of the lower bone, in the same space."""
    end: Vectors
    """`(..., 3)` where the end came to lie."""
    reached: Flags
    """`(...)` whether that is the target."""


def two_bone_ik(
    start: Vectors,
    middle: Vectors,
    end: Vectors,
    upper: Quaternions,
    lower: Quaternions,
    target: Vectors,
    forward: Vectors,
    buffer: float = 0.015,
) -> Limb:
    """Turn the upper and the lower bone so that the end reaches the target.

    The middle stays in its plane; where the limb is nearly straight or bent backwards, as blended
    limbs may be, it leans towards `forward`, so that no middle ever flips. A target out of reach is
    approached up to `buffer` short of full length.

    Args:
        start: `(..., 3)` hip or shoulder.
        middle: `(..., 3)` knee or elbow.
        end: `(..., 3)` ankle or wrist.
        upper: `(..., 4)` rotation of the upper bone.
        lower: `(..., 4)` rotation of the lower bone.
        target: `(..., 3)` where the end is to go.
        forward: `(..., 3)` unit direction that the middle bends to.
        buffer: Metres that a limb stays short of full length when it reaches out.
    """
    upper_length = _length(middle - start)
    lower_length = _length(end - middle)
    reach = target - start
    distance = _length(reach)
    # a limb that is straighter than the buffer allows in the data may stay so
    longest = np.maximum(upper_length + lower_length - buffer, _length(end - start))
    shortest = np.abs(upper_length - lower_length) + 1e-4
    clamped = np.clip(distance, shortest, longest)
    # a target at the start has no direction: fold the limb where it is
    reach = np.where(distance < 1e-6, end - start, reach)
    direction = reach / _length(reach)

    swing = quaternion.between(end - start, reach)
    bend = quaternion.rotate(swing, middle - start)
    bend = bend - direction * _dot(bend, direction)
    pole = quaternion.rotate(swing, forward)
    pole = pole - direction * _dot(pole, direction)
    pole = pole / np.maximum(_length(pole), 1e-9)
    # bent backwards by b it is pushed by b more, so that bend and pole never cancel
    backwards = np.minimum(_dot(bend, pole), 0.0)
    bend = bend + pole * np.maximum(0.0, _POLE - _length(bend) - 2.0 * backwards)
    bend = bend / np.maximum(_length(bend), 1e-9)

    along = (clamped**2 + upper_length**2 - lower_length**2) / (2.0 * clamped)
    aside = np.sqrt(np.maximum(upper_length**2 - along**2, 0.0))
    new_middle = start + direction * along + bend * aside
    new_end = start + direction * clamped
    return Limb(
        _turn(swing, middle - start, new_middle - start, upper),
        _turn(swing, end - middle, new_end - new_middle, lower),
        new_end,
        np.abs(clamped - distance)[..., 0] < 1e-4,
    )


def _turn(swing: Quaternions, old: Vectors, new: Vectors, rotation: Quaternions) -> Quaternions:
    turn = quaternion.between(quaternion.rotate(swing, old), new)
    return quaternion.multiply(quaternion.multiply(turn, swing), rotation)


def _length(v: Vectors) -> Vectors:
    return np.asarray(np.sqrt(quaternion.dot(v, v))[..., None])


def _dot(a: Vectors, b: Vectors) -> Vectors:
    return quaternion.dot(a, b)[..., None]
