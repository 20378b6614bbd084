"""The crowd: the rows of all characters over one library, whoever's session they are in."""

from collections.abc import Callable, Sequence

import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime.characters import Characters, contiguous
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.runtime.tick import Block, Tick


class Crowd:
    """Owns the state arrays of a library's characters and steps the rows that are due."""

    def __init__(
        self,
        library: Library,
        settings: TickSettings,
        max_speed: float,
        clock: Callable[[], float],
    ) -> None:
        """Index the library and begin without characters."""
        self.library = library
        self.matcher = Matcher(library)
        self._tick = Tick(self.matcher, settings, max_speed, clock)
        self._joints = len(library.skeleton)
        self.state = Characters.allocate(0, self._joints)
        self._used = np.zeros(0, np.bool_)

    def __len__(self) -> int:
        """Return the number of characters."""
        return int(self._used.sum())

    def add(self, count: int) -> Indices:
        """Take `count` fresh rows, side by side where there is room, and return them."""
        start = self._room(count)
        rows = np.arange(start, start + count)
        missing = start + count - len(self._used)
        if missing > 0:
            # grow by halves, so that adding one by one stays cheap
            more = max(missing, len(self._used) // 2)
            self.state = self.state.append(Characters.allocate(more, self._joints))
            self._used = np.concatenate([self._used, np.zeros(more, np.bool_)])
        self.state.put(contiguous(rows), Characters.allocate(count, self._joints))
        self._used[rows] = True
        return rows

    def remove(self, rows: Indices) -> None:
        """Give rows back."""
        self._used[rows] = False

    def step(self, rows: Sequence[Indices], dt: Sequence[Floats]) -> Block:
        """Advance the rows of several sessions in one tick.

        Args:
            rows: Rows of each session.
            dt: `(N,)` seconds of each session's rows.
        """
        which = contiguous(np.concatenate(rows))
        part = self.state.take(which)
        block = self._tick.step(part, np.concatenate(dt))
        if not isinstance(which, slice):
            self.state.put(which, part)
        return block

    def _room(self, count: int) -> int:
        """Return the first row of a free run, at the end if there is none before."""
        free = np.flatnonzero(np.diff(np.concatenate([[0], ~self._used, [0]]).astype(np.int8)))
        for start, stop in free.reshape(-1, 2):
            if stop - start >= count or stop == len(self._used):
                return int(start)
        return len(self._used)
