"""The patterns: time and cast in; speed, heading and facing out, an array over the characters each.

Time is one moment, or many as `(T, 1)`; what then depends on it is `(T, N)`.
Speeds are 1.3 m/s to walk, 2.5 m/s to jog, 4 m/s to sprint. A facing of None means along the way.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire.scripts.cast import Cast

WALK, JOG, SPRINT = 1.3, 2.5, 4.0

Time: TypeAlias = float | Floats
"""Seconds since the script began."""

Wanted: TypeAlias = tuple[Floats, Floats, Floats | None]
"""Speed `(N,)` in m/s, heading `(N,)` of the movement in radians, facing `(N,)` or None."""

Pattern: TypeAlias = Callable[[Time, Cast], Wanted]


def stroll(time: Time, cast: Cast) -> Wanted:
    """Walk in wide bends, 50 degrees to either side within 10 s."""
    return _speed(cast, WALK), cast.heading + np.radians(50.0) * _wave(time, cast, 10.0), None


def sprint(time: Time, cast: Cast) -> Wanted:
    """Sprint in bends of 30 degrees to either side within 12 s."""
    return _speed(cast, SPRINT), cast.heading + np.radians(30.0) * _wave(time, cast, 12.0), None


def stop_and_go(time: Time, cast: Cast) -> Wanted:
    """Walk 3 s, stand 2 s, jog 3 s, stand 2 s."""
    at = (time + 10.0 * cast.phase) % 10.0
    return np.select([at < 3.0, at < 5.0, at < 8.0], [WALK, 0.0, JOG], 0.0), cast.heading, None


def u_turns(time: Time, cast: Cast) -> Wanted:
    """Walk to and fro, turning about every 3.5 s; every second stretch at a jog."""
    leg = _leg(time, cast, 3.5)
    return np.where(leg % 4 < 2, WALK, JOG), cast.heading + np.pi * (leg % 2), None


def zigzag(time: Time, cast: Cast) -> Wanted:
    """Jog 45 degrees to the left and to the right in turn, 1.5 s each."""
    turn = np.radians(45.0) * cast.side * (1.0 - 2.0 * (_leg(time, cast, 1.5) % 2))
    return _speed(cast, JOG), cast.heading + turn, None


def strafe(time: Time, cast: Cast) -> Wanted:
    """Walk left, forward, right and backward, 2 s each, always facing the same way."""
    direction = 0.5 * np.pi * cast.side * (1.0 - _leg(time, cast, 2.0) % 4)
    return _speed(cast, WALK), cast.heading + direction, cast.heading


def circle(time: Time, cast: Cast) -> Wanted:
    """Walk in a circle of 2.5 m, half of the characters leftwards."""
    return _speed(cast, WALK), cast.heading + cast.side * (WALK / 2.5) * time, None


def random_stick(time: Time, cast: Cast) -> Wanted:
    """Push a stick somewhere else every 0.4 to 2 s, let it go now and then."""
    x = time / 1.2 + cast.phase
    slot = np.floor(x).astype(np.int64)
    # a slot begins late by its own lot, so that the intervals differ
    slot = slot - (x - slot < (2.0 / 3.0) * cast.lot(3, slot))
    speed = np.array([0.0, WALK, WALK, JOG, SPRINT])[(5.0 * cast.lot(4, slot)).astype(np.intp)]
    return speed, (2.0 * cast.lot(5, slot) - 1.0) * np.pi, None


def idle(time: Time, cast: Cast) -> Wanted:
    """Stand."""
    return _speed(cast, 0.0), cast.heading, None


def walk_turn_stop(time: Time, cast: Cast) -> Wanted:
    """Walk 4 s, turn by 90 degrees and walk 3 s, stand 3 s."""
    at = time % 10.0
    heading = cast.heading + 0.5 * np.pi * cast.side * (2 * (time // 10.0) + (at >= 4.0))
    return _speed(cast, WALK if at < 7.0 else 0.0), heading, None


PATTERNS: dict[str, Pattern] = {
    "stroll": stroll,
    "sprint": sprint,
    "stop-and-go": stop_and_go,
    "u-turns": u_turns,
    "zigzag": zigzag,
    "strafe": strafe,
    "circle": circle,
    "random-stick": random_stick,
    "idle": idle,
    "walk-turn-stop": walk_turn_stop,
}
"""All patterns by the name that a user gives."""


def _speed(cast: Cast, speed: float) -> Floats:
    return np.full(cast.characters.shape, speed)


def _wave(time: Time, cast: Cast, period: float) -> Floats:
    """Return `(N,)` a sine of the period, each character at its phase."""
    return np.asarray(np.sin(2.0 * np.pi * (time / period + cast.phase)))


def _leg(time: Time, cast: Cast, seconds: float) -> Floats:
    """Return `(N,)` how many stretches of a length each character has behind it."""
    return np.asarray(np.floor(time / seconds + cast.phase))
