"""The character root: the clip's root motion, pulled gently towards the simulated root."""

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire.motion.springs import damper_fraction, wrap_angle
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings

_LN2 = float(np.log(2.0))


def advance(state: Characters, motion: Floats, dt: Floats, settings: TickSettings) -> Floats:
    """Move the root by the clip's motion, adjust it and blend corrections in.

    Args:
        state: N rows.
        motion: `(N, 3)` the clip's root motion: x, z in the root's frame, yaw.
        dt: `(N,)` seconds.
        settings: Half-lives and clamps.

    Returns:
        `(N, 4)` root motion of this tick without corrections: x, y, z in the root's frame before,
        yaw.
    """
    motion = motion + _decay_root_offset(state, dt, settings)
    way = _to_world(motion[:, :2], state.root_yaw)
    way += _pull(state, way, dt, settings)
    turn = motion[:, 2] + _turn_pull(state, way, motion[:, 2], dt, settings)
    delta = np.zeros((len(state), 4))
    delta[:, [0, 2]] = _to_root(way, state.root_yaw)
    delta[:, 3] = turn
    state.root_position[:, ::2] += way
    state.root_yaw += turn
    _correct(state, dt, settings)
    _leash(state, settings)
    return delta


def _decay_root_offset(state: Characters, dt: Floats, settings: TickSettings) -> Floats:
    """Let the old velocity fade by a damper and return the way that it still adds."""
    left = 1.0 - damper_fraction(settings.root_halflife, dt)[:, None]
    way = state.root_offset * (1.0 - left) * (settings.root_halflife / _LN2)
    state.root_offset *= left.astype(np.float32)
    return np.asarray(way)


def _pull(state: Characters, way: Floats, dt: Floats, settings: TickSettings) -> Floats:
    gap = state.sim_position - state.root_position[:, ::2] - way
    pull = gap * damper_fraction(settings.adjust_position_halflife, dt)[:, None]
    most = settings.adjust_share * np.hypot(way[:, 0], way[:, 1])
    return pull * _limit(np.hypot(pull[:, 0], pull[:, 1]), most)[:, None]


def _turn_pull(
    state: Characters, way: Floats, turn: Floats, dt: Floats, settings: TickSettings
) -> Floats:
    gap = wrap_angle(state.sim_yaw - state.root_yaw - turn)
    pull = gap * damper_fraction(settings.adjust_yaw_halflife, dt)
    most = settings.adjust_share * np.abs(turn) + settings.adjust_turn_per_metre * np.hypot(
        way[:, 0], way[:, 1]
    )
    return np.clip(pull, -most, most)


def _correct(state: Characters, dt: Floats, settings: TickSettings) -> None:
    part = state.correction * damper_fraction(settings.correction_halflife, dt)[:, None]
    state.correction -= part
    state.root_position += part[:, :3]
    state.root_yaw += part[:, 3]
    state.sim_position += part[:, [0, 2]]
    state.sim_yaw += part[:, 3]


def _leash(state: Characters, settings: TickSettings) -> None:
    """Keep the simulated root where the character can follow, or it would run away."""
    gap = state.sim_position - state.root_position[:, ::2]
    near = _limit(np.hypot(gap[:, 0], gap[:, 1]), settings.leash)
    state.sim_position[...] = state.root_position[:, ::2] + gap * near[:, None]
    turn = wrap_angle(state.sim_yaw - state.root_yaw)
    state.sim_yaw[...] = state.root_yaw + np.clip(turn, -settings.yaw_leash, settings.yaw_leash)


def _limit(length: Floats, most: Floats | float) -> Floats:
    """Return the factor that brings a length down to at most `most`."""
    return np.minimum(1.0, most / np.maximum(length, 1e-12))


def _to_world(v: Floats, yaw: Floats) -> Floats:
    sine, cosine = np.sin(yaw), np.cos(yaw)
    return np.stack([v[:, 0] * cosine + v[:, 1] * sine, v[:, 1] * cosine - v[:, 0] * sine], axis=-1)


def _to_root(v: Floats, yaw: Floats) -> Floats:
    return _to_world(v, -yaw)
