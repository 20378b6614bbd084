"""Legs for kernels: where a leg's joints are, rolling a foot over its toe, bending to a target.

The counterpart of `stitchers.legs` and `motion.two_bone_ik`, for one leg at a time. A leg is a
tuple of hip, knee, ankle and toe, and the rotations of thigh, shin and foot, in the root's frame.
"""

import math
from typing import Any

from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.turns import (
    Quaternion,
    Vector,
    conjugate,
    cross,
    dot,
    from_scaled_axis,
    multiply,
    rotate,
)

Leg = tuple[Vector, Vector, Vector, Vector, Quaternion, Quaternion, Quaternion]

_SOFT_REACH, _MOST_ROLL = 0.03, 0.9
_POLE, _BUFFER = 0.03, 0.015


@kernel
def add(a: Vector, b: Vector) -> Vector:
    """Return the sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@kernel
def less(a: Vector, b: Vector) -> Vector:
    """Return the difference."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def times(a: Vector, factor: float) -> Vector:
    """Return the multiple."""
    return a[0] * factor, a[1] * factor, a[2] * factor


@kernel
def length(a: Vector) -> float:
    """Return the length."""
    return math.sqrt(dot(a, a))


@kernel
def turn_of(rotations: Any, row: int, joint: int) -> Quaternion:
    """Return a rotation of `(N, J, 4)` as a tuple."""
    return (
        float(rotations[row, joint, 0]),
        float(rotations[row, joint, 1]),
        float(rotations[row, joint, 2]),
        float(rotations[row, joint, 3]),
    )


@kernel
def leg_pose(legs: Any, side: int, hips: Vector, rotations: Any, row: int) -> Leg:
    """Return a leg of a pose: hips relative to the root, local rotations `(N, J, 4)`."""
    offsets = legs.offsets
    pelvis = turn_of(rotations, row, 0)
    thigh = multiply(pelvis, turn_of(rotations, row, legs.thigh[side]))
    shin = multiply(thigh, turn_of(rotations, row, legs.shin[side]))
    foot = multiply(shin, turn_of(rotations, row, legs.foot[side]))
    hip = add(hips, rotate(pelvis, point(offsets, 0, side)))
    knee = add(hip, rotate(thigh, point(offsets, 1, side)))
    ankle = add(knee, rotate(shin, point(offsets, 2, side)))
    toe = add(ankle, rotate(foot, point(offsets, 3, side)))
    return hip, knee, ankle, toe, thigh, shin, foot


@kernel
def point(points: Any, row: int, side: int) -> Vector:
    """Return a point of `(N, 2, 3)` as a tuple."""
    return float(points[row, side, 0]), float(points[row, side, 1]), float(points[row, side, 2])


@kernel
def roll(leg: Leg, toe: Vector, reach: float) -> tuple[Quaternion, Vector]:
    """Roll a foot over its toe where the leg would be too short; see `legs.raise_heels`.

    Returns:
        The foot's rotation, and where the ankle is from the toe.
    """
    hip, ankle = leg[0], leg[2]
    foot = less(ankle, leg[3])
    up = less(hip, toe)
    size, distance = length(foot), max(length(up), 1e-6)
    cosine = dot(foot, up) / max(size * distance, 1e-9)
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    stretch = smooth_min(length(less(add(toe, foot), hip)), reach, _SOFT_REACH)
    nearest = (distance**2 + size**2 - stretch**2) / max(2.0 * distance * size, 1e-9)
    widest = math.acos(min(max(nearest, -1.0), 1.0))
    excess = min(max(angle - widest, 0.0), _MOST_ROLL)
    axis = cross(foot, up)
    turn = from_scaled_axis(times(axis, excess / max(length(axis), 1e-9)))
    return multiply(turn, leg[6]), rotate(turn, foot)


@kernel
def smooth_min(a: float, b: float, width: float) -> float:
    """Return the smaller of both, rounded off where they differ by less than `width`."""
    near = max(width - abs(a - b), 0.0)
    return min(a, b) - near * near / (4.0 * width)


@kernel
def bend(
    leg: Leg, pelvis: Quaternion, foot: Quaternion, target: Vector
) -> tuple[Quaternion, Quaternion, Quaternion, Vector]:
    """Bend a leg so that its ankle reaches a target; see `two_bone_ik`.

    Args:
        leg: Now, the hips where they are to be.
        pelvis: Rotation of the hips.
        foot: Rotation that the foot is to have in the root's frame.
        target: Of the ankle.

    Returns:
        Local rotations of thigh, shin and foot, and where the ankle came to lie.
    """
    upper, lower, end = _two_bones(leg, target)
    return (
        multiply(conjugate(pelvis), upper),
        multiply(conjugate(upper), lower),
        multiply(conjugate(lower), foot),
        end,
    )


@kernel
def _two_bones(leg: Leg, target: Vector) -> tuple[Quaternion, Quaternion, Vector]:
    start, middle, end = leg[0], leg[1], leg[2]
    thigh, shin, span = less(middle, start), less(end, middle), less(end, start)
    upper, lower = length(thigh), length(shin)
    reach = less(target, start)
    distance = length(reach)
    longest = max(upper + lower - _BUFFER, length(span))
    shortest = abs(upper - lower) + 1e-4
    clamped = min(max(distance, shortest), longest)
    if distance < 1e-6:
        reach = span
    direction = times(reach, 1.0 / length(reach))
    swing = between(span, reach)
    side = _aside(rotate(swing, thigh), rotate(swing, rotate(leg[5], (0.0, 0.0, 1.0))), direction)
    along = (clamped**2 + upper**2 - lower**2) / (2.0 * clamped)
    away = math.sqrt(max(upper**2 - along**2, 0.0))
    new_middle = add(times(direction, along), times(side, away))
    new_end = times(direction, clamped)
    return (
        _turned(swing, thigh, new_middle, leg[4]),
        _turned(swing, shin, less(new_end, new_middle), leg[5]),
        add(start, new_end),
    )


@kernel
def _aside(bend: Vector, pole: Vector, direction: Vector) -> Vector:
    """Return the unit direction to which a middle leans, never backwards."""
    bend = less(bend, times(direction, dot(bend, direction)))
    pole = less(pole, times(direction, dot(pole, direction)))
    pole = times(pole, 1.0 / max(length(pole), 1e-9))
    backwards = min(dot(bend, pole), 0.0)
    bend = add(bend, times(pole, max(0.0, _POLE - length(bend) - 2.0 * backwards)))
    return times(bend, 1.0 / max(length(bend), 1e-9))


@kernel
def _turned(swing: Quaternion, old: Vector, new: Vector, rotation: Quaternion) -> Quaternion:
    turn = between(rotate(swing, old), new)
    return multiply(multiply(turn, swing), rotation)


@kernel
def between(a: Vector, b: Vector) -> Quaternion:
    """Return the shortest turn from one direction to another; see `quaternion.between`."""
    a, b = times(a, 1.0 / length(a)), times(b, 1.0 / length(b))
    w = 1.0 + dot(a, b)
    axis = cross(a, b)
    if w < 1e-7:
        w = 0.0
        axis = cross(a, (1.0, 0.0, 0.0)) if abs(a[0]) < 0.9 else cross(a, (0.0, 1.0, 0.0))
    size = 1.0 / math.sqrt(w * w + dot(axis, axis))
    return w * size, axis[0] * size, axis[1] * size, axis[2] * size
