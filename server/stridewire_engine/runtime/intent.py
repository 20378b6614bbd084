"""Intent: springs move the simulated root and say where it will be."""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire.motion.springs import spring_damper_exact, velocity_spring_exact, wrap_angle
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.response import multiples
from stridewire_engine.runtime.settings import TickSettings

_TURNING_SPEED = 0.2
"""Slower than this, in m/s, a desired velocity has no direction worth turning to."""
_PATH_CATCH_UP_S = 0.3
"""A simulated root off its given path returns to it within about so many seconds."""


class Prediction(NamedTuple):
    """Where the simulated root will be, in the world, at K times ahead."""

    positions: Floats
    """`(N, K, 2)` x and z, metres."""
    yaws: Floats
    """`(N, K)` radians."""


def set_goals(state: Characters, max_speed: float) -> Floats:
    """Decide what the springs go for: the desired velocity, or what the given path asks for.

    Writes `goal_yaw`.

    Returns:
        `(N, 2)` goal velocity, m/s.
    """
    goal = state.desired_velocity
    facing = state.desired_facing
    if state.has_path.any():
        now, yaw_now = _path_at(state, np.zeros(1))
        soon, _ = _path_at(state, np.full(1, 0.1))
        pull = (soon[:, 0] - now[:, 0]) / 0.1 + (now[:, 0] - state.sim_position) / _PATH_CATCH_UP_S
        goal = np.where(state.has_path[:, None], np.clip(pull, -max_speed, max_speed), goal)
        facing = np.where(state.has_path, yaw_now[:, 0], facing)
    moving = np.hypot(goal[:, 0], goal[:, 1]) > _TURNING_SPEED
    along = np.where(moving, np.arctan2(goal[:, 0], goal[:, 1]), state.goal_yaw)
    state.goal_yaw[...] = np.where(np.isnan(facing), along, facing)
    return goal


def predict(state: Characters, goal: Floats, times: Floats, settings: TickSettings) -> Prediction:
    """Return where the simulated root will be, if the control stays as it is.

    Args:
        state: N rows.
        goal: `(N, 2)` goal velocity.
        times: `(K,)` seconds ahead.
        settings: Half-lives.
    """
    ahead = times[None, :, None]
    velocity_halflife, facing_halflife = _halflives(state, settings)
    positions, _, _ = velocity_spring_exact(
        state.sim_position[:, None],
        state.sim_velocity[:, None],
        state.sim_acceleration[:, None],
        goal[:, None],
        velocity_halflife[:, None, None],
        ahead,
    )
    yaws, _ = spring_damper_exact(
        state.sim_yaw[:, None],
        state.sim_yaw_velocity[:, None],
        _near(state.goal_yaw, state.sim_yaw)[:, None],
        facing_halflife[:, None],
        times[None],
    )
    if state.has_path.any():
        path, path_yaws = _path_at(state, times)
        positions = np.where(state.has_path[:, None, None], path, positions)
        along = np.where(np.isnan(path_yaws), yaws, path_yaws)
        yaws = np.where(state.has_path[:, None], along, yaws)
    return Prediction(positions, yaws)


def advance(state: Characters, goal: Floats, dt: Floats, settings: TickSettings) -> None:
    """Move the simulated root by `dt` `(N,)` seconds towards the goals."""
    velocity_halflife, facing_halflife = _halflives(state, settings)
    position, velocity, acceleration = velocity_spring_exact(
        state.sim_position,
        state.sim_velocity,
        state.sim_acceleration,
        goal,
        velocity_halflife[:, None],
        dt[:, None],
    )
    state.sim_position[...] = position
    state.sim_velocity[...] = velocity
    state.sim_acceleration[...] = acceleration
    yaw, turning = spring_damper_exact(
        state.sim_yaw,
        state.sim_yaw_velocity,
        _near(state.goal_yaw, state.sim_yaw),
        facing_halflife,
        dt,
    )
    state.sim_yaw[...] = yaw
    state.sim_yaw_velocity[...] = turning
    state.path_elapsed += dt


def _halflives(state: Characters, settings: TickSettings) -> tuple[Floats, Floats]:
    """Return the half-lives `(N,)` of velocity and heading."""
    factor = multiples(state.responsiveness)
    return (
        np.asarray(settings.velocity_halflife * factor.velocity_halflife),
        np.asarray(settings.facing_halflife * factor.facing_halflife),
    )


def to_root_frame(state: Characters, prediction: Prediction) -> Prediction:
    """Express a prediction in the character root's frame: x to the left, z ahead."""
    offset = prediction.positions - state.root_position[:, None, ::2]
    sine, cosine = np.sin(state.root_yaw)[:, None], np.cos(state.root_yaw)[:, None]
    left = offset[..., 0] * cosine - offset[..., 1] * sine
    front = offset[..., 0] * sine + offset[..., 1] * cosine
    return Prediction(
        np.stack([left, front], axis=-1), wrap_angle(prediction.yaws - state.root_yaw[:, None])
    )


def _path_at(state: Characters, times: Floats) -> tuple[Floats, Floats]:
    """Interpolate the given paths at so many seconds from now, clamped to their ends.

    Returns:
        `(N, K, 2)` positions and `(N, K)` yaws, NaN where a path gives none.
    """
    at = state.path_elapsed[:, None] + times[None]
    knots = state.path[:, :, 3]
    # the last point repeats with the same time, so the count never passes the last real segment
    after = (knots[:, None, :] <= at[:, :, None]).sum(axis=-1)
    second = np.clip(after, 1, knots.shape[1] - 1)
    row = np.arange(len(at))[:, None]
    a, b = state.path[row, second - 1], state.path[row, second]
    span = b[..., 3] - a[..., 3]
    weight = np.clip((at - a[..., 3]) / np.where(span > 0.0, span, 1.0), 0.0, 1.0)
    mixed = a + weight[..., None] * (b - a)
    yaw = a[..., 2] + weight * wrap_angle(b[..., 2] - a[..., 2])
    return mixed[..., :2], yaw


def _near(angle: Floats, reference: Floats) -> Floats:
    """Return the same angle, at most half a turn from the reference."""
    return reference + wrap_angle(angle - reference)
