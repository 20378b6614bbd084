"""Feet for kernels: planted toes are locked in the world, and what was shown is remembered.

The counterpart of `runtime.feet`, `refining.remember` and the tick's block.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.legs import Leg, add, bend, leg_pose, length, less, roll, turn_of
from stridewire_engine.compiled.stance import LegJoints, write
from stridewire_engine.compiled.turns import Vector, decay, to_root, to_world

_LANDING_WAY = 0.0125 / math.log(2.0)
_REACH, _SOFT_REACH, _WELL_MOVED, _LOWEST_TOE = 0.985, 0.03, 0.02, 0.5
_EVEN, _TELEPORT, _FRAME_RATE = 0.02, 1.0, 60.0


class Locks(NamedTuple):
    """Columns of characters that locks and the stitchers' toes need."""

    foot_lock: Flags
    planted: Flags
    locked: Flags
    lock_point: Vectors
    toe: Vectors
    toe_offset: Vectors
    toe_offset_velocity: Vectors
    toe_shown: Vectors
    toe_speed: Vectors
    toe_gap_speed: Vectors
    toe_lift: Floats
    toe_lift_speed: Floats
    toe_step: Floats
    hip_drop: Floats
    hip_drop_speed: Floats
    root_position: Vectors
    root_yaw: Floats
    time: Floats


class Shown(NamedTuple):
    """Columns of characters that tell what was shown."""

    shown_world: Vectors
    shown_local: Vectors
    shown_velocity: Vectors
    past_root: Floats
    past_shown: Vectors
    past_contacts: Flags
    past_frames: Indices
    past_uneven: Flags


@kernel
def plant(
    locks: Locks,
    shown: Shown,
    legs: LegJoints,
    stands: Flags,
    halflife: float,
    unlock_distance: float,
    dt: Floats,
    hips: Vectors,
    rotations: Quaternions,
    contacts: Flags,
) -> None:
    """Lock the toes of N characters, bend their legs accordingly, remember what is shown.

    Args:
        locks: Of the characters.
        shown: Of the characters.
        legs: Of the skeleton.
        stands: `(N,)` whose feet the stitcher has planted already.
        halflife: Of feet that lock or unlock, seconds.
        unlock_distance: Metres.
        dt: `(N,)` seconds.
        hips: `(N, 3)` relative to the root.
        rotations: `(N, J, 4)` local; legs are bent in place.
        contacts: `(N, 4)` of the clips; those of feet that take a step of their own are cleared.
    """
    for row in range(len(dt)):
        sine, cosine = math.sin(locks.root_yaw[row]), math.cos(locks.root_yaw[row])
        at = (float(hips[row, 0]), float(hips[row, 1]), float(hips[row, 2]))
        pelvis = turn_of(rotations, row, 0)
        for side in range(2):
            if locks.toe_step[row, side] > 0.0:
                contacts[row, 2 * side] = contacts[row, 2 * side + 1] = False
            leg = leg_pose(legs, side, at, rotations, row)
            toe = _in_world(locks, row, leg[3], sine, cosine)
            planted = contacts[row, 2 * side + 1]
            locked = _lock(
                locks, row, side, toe, planted, stands[row], legs.toe_height, halflife,
                unlock_distance, dt[row],
            )  # fmt: skip
            ankle, toe_local = leg[2], leg[3]
            if not stands[row]:
                shift = to_root(less(locked, toe), sine, cosine)
                ankle, toe_local = _bend(legs, side, leg, pelvis, shift, rotations, row)
            _remember(locks, shown, row, side, ankle, dt[row], sine, cosine)
            _remember(locks, shown, row, 2 + side, toe_local, dt[row], sine, cosine)
        _remember(locks, shown, row, 4, at, dt[row], sine, cosine)
        if not stands[row]:
            _keep_for_stance(locks, shown, row, sine, cosine)
        if dt[row] > 0.0:
            _keep_past(locks, shown, row, contacts, dt[row])


@kernel
def _in_world(locks: Locks, row: int, local: Vector, sine: float, cosine: float) -> Vector:
    x, y, z = to_world(local, sine, cosine)
    root = locks.root_position
    return x + root[row, 0], y + root[row, 1], z + root[row, 2]


@kernel
def _lock(
    locks: Locks,
    row: int,
    side: int,
    toe: Vector,
    planted: bool,
    stands: bool,
    toe_height: float,
    halflife: float,
    unlock_distance: float,
    dt: float,
) -> Vector:
    """Update a lock and return where the toe is shown, in the world; see `feet._lock`."""
    first = locks.time[row] <= dt
    locked = locks.locked[row, side]
    point = locks.lock_point
    x, y, z = toe
    gone = (point[row, side, 0] - x, point[row, side, 1] - y, point[row, side, 2] - z)
    far = not stands and length(gone) > unlock_distance
    begins = planted and (not locks.planted[row, side] or first) and locks.foot_lock[row]
    ends = locked and (not planted or far or not locks.foot_lock[row])
    height = locks.root_position[row, 1] + toe_height
    x = _lock_axis(locks, row, side, 0, x, math.nan, begins, ends, stands, first, halflife, dt)
    y = _lock_axis(locks, row, side, 1, y, height, begins, ends, stands, first, halflife, dt)
    z = _lock_axis(locks, row, side, 2, z, math.nan, begins, ends, stands, first, halflife, dt)
    locks.locked[row, side] = (locked or begins) and not ends
    locks.planted[row, side] = planted
    return x, max(y, locks.root_position[row, 1] + _LOWEST_TOE * toe_height), z


@kernel
def _lock_axis(
    locks: Locks,
    row: int,
    side: int,
    axis: int,
    toe: float,
    pin: float,
    begins: bool,
    ends: bool,
    stands: bool,
    first: bool,
    halflife: float,
    dt: float,
) -> float:
    """Update one axis of a lock and return where the toe is shown; `pin` NaN is where that is."""
    offset, speed = locks.toe_offset, locks.toe_offset_velocity
    left, rate = decay(offset[row, side, axis], speed[row, side, axis], halflife, dt)
    velocity = 0.0
    if dt > 0.0 and not first:
        velocity = (toe - locks.toe[row, side, axis]) / max(dt, 1e-6)
    shown, way = toe, 0.0
    if stands:
        way = locks.toe_speed[row, side, axis] * _LANDING_WAY
    elif locks.locked[row, side]:
        shown = locks.lock_point[row, side, axis] + left
    else:
        shown = toe + left
    if math.isnan(pin):
        pin = shown + way
    if stands:
        left, rate = 0.0, 0.0
    elif ends:
        left, rate = shown - toe, rate - velocity
    elif begins:
        left, rate = shown - pin, 0.0
    offset[row, side, axis], speed[row, side, axis] = left, rate
    if begins:
        locks.lock_point[row, side, axis] = pin
    locks.toe[row, side, axis] = toe
    return float(shown)


@kernel
def _bend(
    legs: LegJoints,
    side: int,
    leg: Leg,
    pelvis: tuple[float, float, float, float],
    shift: Vector,
    rotations: Quaternions,
    row: int,
) -> tuple[Vector, Vector]:
    """Bend a leg so that its toe is shifted; return where ankle and toe came to lie."""
    moved = min(length(shift) / _WELL_MOVED, 1.0)
    reach = max(_REACH * legs.length, length(less(leg[0], leg[2]))) + _SOFT_REACH * (1.0 - moved)
    toe = add(leg[3], shift)
    foot, from_toe = roll(leg, toe, reach)
    thigh, shin, turn, ankle = bend(leg, pelvis, foot, add(toe, from_toe))
    write(rotations, row, legs.thigh[side], thigh)
    write(rotations, row, legs.shin[side], shin)
    write(rotations, row, legs.foot[side], turn)
    return ankle, less(ankle, from_toe)


@kernel
def _remember(
    locks: Locks, shown: Shown, row: int, joint: int, local: Vector, dt: float, sine: float,
    cosine: float,
) -> None:  # fmt: skip
    """Note where one of `SHOWN_JOINTS` is shown and how fast it moves, for the next query."""
    at = _in_world(locks, row, local, sine, cosine)
    world = shown.shown_world
    if dt > 0.0:
        rate = (0.0, 0.0, 0.0)
        if locks.time[row] > dt:
            step = max(dt, 1e-6)
            rate = (
                (at[0] - world[row, joint, 0]) / step,
                (at[1] - world[row, joint, 1]) / step,
                (at[2] - world[row, joint, 2]) / step,
            )
        seen = to_root(rate, sine, cosine)
        for axis in range(3):
            shown.shown_velocity[row, joint, axis] = seen[axis]
    for axis in range(3):
        shown.shown_local[row, joint, axis] = local[axis]
        world[row, joint, axis] = at[axis]


@kernel
def _keep_for_stance(locks: Locks, shown: Shown, row: int, sine: float, cosine: float) -> None:
    """Note what a stitcher that plants feet has to start from."""
    velocity = shown.shown_velocity
    for side in range(2):
        toe = 2 + side
        speed = to_world(
            (
                float(velocity[row, toe, 0]),
                float(velocity[row, toe, 1]),
                float(velocity[row, toe, 2]),
            ),
            sine,
            cosine,
        )
        for axis in range(3):
            locks.toe_shown[row, side, axis] = shown.shown_world[row, toe, axis]
            locks.toe_speed[row, side, axis] = speed[axis]
            locks.toe_gap_speed[row, side, axis] = 0.0
        locks.toe_lift[row, side] = locks.toe_lift_speed[row, side] = 0.0
        locks.toe_step[row, side] = 0.0
    locks.hip_drop[row] = locks.hip_drop_speed[row] = 0.0


@kernel
def _keep_past(locks: Locks, shown: Shown, row: int, contacts: Flags, dt: float) -> None:
    """Keep what was shown in the last frames; see `refining.remember`."""
    past, last = shown.past_root, shown.past_root.shape[1] - 1
    away = 0.0
    for axis in range(3):
        away = max(away, abs(past[row, last, axis] - locks.root_position[row, axis]))
    far, even = away > _TELEPORT, abs(dt * _FRAME_RATE - 1.0) < _EVEN
    if even and not far:
        shown.past_frames[row] = min(shown.past_frames[row] + 1, last + 1)
    else:
        shown.past_frames[row] = 1
        shown.past_uneven[row] = not even
    for frame in range(last):
        for i in range(4):
            past[row, frame, i] = past[row, frame + 1, i]
        for joint in range(5):
            for axis in range(3):
                shown.past_shown[row, frame, joint, axis] = shown.past_shown[
                    row, frame + 1, joint, axis
                ]
        for side in range(2):
            shown.past_contacts[row, frame, side] = shown.past_contacts[row, frame + 1, side]
    for axis in range(3):
        past[row, last, axis] = locks.root_position[row, axis]
        for joint in range(5):
            shown.past_shown[row, last, joint, axis] = shown.shown_world[row, joint, axis]
    past[row, last, 3] = locks.root_yaw[row]
    for side in range(2):
        shown.past_contacts[row, last, side] = contacts[row, 2 * side + 1]
