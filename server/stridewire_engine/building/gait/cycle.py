"""The cycle of the steps: phase, gait and which feet are down, along a script.

A foot's phase is 0 where its toe is planted; the right foot is half a cycle behind the left. A
standing character holds the phase where both feet are down, and starts and stops there.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.building.gait.script import FRAME_RATE, Travel

HOLD_PHASES = (0.05, 0.55)
"""Phases of the left foot at which a character comes to stand: both feet down."""

_RUN_ABOVE, _WALK_BELOW = 2.05, 1.85
_MOVING_SPEED, _MOVING_TURN = 0.08, 0.15
_BLEND_S = 0.1


@dataclass(frozen=True)
class Cycle:
    """Where in their steps the feet are, frame by frame."""

    phase: Floats
    """`(T, 2)` of the left and the right foot, 0 to 1."""
    run: Floats
    """`(T,)` 0 for walking, 1 for running, blended over a quarter of a second."""
    stepping: Floats
    """`(T,)` 0 standing, 1 stepping."""
    holding: Flags
    """`(T,)` whether the phase is held."""
    stance: Floats
    """`(T,)` share of the cycle that a toe is planted."""

    @property
    def planted(self) -> Flags:
        """`(T, 2)` whether the left and the right toe are planted."""
        return self.phase < self.stance[:, None]


def cadence(travel: Travel, run: Floats) -> Floats:
    """Return cycles a second `(T,)`: more with speed and turning, short quick steps sideways."""
    speed, sideways = travel.speed, np.abs(travel.velocity[:, 0])
    walk = 0.62 + 0.3 * np.minimum(speed, 2.2) + 0.12 * np.minimum(np.abs(travel.turn), 2.0)
    walk = walk + np.minimum(1.3 * sideways, 0.55)
    return walk + run * (1.38 + 0.035 * (speed - 3.0) - walk)


def stance_share(speed: Floats, run: Floats) -> Floats:
    """Return the share of the cycle `(T,)` that a toe is planted."""
    walk = 0.62 - 0.045 * np.clip(speed - 0.7, 0.0, 1.5)
    running = np.clip(0.36 - 0.05 * (speed - 2.5), 0.24, 0.38)
    return np.asarray(walk + run * (running - walk))


def cycle(travel: Travel, rate: float = 1.0, start: float = HOLD_PHASES[0]) -> Cycle:
    """Run the phase along a script.

    Args:
        travel: T frames.
        rate: Factor on the cadence: the person.
        start: Phase of the left foot in the first frame.
    """
    speed = travel.speed
    run = gaussian_filter1d(_hysteresis(speed).astype(float), _BLEND_S * FRAME_RATE, mode="nearest")
    stance = stance_share(speed, run)
    steps = rate * cadence(travel, run) / FRAME_RATE
    moving = (speed > _MOVING_SPEED) | (np.abs(travel.turn) > _MOVING_TURN)
    left, holding = _advance(steps, moving, start)
    stepping = gaussian_filter1d((~holding).astype(float), _BLEND_S * FRAME_RATE, mode="nearest")
    return Cycle(np.stack([left, (left + 0.5) % 1.0], axis=-1), run, stepping, holding, stance)


def _hysteresis(speed: Floats) -> Flags:
    running = np.zeros(len(speed), bool)
    state = bool(speed[0] > _RUN_ABOVE)
    for i, v in enumerate(speed):
        state = bool(v > (_WALK_BELOW if state else _RUN_ABOVE))
        running[i] = state
    return running


def _advance(steps: Floats, moving: Flags, start: float) -> tuple[Floats, Flags]:
    """Add up the phase; one that does not move runs on to the next hold phase and stays there."""
    phases = np.empty(len(steps))
    holding = np.zeros(len(steps), bool)
    phase = start
    for i, step in enumerate(steps):
        phases[i] = phase
        holding[i] = not moving[i] and phase in HOLD_PHASES
        if holding[i]:
            continue
        hold = min(HOLD_PHASES, key=lambda hold: (hold - phase) % 1.0 or 1.0)
        arrives = not moving[i] and (hold - phase) % 1.0 <= step
        phase = hold if arrives else (phase + step) % 1.0
    return phases, holding
