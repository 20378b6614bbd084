"""Intent for kernels: where the simulated root goes, who stands, who searches.

The counterpart of `runtime.intent`, `standing.stands` and `choice.due`, for characters without a
given path.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.moments import Clips, moment, nearest
from stridewire_engine.compiled.turns import decay, wrap_angle

_LN2 = math.log(2.0)
_TURNING_SPEED = 0.2


class Wants(NamedTuple):
    """Columns of characters that tell what they are asked for and when they searched."""

    desired_velocity: Floats
    desired_facing: Floats
    responsiveness: Floats
    goal_yaw: Floats
    sim_position: Floats
    sim_velocity: Floats
    sim_acceleration: Floats
    sim_yaw: Floats
    sim_yaw_velocity: Floats
    root_yaw: Floats
    root_speed: Floats
    until_search: Floats
    searched_velocity: Floats
    searched_yaw: Floats
    force_search: Flags
    has_path: Flags
    clip: Indices
    clip_time: Floats
    time: Floats


class Halflives(NamedTuple):
    """Of velocity and heading, in seconds, and what they are multiplied by at both ends."""

    velocity: float
    facing: float
    quality: tuple[float, float]
    """Multiples at responsiveness 0."""
    response: tuple[float, float]
    """At responsiveness 1."""


class Turns(NamedTuple):
    """When a character's turn to search is; seconds, m/s, radians. See `TickSettings`."""

    search_interval: float
    shortest_interval: float
    control_jump: float
    facing_jump: float
    idle_speed: float
    idle_turn: float
    clip_end_margin: float


class Reasons(NamedTuple):
    """Values of `TransitionReason`."""

    better_match: int
    control_change: int
    forced: int
    clip_end: int
    start: int


@kernel
def look(
    wants: Wants,
    clips: Clips,
    spans: Indices,
    times: Floats,
    halflives: Halflives,
    turns: Turns,
    reasons: Reasons,
    dt: Floats,
    positions: Floats,
    yaws: Floats,
    reason: Indices,
) -> None:
    """Set the goals of N characters, predict their simulated roots, and say why they search.

    Args:
        wants: Of the characters; their clocks run, goals are set.
        clips: Of the library.
        spans: `(F,)` first row of the standing span of each row, -1 for none.
        times: `(K,)` seconds ahead.
        halflives: Of the simulated root.
        turns: When whose turn is.
        reasons: Values.
        dt: `(N,)` seconds.
        positions: `(N, K, 2)` out: x and z of the simulated roots in the world.
        yaws: `(N, K)` out.
        reason: `(N,)` out: why to search now, 0 for no reason.
    """
    for row in range(len(dt)):
        wants.time[row] += dt[row]
        _set_goal(wants, row)
        velocity_halflife, facing_halflife = _halflives(halflives, wants.responsiveness[row])
        goal = near(wants.goal_yaw[row], wants.sim_yaw[row])
        for k in range(len(times)):
            for axis in range(2):
                positions[row, k, axis] = velocity_spring(
                    wants, row, axis, velocity_halflife, times[k]
                )[0]
            turned, _ = decay(
                wants.sim_yaw[row] - goal, wants.sim_yaw_velocity[row], facing_halflife, times[k]
            )
            yaws[row, k] = turned + goal
        reason[row] = _due(wants, clips, spans, turns, reasons, row, dt[row])


@kernel
def _set_goal(wants: Wants, row: int) -> None:
    facing = wants.desired_facing[row]
    x, z = wants.desired_velocity[row, 0], wants.desired_velocity[row, 1]
    if not math.isnan(facing):
        wants.goal_yaw[row] = facing
    elif math.hypot(x, z) > _TURNING_SPEED:
        wants.goal_yaw[row] = math.atan2(x, z)


@kernel
def _halflives(halflives: Halflives, responsiveness: float) -> tuple[float, float]:
    """Return the half-lives of velocity and heading; see `response.multiples`."""
    velocity, facing = halflives.velocity, halflives.facing
    if responsiveness > 0.5:
        more = 2.0 * responsiveness - 1.0
        velocity *= halflives.response[0] ** more
        facing *= halflives.response[1] ** more
    elif responsiveness < 0.5:
        less = 1.0 - 2.0 * responsiveness
        velocity *= halflives.quality[0] ** less
        facing *= halflives.quality[1] ** less
    return velocity, facing


@kernel
def near(angle: float, reference: float) -> float:
    """Return the same angle, at most half a turn from the reference."""
    return reference + wrap_angle(angle - reference)


@kernel
def velocity_spring(
    wants: Wants, row: int, axis: int, halflife: float, dt: float
) -> tuple[float, float, float]:
    """Return position, velocity and acceleration of the simulated root; see `springs`."""
    goal = wants.desired_velocity[row, axis]
    y = 2.0 * _LN2 / max(halflife, 1e-5)
    a = wants.sim_acceleration[row, axis]
    j0 = wants.sim_velocity[row, axis] - goal
    j1 = a + j0 * y
    e = math.exp(-y * dt)
    moved = e * (-j1 / (y * y) + (-j0 - j1 * dt) / y) + j1 / (y * y) + j0 / y
    return (
        moved + goal * dt + wants.sim_position[row, axis],
        e * (j0 + j1 * dt) + goal,
        e * (a - j1 * (y * dt)),
    )


@kernel
def advance(wants: Wants, row: int, halflives: Halflives, dt: float) -> None:
    """Move the simulated root by `dt` seconds towards its goals."""
    velocity_halflife, facing_halflife = _halflives(halflives, wants.responsiveness[row])
    for axis in range(2):
        position, velocity, acceleration = velocity_spring(wants, row, axis, velocity_halflife, dt)
        wants.sim_position[row, axis] = position
        wants.sim_velocity[row, axis] = velocity
        wants.sim_acceleration[row, axis] = acceleration
    goal = near(wants.goal_yaw[row], wants.sim_yaw[row])
    off, turning = decay(
        wants.sim_yaw[row] - goal, wants.sim_yaw_velocity[row], facing_halflife, dt
    )
    wants.sim_yaw[row], wants.sim_yaw_velocity[row] = off + goal, turning


@kernel
def stands(wants: Wants, row: int, spans: Indices, playing: int, turns: Turns) -> bool:
    """Tell whether a character stands and is asked to go on standing; see `standing.stands`."""
    if wants.has_path[row]:
        return False
    asked = math.hypot(wants.desired_velocity[row, 0], wants.desired_velocity[row, 1])
    moving = math.hypot(wants.sim_velocity[row, 0], wants.sim_velocity[row, 1])
    turn = abs(wrap_angle(wants.goal_yaw[row] - wants.root_yaw[row]))
    wanted = max(asked, moving) < turns.idle_speed and turn < turns.idle_turn
    return wanted and (wants.root_speed[row] < turns.idle_speed or spans[playing] >= 0)


@kernel
def _due(
    wants: Wants,
    clips: Clips,
    spans: Indices,
    turns: Turns,
    reasons: Reasons,
    row: int,
    dt: float,
) -> int:
    """Return the reason to search now, 0 for none; the search's clock runs. See `choice.due`."""
    wants.until_search[row] -= dt
    left, clip = wants.until_search[row], wants.clip[row]
    if clip < 0:
        return reasons.start
    if dt <= 0.0:
        return 0
    length = (clips.frames[clip] - 1) / clips.frame_rate
    if not clips.loops[clip] and wants.clip_time[row] + dt > length - turns.clip_end_margin:
        return reasons.clip_end
    if wants.force_search[row]:
        return reasons.forced
    change = math.hypot(
        wants.desired_velocity[row, 0] - wants.searched_velocity[row, 0],
        wants.desired_velocity[row, 1] - wants.searched_velocity[row, 1],
    )
    turned = abs(wrap_angle(wants.goal_yaw[row] - wants.searched_yaw[row]))
    waited = turns.search_interval - left >= turns.shortest_interval
    if waited and (change > turns.control_jump or turned > turns.facing_jump):
        return reasons.control_change
    if left <= 0.0:
        at, weight = moment(clips, clip, wants.clip_time[row])
        if not stands(wants, row, spans, nearest(at, weight), turns):
            return reasons.better_match
    return 0
