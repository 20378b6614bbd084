"""Strain: how busy the loop's thread is, and by how many levels the runtime is to give way.

Measured as the share of the time of late that the thread worked, ticks and messages together, so
that it means the same at any rate and for any number of sessions. A level is gone up quickly and
come down from within a second.
"""

import math

from stridewire_engine.runtime.settings import LEVELS

_MEMORY_S = 0.2
"""Time constant of the share."""
_TOO_MUCH, _ENOUGH = 0.8, 0.6
"""The rest is the transport's: its threads want the interpreter, too."""
_UP_S, _DOWN_S = 0.1, 0.25
"""Least time between two changes, since the share answers with a delay."""


class Strain:
    """Follows the ticks of a process."""

    def __init__(self, now: float, worked_s: float) -> None:
        """Begin rested.

        Args:
            now: Seconds of any clock that does not jump.
            worked_s: Processor time of the thread until then.
        """
        self.level = 0
        self.share = 0.0
        """Of the time of late that the thread worked, 0 to 1."""
        self._last = self._changed = now
        self._worked_s = worked_s

    def note(self, now: float, worked_s: float) -> None:
        """Take note of how much the thread has worked until now."""
        passed = max(now - self._last, 1e-6)
        busy = min((worked_s - self._worked_s) / passed, 1.0)
        self.share += (busy - self.share) * -math.expm1(-passed / _MEMORY_S)
        self._last, self._worked_s = now, worked_s
        rested = now - self._changed
        if self.share > _TOO_MUCH and self.level < LEVELS - 1 and rested >= _UP_S:
            self._change(1, now)
        elif self.share < _ENOUGH and self.level and rested >= _DOWN_S:
            self._change(-1, now)

    def _change(self, by: int, now: float) -> None:
        self.level += by
        self._changed = now
