"""Jumping for kernels: characters are handed over from one moment of the library to another.

The counterpart of `Tick._jump` with `offsets.hand_over` and `Stance.begin`.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.footing import gentle_halflife
from stridewire_engine.compiled.legs import add, less, times
from stridewire_engine.compiled.moments import Clips, moment, root_step
from stridewire_engine.compiled.turns import (
    Quaternion,
    Vector,
    conjugate,
    cross,
    dot,
    from_scaled_axis,
    multiply,
    rotate,
    to_scaled_axis,
    to_world,
)

_STRONGEST_HIPS, _STRONGEST_TURN = 8.0, 25.0


class Handed(NamedTuple):
    """Columns of characters that a jump changes."""

    offset_hips: Vectors
    offset_hips_velocity: Vectors
    offset_rotations: Vectors
    offset_angular_velocity: Vectors
    body_halflife: Floats
    toe_shown: Vectors
    toe_gap: Vectors
    toe_gap_speed: Vectors
    toe_swing: Floats
    toe_step: Floats
    root_position: Vectors
    root_yaw: Floats
    root_offset: Floats
    pace: Floats
    goes_back: Flags
    clip: Indices
    clip_time: Floats
    since_jump: Floats
    recent: Indices
    recent_time: Floats
    time: Floats


class Leaps(NamedTuple):
    """Where M characters jump from and to."""

    characters: Indices
    from_clip: Indices
    from_time: Floats
    to_clip: Indices
    to_time: Floats
    to_row: Indices


@kernel
def hand_over(handed: Handed, clips: Clips, leaps: Leaps) -> None:
    """Take what is shown over into offsets from the new moments, and set the characters to them."""
    for i in range(len(leaps.characters)):
        row, pace = leaps.characters[i], handed.pace[leaps.characters[i]]
        # who begins has played nothing; what is taken over is cleared afterwards
        old, share = moment(clips, max(leaps.from_clip[i], 0), leaps.from_time[i])
        new, weight = moment(clips, leaps.to_clip[i], leaps.to_time[i])
        _root_velocity(handed, clips, row, old, max(leaps.from_clip[i], 0), pace)
        _root_velocity(handed, clips, row, new, leaps.to_clip[i], -1.0)
        _hips(handed, clips, row, old, share, pace, new, weight)
        for joint in range(clips.rotations.shape[1]):
            _joint(handed, clips, row, joint, old, share, pace, new, weight)
        _toes(handed, clips, row, old, pace, new, weight)
        handed.pace[row], handed.goes_back[row] = 1.0, False
        handed.clip[row], handed.clip_time[row] = leaps.to_clip[i], leaps.to_time[i]
        handed.since_jump[row] = 0.0
        for past in range(handed.recent.shape[1] - 1, 0, -1):
            handed.recent[row, past] = handed.recent[row, past - 1]
            handed.recent_time[row, past] = handed.recent_time[row, past - 1]
        handed.recent[row, 0], handed.recent_time[row, 0] = leaps.to_row[i], handed.time[row]


@kernel
def _root_velocity(
    handed: Handed, clips: Clips, row: int, at: int, clip: int, factor: float
) -> None:
    """Add a clip's root velocity, times a factor, to what is left to fade."""
    x, z, yaw = root_step(clips, clip, at, 0.0, at, 1.0)
    scale = clips.frame_rate * factor
    handed.root_offset[row, 0] += x * scale
    handed.root_offset[row, 1] += z * scale
    handed.root_offset[row, 2] += yaw * scale


@kernel
def _hips(
    handed: Handed,
    clips: Clips,
    row: int,
    old: int,
    share: float,
    pace: float,
    new: int,
    weight: float,
) -> None:
    offset, speed, hips = handed.offset_hips, handed.offset_hips_velocity, clips.hips
    for axis in range(3):
        left, came = hips[old + 1, axis] - hips[old, axis], hips[new + 1, axis] - hips[new, axis]
        offset[row, axis] += hips[old, axis] + share * left - hips[new, axis] - weight * came
        speed[row, axis] += (left * pace - came) * clips.frame_rate
    handed.body_halflife[row, 0] = gentle_halflife(
        offset[row, 0], offset[row, 1], offset[row, 2], _STRONGEST_HIPS
    )


@kernel
def _joint(
    handed: Handed,
    clips: Clips,
    row: int,
    joint: int,
    old: int,
    share: float,
    pace: float,
    new: int,
    weight: float,
) -> None:
    offset, speed = handed.offset_rotations, handed.offset_angular_velocity
    v = (1.0 * offset[row, joint, 0], 1.0 * offset[row, joint, 1], 1.0 * offset[row, joint, 2])
    rate = (1.0 * speed[row, joint, 0], 1.0 * speed[row, joint, 1], 1.0 * speed[row, joint, 2])
    source, spin = _turning(clips, joint, old, share, pace)
    target, target_spin = _turning(clips, joint, new, weight, 1.0)
    turn = from_scaled_axis(v)
    shown_spin = add(_to_velocity(v, rate), rotate(turn, spin))
    new_turn = multiply(multiply(turn, source), conjugate(target))
    if new_turn[0] < 0.0:
        new_turn = (-new_turn[0], -new_turn[1], -new_turn[2], -new_turn[3])
    v = to_scaled_axis(new_turn)
    rate = _from_velocity(v, less(shown_spin, rotate(new_turn, target_spin)))
    for axis in range(3):
        offset[row, joint, axis], speed[row, joint, axis] = v[axis], rate[axis]
    handed.body_halflife[row, 1 + joint] = gentle_halflife(v[0], v[1], v[2], _STRONGEST_TURN)


@kernel
def _turning(
    clips: Clips, joint: int, at: int, weight: float, pace: float
) -> tuple[Quaternion, Vector]:
    """Return a joint's rotation between two rows, and how it turns."""
    turns = clips.rotations
    a = (
        1.0 * turns[at, joint, 0],
        1.0 * turns[at, joint, 1],
        1.0 * turns[at, joint, 2],
        1.0 * turns[at, joint, 3],
    )
    b = (
        1.0 * turns[at + 1, joint, 0],
        1.0 * turns[at + 1, joint, 1],
        1.0 * turns[at + 1, joint, 2],
        1.0 * turns[at + 1, joint, 3],
    )
    own = 1.0 - weight
    other = weight if a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] >= 0.0 else -weight
    w, x, y, z = (
        own * a[0] + other * b[0],
        own * a[1] + other * b[1],
        own * a[2] + other * b[2],
        own * a[3] + other * b[3],
    )
    size = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
    spin = times(to_scaled_axis(multiply(b, conjugate(a))), clips.frame_rate * pace)
    return (w * size, x * size, y * size, z * size), spin


@kernel
def _to_velocity(v: Vector, rate: Vector) -> Vector:
    """Return an angular velocity; see `quaternion.scaled_axis_to_velocity`."""
    angle = math.sqrt(dot(v, v))
    first, second = 0.5, 1.0 / 6.0
    if angle >= 1e-2:
        first = (1.0 - math.cos(angle)) / angle**2
        second = (angle - math.sin(angle)) / angle**3
    once = cross(v, rate)
    return add(add(rate, times(once, first)), times(cross(v, once), second))


@kernel
def _from_velocity(v: Vector, velocity: Vector) -> Vector:
    """Return the rate of a rotation vector; see `quaternion.scaled_axis_from_velocity`."""
    angle = math.sqrt(dot(v, v))
    second = 1.0 / 12.0
    if angle >= 1e-1:
        second = 1.0 / angle**2 - 1.0 / (2.0 * angle * math.tan(0.5 * angle))
    once = cross(v, velocity)
    return add(less(velocity, times(once, 0.5)), times(cross(v, once), second))


@kernel
def _toes(
    handed: Handed, clips: Clips, row: int, old: int, pace: float, new: int, weight: float
) -> None:
    """Toes stay where they are; only what they are off by changes."""
    sine, cosine = math.sin(handed.root_yaw[row]), math.cos(handed.root_yaw[row])
    track, rate = clips.toe_tracks, clips.frame_rate
    for side in range(2):
        here = (
            track[new, side, 0] + weight * (track[new + 1, side, 0] - track[new, side, 0]),
            track[new, side, 1] + weight * (track[new + 1, side, 1] - track[new, side, 1]),
            track[new, side, 2] + weight * (track[new + 1, side, 2] - track[new, side, 2]),
        )
        faster = (
            rate * (pace * (track[old + 1, side, 0] - track[old, side, 0])
                    - (track[new + 1, side, 0] - track[new, side, 0])),
            rate * (pace * (track[old + 1, side, 1] - track[old, side, 1])
                    - (track[new + 1, side, 1] - track[new, side, 1])),
            rate * (pace * (track[old + 1, side, 2] - track[old, side, 2])
                    - (track[new + 1, side, 2] - track[new, side, 2])),
        )  # fmt: skip
        at, more = to_world(here, sine, cosine), to_world(faster, sine, cosine)
        for axis in range(3):
            handed.toe_gap[row, side, axis] = handed.toe_shown[row, side, axis] - (
                at[axis] + handed.root_position[row, axis]
            )
            handed.toe_gap_speed[row, side, axis] += more[axis]
        handed.toe_swing[row, side] = handed.toe_step[row, side] = 0.0
