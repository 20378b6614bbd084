"""Footing for kernels: where the toes of one character go, from labels, targets and what is ahead.

The counterpart of `stitchers.footing`, `replanting` and the toes' part of `stance`, their formulas
and constants.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Vectors
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.legs import point
from stridewire_engine.compiled.lookahead import Ahead
from stridewire_engine.compiled.turns import Vector, damper_fraction, decay, to_world

_LN2 = math.log(2.0)
_LANDING = 0.0125
_SWING_ONSET = 0.04
_BRAKE_FROM_S, _BRAKE_S, _BRAKE_HALFLIFE = 0.13, 0.1, 0.06
_STRONGEST_PULL, _STRONGEST_FALL = 50.0, 60.0
_SHORTEST, _LONGEST = 0.06, 0.4
_HEIGHT_HALFLIFE = 0.035
_LIFT_BY_SPEED, _HIGHEST_LIFT, _LIFT_HALFLIFE, _HOVER = 0.03, 0.05, 0.08, 0.005
_LANDING_SOON_S = 0.1
_FARTHEST, _WAIT_S, _STEP_S, _STEP_HALFLIFE, _AT_REST = 0.08, 0.25, 0.4, 0.06, 0.02


class Toes(NamedTuple):
    """Columns of characters that tell of their toes, as in `StitchState`."""

    toe_shown: Vectors
    toe_speed: Vectors
    toe_gap: Vectors
    toe_gap_speed: Vectors
    toe_swing: Floats
    toe_lift: Floats
    toe_lift_speed: Floats
    toe_step: Floats
    stitch_time: Floats


class Steps(NamedTuple):
    """Scratch of one character: its toes in this tick, left and right, in the world."""

    target: Vectors
    """`(2, 3)` where the clip's toes are under the shown root, or where they are led."""
    target_velocity: Vectors
    toe: Vectors
    toe_velocity: Vectors
    planted: Floats
    """`(2,)` share to which they stand."""
    stands: Flags
    """`(2,)` whether they count as standing."""


def scratch() -> Steps:
    """Return room for one character's toes."""
    target, target_velocity, toe, toe_velocity = np.zeros((4, 2, 3))
    return Steps(target, target_velocity, toe, toe_velocity, np.zeros(2), np.zeros(2, np.bool_))


@kernel
def gentle_halflife(x: float, y: float, z: float, strongest: float) -> float:
    """Return seconds in which an offset decays without pulling harder."""
    return 2.0 * _LN2 * math.sqrt(math.sqrt(x * x + y * y + z * z) / strongest)


@kernel
def replant(
    toes: Toes, row: int, steps: Steps, ahead: Ahead, times: Floats, free: bool, dt: float
) -> None:
    """Let feet that take a step of their own not stand, now and soon; see `replanting`."""
    both = True
    for side in range(2):
        toes.toe_step[row, side] = max(toes.toe_step[row, side] - dt, 0.0)
    for side in range(2):
        both = both and steps.stands[side] and toes.toe_step[row, side] <= 0.0
        both = both and toes.toe_swing[row, side] < _AT_REST
        for k in range(len(times)):
            both = both and ahead.contacts[k, side]
    if free and both and dt > 0.0 and toes.stitch_time[row] > _WAIT_S:
        gap = toes.toe_gap
        left = math.hypot(gap[row, 0, 0], gap[row, 0, 2])
        right = math.hypot(gap[row, 1, 0], gap[row, 1, 2])
        # of two feet that are equally far off the left one goes first
        if left >= right and left > _FARTHEST:
            toes.toe_step[row, 0] = _STEP_S
        elif right > _FARTHEST and right > left:
            toes.toe_step[row, 1] = _STEP_S
    for side in range(2):
        if toes.toe_step[row, side] > 0.0:
            steps.stands[side] = False
        for k in range(len(times)):
            # a foot on its way may be caught by the clip's next step, which then takes over
            if toes.toe_step[row, side] > times[k]:
                ahead.contacts[k, side] = False


@kernel
def aim(
    toes: Toes, row: int, side: int, steps: Steps, position: Vector, begins: bool, dt: float
) -> None:
    """Note where a toe's target is and how it moves; a new character's toes begin there."""
    shown, gap = toes.toe_shown, toes.toe_gap
    for axis in range(3):
        before = position[axis]
        if not begins:
            before = shown[row, side, axis] - gap[row, side, axis]
        steps.target[side, axis] = position[axis]
        if dt > 0.0:
            steps.target_velocity[side, axis] = (position[axis] - before) / max(dt, 1e-6)
        else:
            steps.target_velocity[side, axis] = (
                float(toes.toe_speed[row, side, axis]) - toes.toe_gap_speed[row, side, axis]
            )
        if begins:
            shown[row, side, axis] = position[axis]


@kernel
def step(
    toes: Toes,
    row: int,
    side: int,
    steps: Steps,
    ahead: Ahead,
    times: Floats,
    ground: float,
    dt: float,
) -> None:
    """Move a toe; see `footing.step` and `Stance`.

    Args:
        toes: Of the characters; swing and lift are changed.
        row: Of the character.
        side: Left or right.
        steps: Its toes; are written.
        ahead: Its legs ahead.
        times: `(K,)` of those.
        ground: Height at which a standing toe's joint is.
        dt: Seconds.
    """
    gap, gap_speed = toes.toe_gap, toes.toe_gap_speed
    settled = _settled(ahead, times, side)
    halflife = _swing_halflife(toes, row, side, steps, settled, dt)
    planted = steps.planted[side]
    left = math.exp(-_LN2 * dt / _LANDING)
    for axis in (0, 2):
        speed = toes.toe_speed[row, side, axis]
        stood = toes.toe_shown[row, side, axis] + speed * (1.0 - left) * (_LANDING / _LN2)
        stays = settled * gap[row, side, axis]
        closed, closing = decay(
            gap[row, side, axis] - stays, gap_speed[row, side, axis], halflife, dt
        )
        swung = steps.target[side, axis] + stays + closed
        steps.toe[side, axis] = planted * stood + (1.0 - planted) * swung
        steps.toe_velocity[side, axis] = planted * (speed * left) + (1.0 - planted) * (
            steps.target_velocity[side, axis] + closing
        )
    _raise(toes, row, side, steps, ahead, times, ground, dt)


@kernel
def _swing_halflife(
    toes: Toes, row: int, side: int, steps: Steps, settled: float, dt: float
) -> float:
    """Return seconds in which a toe that swings closes its gap; a swing gets under way slowly."""
    toes.toe_swing[row, side] += (
        1.0 - steps.planted[side] - toes.toe_swing[row, side]
    ) * damper_fraction(_SWING_ONSET, dt)
    speed = math.hypot(steps.target_velocity[side, 0], steps.target_velocity[side, 2])
    halflife = min(_SHORTEST * (1.0 + 0.5 / max(speed, 1e-3)), _LONGEST)
    if toes.toe_step[row, side] > 0.0:
        halflife = _STEP_HALFLIFE
    x, y, z = point(toes.toe_gap, row, side)
    halflife = max(halflife, gentle_halflife(x, y, z, _STRONGEST_PULL))
    halflife /= max(toes.toe_swing[row, side], 0.1)
    return float(halflife + settled * (_BRAKE_HALFLIFE - halflife))


@kernel
def _settled(ahead: Ahead, times: Floats, side: int) -> float:
    """Return to which share a swing is over, since the toe lands soon."""
    for k in range(len(times)):
        if ahead.contacts[k, side]:
            return float(min(max((_BRAKE_FROM_S - times[k]) / _BRAKE_S, 0.0), 1.0))
    return 0.0


@kernel
def _raise(
    toes: Toes,
    row: int,
    side: int,
    steps: Steps,
    ahead: Ahead,
    times: Floats,
    ground: float,
    dt: float,
) -> None:
    """Move a toe's height; raise it where it closes a gap fast and does not land soon."""
    gap_speed = toes.toe_gap_speed
    off = float(toes.toe_gap[row, side, 1]) - toes.toe_lift[row, side]
    off_speed = float(gap_speed[row, side, 1]) - toes.toe_lift_speed[row, side]
    halflife = max(_HEIGHT_HALFLIFE, gentle_halflife(off, 0.0, 0.0, _STRONGEST_FALL))
    height, rise = decay(off, off_speed, halflife, dt)
    down = steps.stands[side]
    for k in range(len(times)):
        down = down or (times[k] <= _LANDING_SOON_S and ahead.contacts[k, side])
    closing = math.hypot(gap_speed[row, side, 0], gap_speed[row, side, 2])
    wanted = 0.0 if down else min(_LIFT_BY_SPEED * closing, _HIGHEST_LIFT)
    if steps.stands[side]:
        wanted = -max(steps.target[side, 1] - ground - _HOVER, 0.0)
    lift, speed = decay(
        toes.toe_lift[row, side] - wanted, toes.toe_lift_speed[row, side], _LIFT_HALFLIFE, dt
    )
    toes.toe_lift[row, side], toes.toe_lift_speed[row, side] = lift + wanted, speed
    steps.toe[side, 1] = steps.target[side, 1] + height + toes.toe_lift[row, side]
    steps.toe_velocity[side, 1] = steps.target_velocity[side, 1] + rise + speed


@kernel
def remember(
    toes: Toes,
    row: int,
    side: int,
    steps: Steps,
    reached: Vector,
    root: Any,
    sine: float,
    cosine: float,
) -> None:
    """Note where a toe really came to lie, given in the root's frame."""
    shown = to_world(reached, sine, cosine)
    for axis in range(3):
        at = shown[axis] + root[axis]
        velocity = steps.toe_velocity[side, axis]
        toes.toe_shown[row, side, axis] = at
        toes.toe_speed[row, side, axis] = velocity
        toes.toe_gap[row, side, axis] = at - steps.target[side, axis]
        toes.toe_gap_speed[row, side, axis] = velocity - steps.target_velocity[side, axis]
