"""Metrics: pure functions over positions in the world, time first, then units (characters, clips).

A value belongs to the frame that it ends at; NaN means not counted. Definitions: A is RMR's foot
sliding (Kim et al. 2023, section 7.5), B that of Zhang et al. 2018, C is by contact labels.
"""

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Vectors

NEAR_GROUND = 0.02
"""A counts toes below so many metres above the floor; float begins there."""
_B_HEIGHT = 0.025
SKATING_SPEED = 0.1
"""A planted toe that is faster skates; m/s."""


def planar_speed(points: Vectors, rate: float) -> Floats:
    """Return the speed over the ground `(T, …)` of points `(T, …, 3)`, m/s."""
    way = np.diff(points[..., [0, 2]], axis=0)
    return _from_frame(1, np.sqrt(np.sum(way * way, axis=-1)) * rate)


def jerk(points: Vectors, rate: float) -> Floats:
    """Return the length of the third difference `(T, …)` of points `(T, …, 3)`, m/s³."""
    third = np.diff(points, n=3, axis=0)
    return _from_frame(3, np.sqrt(np.sum(third * third, axis=-1)) * rate**3)


def velocity_step(points: Vectors, rate: float) -> Floats:
    """Return by how much the velocity `(T, …)` of points changed within a frame, m/s."""
    second = np.diff(points, n=2, axis=0)
    return _from_frame(2, np.sqrt(np.sum(second * second, axis=-1)) * rate)


def steady(planted: Flags) -> Flags:
    """Tell which joints `(T, …)` are planted now and were in the frame before."""
    out = planted.copy()
    out[0] = False
    out[1:] &= planted[:-1]
    return out


def sliding_a(speed: Floats, height: Floats) -> Floats:
    """Return the speed `(T, …)` of toes near the ground: needs no labels, a floating body wins."""
    return np.where(height < NEAR_GROUND, speed, np.nan)


def sliding_b(speed: Floats, height: Floats) -> Floats:
    """Return the speed `(T, …)` of all toes, weighted down to nothing at 2.5 cm."""
    return np.asarray(speed * (2.0 - 2.0 ** np.clip(height / _B_HEIGHT, 0.0, 1.0)))


def sliding_c(speed: Floats, planted: Flags) -> Floats:
    """Return the speed `(T, …)` of toes that the labels call planted, now and the frame before."""
    return np.where(steady(planted), speed, np.nan)


def floating(height: Floats, planted: Flags) -> Floats:
    """Return by how much planted toes `(T, …)` hover, metres."""
    return np.where(planted, np.maximum(height - NEAR_GROUND, 0.0), np.nan)


def penetration(height: Floats, planted: Flags) -> Floats:
    """Return by how much planted toes `(T, …)` are below the floor, metres."""
    return np.where(planted, np.maximum(-height, 0.0), np.nan)


def lock_offset(toes: Vectors, targets: Vectors) -> Floats:
    """Return the planar distance `(T, …)` of toes from their lock points, NaN for none."""
    away = (toes - targets)[..., [0, 2]]
    return np.asarray(np.sqrt(np.sum(away * away, axis=-1)))


def locked_share(targets: Vectors, planted: Flags) -> Floats:
    """Return 1 where a planted toe `(T, …)` is locked, 0 where it is not."""
    return np.where(planted, (~np.isnan(targets[..., 0])).astype(np.float64), np.nan)


def extension(hip: Vectors, knee: Vectors, ankle: Vectors) -> Floats:
    """Return how far legs `(T, …)` are stretched: 1 is a straight knee."""
    longest = _length(knee - hip) + _length(ankle - knee)
    return np.asarray(_length(ankle - hip) / longest)


def distance(a: Vectors, b: Vectors) -> Floats:
    """Return the distance `(T, …)` of points `(T, …, 3)`, metres."""
    return _length(a - b)


def following_error(position: Floats, wanted_velocity: Floats, rate: float) -> Floats:
    """Return by how much the way of the last second differs from the way asked for, metres.

    It does not depend on any simulated root: a character that runs where it is told to walk, lags,
    or drifts aside, has an error, and a delay counts once.

    Args:
        position: `(T, S, 2)` root over the ground.
        wanted_velocity: `(T, S, 2)` m/s.
        rate: Frames per second.
    """
    span = round(rate)
    gone = position[span:] - position[:-span]
    asked = np.cumsum(wanted_velocity, axis=0) / rate
    away = gone - (asked[span:] - asked[:-span])
    return _from_frame(span, np.sqrt(np.sum(away * away, axis=-1)))


def _from_frame(first: int, values: Floats) -> Floats:
    """Prepend frames that are not counted."""
    out = np.full((first + len(values), *values.shape[1:]), np.nan)
    out[first:] = values
    return out


def _length(v: Vectors) -> Floats:
    return np.asarray(np.sqrt(np.sum(v * v, axis=-1)))
