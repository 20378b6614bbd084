"""Scripts: how a synthetic character travels, with speeds and turns that change as people do."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d, uniform_filter1d

from stridewire.motion.array_types import Floats, Vectors

FRAME_RATE = 60.0
"""Of everything that is generated; frames per second."""

ACCELERATION = 2.2
"""Largest change of speed that a script gets; m/s^2."""

TURN_ACCELERATION = 6.0
"""Largest change of the turning rate; rad/s^2."""

_SMOOTH_S = 0.1


@dataclass(frozen=True)
class Segment:
    """A while of constant intent."""

    seconds: float
    speed: float = 0.0
    """Forward, m/s."""
    turn: float = 0.0
    """Turning to the left, rad/s."""
    side: float = 0.0
    """Sideways to the left, m/s."""


@dataclass(frozen=True)
class Travel:
    """How the body travels, frame by frame."""

    position: Vectors
    """`(T, 3)` on the ground, metres."""
    yaw: Floats
    """`(T,)` heading, radians, not wrapped."""
    velocity: Floats
    """`(T, 2)` to the left and forward, m/s."""
    turn: Floats
    """`(T,)` turning to the left, rad/s."""
    acceleration: Floats
    """`(T,)` forward, m/s^2."""

    @property
    def speed(self) -> Floats:
        """`(T,)` length of the velocity, m/s."""
        return np.asarray(np.hypot(self.velocity[:, 0], self.velocity[:, 1]))


def travel(segments: Sequence[Segment], margin_s: float = 0.0) -> Travel:
    """Follow a script at 60 frames/s from the origin, heading +Z.

    Args:
        segments: One after the other; changes begin where a segment begins.
        margin_s: How much longer the first and the last segment last than they say.
    """
    frames = [round(s.seconds * FRAME_RATE) for s in segments]
    frames[0] += round(margin_s * FRAME_RATE)
    frames[-1] += round(margin_s * FRAME_RATE)
    goals = np.repeat([(s.side, s.speed, s.turn) for s in segments], frames, axis=0)
    limits = np.array([ACCELERATION, ACCELERATION, TURN_ACCELERATION]) / FRAME_RATE
    rates = gaussian_filter1d(
        _limit_changes(goals, limits), _SMOOTH_S * FRAME_RATE, axis=0, mode="nearest"
    )
    velocity, turn = rates[:, :2], rates[:, 2]
    yaw = _integrate(turn)
    sine, cosine = np.sin(yaw), np.cos(yaw)
    x = velocity[:, 0] * cosine + velocity[:, 1] * sine
    z = velocity[:, 1] * cosine - velocity[:, 0] * sine
    position = np.stack([_integrate(x), np.zeros(len(x)), _integrate(z)], axis=-1)
    acceleration = uniform_filter1d(np.gradient(velocity[:, 1]) * FRAME_RATE, 15, mode="nearest")
    return Travel(position, yaw, velocity, turn, acceleration)


def _limit_changes(goals: Floats, limits: Floats) -> Floats:
    """Approach the goals `(T, C)` by at most `limits` a frame."""
    out = goals.copy()
    for i in range(1, len(out)):
        out[i] = out[i - 1] + np.clip(goals[i] - out[i - 1], -limits, limits)
    return out


def _integrate(rate: Floats) -> Floats:
    """Sum a rate `(T,)` over time, trapezoidal, from zero."""
    steps = 0.5 * (rate[1:] + rate[:-1]) / FRAME_RATE
    return np.concatenate([[0.0], np.cumsum(steps)])
