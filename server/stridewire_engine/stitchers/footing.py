"""Footing: where toes go, from two inputs: which are planted, and where those that swing should be.

A planted toe keeps its place: what speed it has when it lands dies within a few centimetres. A toe
that swings springs to its target from where it is. Offsets are thus paid back in swings, never by
sliding. Labels and targets may come from a clip, or from anything that predicts them.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Vectors

_LN2 = float(np.log(2.0))


class Toes(NamedTuple):
    """Toes in the world and how they move; `(N, 2, 3)`, of which this module moves x and z."""

    position: Vectors
    velocity: Vectors


def step(
    toes: Toes,
    gap: Vectors,
    gap_velocity: Vectors,
    target: Toes,
    planted: Floats,
    swing_halflife: Floats,
    settled: Floats,
    landing_halflife: float,
    dt: Floats,
) -> Toes:
    """Advance toes by `dt` `(N,)` seconds.

    Args:
        toes: Of the frame before.
        gap: `(N, 2, 3)` from the targets of the frame before to the toes.
        gap_velocity: `(N, 2, 3)` its rate of change.
        target: Where swinging toes should be now, and how that moves.
        planted: `(N, 2)` share from 0, swinging, to 1, planted.
        swing_halflife: `(N, 2)` seconds of the spring that closes a gap in swing.
        settled: `(N, 2)` share of a gap that is left as it is, because the toe lands soon.
        landing_halflife: Seconds of the damper that stops a toe that lands.
        dt: `(N,)`.
    """
    passed = dt[:, None, None]
    left = np.exp(-_LN2 * passed / landing_halflife)
    stance = Toes(
        toes.position + toes.velocity * (1.0 - left) * (landing_halflife / _LN2),
        toes.velocity * left,
    )
    stays = settled[..., None] * gap
    closed, closing = decay(gap - stays, gap_velocity, swing_halflife[..., None], passed)
    swing = Toes(target.position + stays + closed, target.velocity + closing)
    share = planted[..., None]
    return Toes(*(share * a + (1.0 - share) * b for a, b in zip(stance, swing, strict=True)))


def decay(x: Floats, v: Floats, halflife: Floats, dt: Floats) -> tuple[Floats, Floats]:
    """Let offsets decay critically damped, each with a half-life of its own."""
    y = 2.0 * _LN2 / halflife
    j1 = v + x * y
    e = np.exp(-y * dt)
    return e * (x + j1 * dt), e * (v - j1 * y * dt)


def swing_halflife(speed: Floats, shortest: float, longest: float) -> Floats:
    """Return seconds in which to close a gap: fast feet hide more, slow ones are given time."""
    return np.minimum(shortest * (1.0 + 0.5 / np.maximum(speed, 1e-3)), longest)
