"""When a session with server pacing is due."""

import math

MAX_CATCH_UP = 4
"""Frames that are made up for at once after a hitch; older ones are let go."""


class Schedule:
    """Due times on the grid of whole periods since the clock's zero.

    All sessions of one rate are due at the same instants and share ticks; a late one does not
    drift.
    """

    def __init__(self, rate_hz: float, now: float) -> None:
        self._rate_hz = rate_hz
        self._next = math.ceil(now * rate_hz)

    def next_due(self, now: float) -> float:
        """Return the next due time, in the past where frames are to be made up for."""
        self._next = max(self._next, math.ceil(now * self._rate_hz) - MAX_CATCH_UP)
        due = self._next / self._rate_hz
        self._next += 1
        return due
