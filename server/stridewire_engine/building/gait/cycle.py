"""The cycle of the steps: phase, gait and which feet are down, along a script.

A foot's phase is 0 where its toe is planted; the right foot is half a cycle behind the left. A
standing character holds the phase where both feet are down, and starts and stops there.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.building.gait.model import GaitModel
from stridewire_engine.building.gait.script import FRAME_RATE, Travel

HOLD_PHASES = (0.02, 0.52)
"""Phases of the left foot at which a character comes to stand: both feet down."""

_RUN_ABOVE, _WALK_BELOW = 2.05, 1.85
_MOVING_SPEED, _MOVING_TURN = 0.08, 0.15
_BLEND_S = 0.1
_PLANTED_AT = (0.09, 0.11)
_RUN_STANCE = 0.2
_SIDE_CADENCE, _MOST_SIDE_CADENCE = 1.3, 0.65
_SPOT_CADENCE, _SPOT_SPEED = 0.2, 0.5


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
    cadence: Floats
    """`(T,)` cycles a second."""

    @property
    def planted(self) -> Flags:
        """`(T, 2)` whether the left and the right toe are planted."""
        return self.phase < self.stance[:, None]

    @property
    def model_phase(self) -> Floats:
        """`(T,)` phase of the gait model: 0 where the left ankle is farthest ahead."""
        walk, run = _PLANTED_AT
        return np.asarray(self.phase[:, 0] + walk + self.run * (run - walk)) % 1.0

    @property
    def stance_seconds(self) -> Floats:
        """`(T,)` how long a toe stays planted."""
        return self.stance / self.cadence


def cadence(model: GaitModel, travel: Travel, run: Floats) -> Floats:
    """Return cycles a second `(T,)`: the model's; quick steps sideways and on the spot."""
    walk, running = (gait.cadence_at(travel.speed, travel.turn) for gait in (model.walk, model.run))
    walk = walk + np.minimum(_SIDE_CADENCE * np.abs(travel.velocity[:, 0]), _MOST_SIDE_CADENCE)
    on_the_spot = np.clip(1.0 - travel.speed / _SPOT_SPEED, 0.0, 1.0)
    walk = walk + _SPOT_CADENCE * np.abs(travel.turn) * on_the_spot
    return np.asarray(walk + run * (running - walk))


def _stance_share(speed: Floats, run: Floats) -> Floats:
    """Return the share of the cycle `(T,)` that a toe is planted, as in the training data."""
    walk = 0.51 - 0.055 * (np.minimum(speed, 2.2) - 0.7)
    return np.asarray(walk + run * (_RUN_STANCE - walk))


def cycle(model: GaitModel, travel: Travel, rate: float, start: float) -> Cycle:
    """Run the phase along a script.

    Args:
        model: Says how quick steps are.
        travel: T frames.
        rate: Factor on the cadence: the person.
        start: Phase of the left foot in the first frame.
    """
    speed = travel.speed
    run = gaussian_filter1d(_hysteresis(speed).astype(float), _BLEND_S * FRAME_RATE, mode="nearest")
    pace = rate * cadence(model, travel, run)
    moving = (speed > _MOVING_SPEED) | (np.abs(travel.turn) > _MOVING_TURN)
    left, holding = _advance(pace / FRAME_RATE, moving, start)
    stepping = gaussian_filter1d((~holding).astype(float), _BLEND_S * FRAME_RATE, mode="nearest")
    phase = np.stack([left, (left + 0.5) % 1.0], axis=-1)
    return Cycle(phase, run, stepping, holding, _stance_share(speed, run), pace)


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
