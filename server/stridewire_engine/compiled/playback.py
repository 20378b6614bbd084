"""Playback for kernels: clips go on, their poses are sampled, roots move and are pulled.

The counterpart of `intent.advance`, `standing.advance`, `runtime.sampling` and `runtime.root`.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.compiled import intent, kernel
from stridewire_engine.compiled.intent import Halflives, Turns, Wants
from stridewire_engine.compiled.moments import Clips, moment, nearest, root_step, turned
from stridewire_engine.compiled.turns import damper_fraction, wrap_angle

_LN2 = math.log(2.0)
_TURNING_HALFLIFE = 0.2
_ROOM_S = 0.8 * _TURNING_HALFLIFE


class Spans(NamedTuple):
    """First and last row `(F,)` of each row's standing span, -1 for none; see `standing`."""

    first: Indices
    last: Indices


class Moves(NamedTuple):
    """Columns of characters that playback and roots change."""

    path_elapsed: Floats
    clip_time: Floats
    pace: Floats
    goes_back: Flags
    since_jump: Floats
    root_position: Vectors
    root_yaw: Floats
    root_offset: Floats
    root_speed: Floats
    correction: Floats


class Pull(NamedTuple):
    """How roots are pulled to simulated ones; half-lives in seconds. See `TickSettings`."""

    root_halflife: float
    adjust_position_halflife: float
    adjust_yaw_halflife: float
    adjust_share: float
    adjust_turn_per_metre: float
    leash: float
    yaw_leash: float
    correction_halflife: float


class Played(NamedTuple):
    """What comes of it, arrays of N rows that are written."""

    rows: Indices
    """`(N,)` row of the library at or before the time."""
    weight: Floats
    """`(N,)` float32 share of the next one."""
    hips: Vectors
    """`(N, 3)` float32, relative to the root."""
    rotations: Quaternions
    """`(N, J, 4)` float32."""
    contacts: Flags
    """`(N, 4)`."""
    motion: Floats
    """`(N, 3)` the clip's root motion: x, z, yaw."""
    delta: Floats
    """`(N, 4)` the root's: x, y, z in its frame before, yaw."""


@kernel
def play(
    wants: Wants,
    moves: Moves,
    clips: Clips,
    spans: Spans,
    halflives: Halflives,
    turns: Turns,
    pull: Pull,
    dt: Floats,
    played: Played,
) -> None:
    """Advance N characters without a given path by `dt` `(N,)` seconds: clips, poses, roots."""
    for row in range(len(dt)):
        passed = dt[row]
        intent.advance(wants, row, halflives, passed)
        moves.path_elapsed[row] += passed
        clip = wants.clip[row]
        before, share = moment(clips, clip, moves.clip_time[row])
        moves.clip_time[row] += _go_on(
            wants, moves, clips, spans, turns, row, nearest(before, share), passed
        )
        moves.since_jump[row] += passed
        after, weight = moment(clips, clip, moves.clip_time[row])
        if clips.loops[clip]:
            length = (clips.frames[clip] - 1) / clips.frame_rate
            moves.clip_time[row] %= max(length, 1e-6)
        played.rows[row], played.weight[row] = after, weight
        _sample(clips, played, row, after, weight)
        x, z, yaw = root_step(clips, clip, before, share, after, weight)
        played.motion[row, 0], played.motion[row, 1], played.motion[row, 2] = x, z, yaw
        _move(wants, moves, pull, played.delta, row, x, z, yaw, passed)
        _correct(wants, moves, pull, row, passed)
        if passed > 0.0:
            way = math.hypot(played.delta[row, 0], played.delta[row, 2])
            moves.root_speed[row] = way / max(passed, 1e-6)


@kernel
def _go_on(
    wants: Wants,
    moves: Moves,
    clips: Clips,
    spans: Spans,
    turns: Turns,
    row: int,
    playing: int,
    dt: float,
) -> float:
    """Return by how many seconds the clip goes on; who stands goes forth and back."""
    first, last = spans.first[playing], spans.last[playing]
    stays = first >= 0 and intent.stands(wants, row, spans.first, playing, turns)
    room = _ROOM_S * clips.frame_rate
    back = last - playing < room or (moves.goes_back[row] and playing - first >= room)
    moves.goes_back[row] = stays and back
    wanted = -1.0 if moves.goes_back[row] else 1.0
    moves.pace[row] += (wanted - moves.pace[row]) * damper_fraction(_TURNING_HALFLIFE, dt)
    return float(moves.pace[row] * dt)


@kernel
def _sample(clips: Clips, played: Played, row: int, at: int, weight: float) -> None:
    """Write the pose between two rows of the library: nlerp, as `quaternion.nlerp` has it."""
    a, b = clips.rotations, clips.rotations
    for axis in range(3):
        here = clips.hips[at, axis]
        played.hips[row, axis] = here + weight * (clips.hips[at + 1, axis] - here)
    for joint in range(a.shape[1]):
        dot = 0.0
        for i in range(4):
            dot += a[at, joint, i] * b[at + 1, joint, i]
        other = -weight if dot < 0.0 else weight
        square = 0.0
        for i in range(4):
            mixed = a[at, joint, i] * (1.0 - weight) + b[at + 1, joint, i] * other
            played.rotations[row, joint, i] = mixed
            square += mixed * mixed
        scale = 1.0 / math.sqrt(square)
        for i in range(4):
            played.rotations[row, joint, i] *= scale
    for foot in range(4):
        played.contacts[row, foot] = clips.contacts[nearest(at, weight), foot]


@kernel
def _move(
    wants: Wants,
    moves: Moves,
    pull: Pull,
    delta: Floats,
    row: int,
    x: float,
    z: float,
    turn: float,
    dt: float,
) -> None:
    """Move a root by its clip and what is left of its old velocity; pull it."""
    left = 1.0 - damper_fraction(pull.root_halflife, dt)
    counts = (1.0 - left) * (pull.root_halflife / _LN2)
    offset, position, yaw = moves.root_offset, moves.root_position, moves.root_yaw[row]
    x, z = x + offset[row, 0] * counts, z + offset[row, 1] * counts
    turn += offset[row, 2] * counts
    for axis in range(3):
        offset[row, axis] *= left
    way_x, way_z = turned(x, z, yaw)
    fraction = damper_fraction(pull.adjust_position_halflife, dt)
    pull_x = (wants.sim_position[row, 0] - position[row, 0] - way_x) * fraction
    pull_z = (wants.sim_position[row, 1] - position[row, 2] - way_z) * fraction
    near = _limit(math.hypot(pull_x, pull_z), pull.adjust_share * math.hypot(way_x, way_z))
    way_x, way_z = way_x + pull_x * near, way_z + pull_z * near
    gap = wrap_angle(wants.sim_yaw[row] - yaw - turn)
    most = pull.adjust_share * abs(turn) + pull.adjust_turn_per_metre * math.hypot(way_x, way_z)
    more = gap * damper_fraction(pull.adjust_yaw_halflife, dt)
    turn += min(max(more, -most), most)
    delta[row, 0], delta[row, 2] = turned(way_x, way_z, -yaw)
    delta[row, 1], delta[row, 3] = 0.0, turn
    position[row, 0] += way_x
    position[row, 2] += way_z
    moves.root_yaw[row] += turn


@kernel
def _correct(wants: Wants, moves: Moves, pull: Pull, row: int, dt: float) -> None:
    """Blend a correction in and keep the simulated root where the character can follow."""
    fraction = damper_fraction(pull.correction_halflife, dt)
    position, sim = moves.root_position, wants.sim_position
    for axis in range(4):
        part = moves.correction[row, axis] * fraction
        moves.correction[row, axis] -= part
        if axis == 3:
            moves.root_yaw[row] += part
            wants.sim_yaw[row] += part
        else:
            position[row, axis] += part
            if axis != 1:
                sim[row, axis // 2] += part
    gap_x, gap_z = sim[row, 0] - position[row, 0], sim[row, 1] - position[row, 2]
    near = _limit(math.hypot(gap_x, gap_z), pull.leash)
    sim[row, 0], sim[row, 1] = position[row, 0] + gap_x * near, position[row, 2] + gap_z * near
    turn = wrap_angle(wants.sim_yaw[row] - moves.root_yaw[row])
    turn = min(max(turn, -pull.yaw_leash), pull.yaw_leash)
    wants.sim_yaw[row] = moves.root_yaw[row] + turn


@kernel
def _limit(length: float, most: float) -> float:
    """Return the factor that brings a length down to at most `most`."""
    return min(1.0, most / max(length, 1e-12))
