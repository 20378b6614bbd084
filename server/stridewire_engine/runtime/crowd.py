"""The crowd: the rows of all characters over one library, whoever's session they are in."""

from collections.abc import Callable, Sequence
from itertools import count

import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.library import Library
from stridewire_engine.matching.candidates import CandidateSet
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import holding
from stridewire_engine.runtime.characters import Characters, contiguous
from stridewire_engine.runtime.choice import Considered
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.runtime.tick import Block, Tick

_MOST_SETS = 256
"""From so many filters on, those that no character uses any more are forgotten."""


Watch = Callable[[Characters, Floats], None]
"""Told of rows and their `dt`; it changes neither."""


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
        self.settings = settings
        self.max_speed = max_speed
        self._tick = Tick(self.matcher, settings, max_speed, clock)
        channels = len(self.matcher.schema.channels)
        self.state = Characters.allocate(0, len(library.skeleton), channels)
        self._used = np.zeros(0, np.bool_)
        self.sets: dict[int, CandidateSet] = {0: self.matcher.candidates.everything}
        """Candidate sets by the number under which rows name them."""
        self._numbers = count(1)
        self.watch: Watch | None = None
        """Sees the rows that are due, controls applied, before each tick."""

    def __len__(self) -> int:
        """Return the number of characters."""
        return int(self._used.sum())

    def add(self, amount: int) -> Indices:
        """Take `amount` fresh rows, side by side where there is room, and return them."""
        start = self._room(amount)
        rows = np.arange(start, start + amount)
        missing = start + amount - len(self._used)
        if missing > 0:
            # grow by halves, so that adding one by one stays cheap
            more = max(missing, len(self._used) // 2)
            self.state = self.state.append(self.state.fresh(more))
            self._used = np.concatenate([self._used, np.zeros(more, np.bool_)])
        fresh = self.state.fresh(amount)
        fresh.weights[...] = self.matcher.schema.weights
        self.state.put(contiguous(rows), fresh)
        self._used[rows] = True
        return rows

    def remove(self, rows: Indices) -> None:
        """Give rows back."""
        self._used[rows] = False

    def filter_number(self, text: str, path: str) -> int:
        """Return the number under which rows name a filter; equal filters share one.

        Raises:
            InvalidRequestError: If the filter is malformed or nothing satisfies it.
        """
        for number, known in self.sets.items():
            if known.text == text.strip():
                return number
        chosen = self.matcher.candidates.get(text, path)
        if len(self.sets) >= _MOST_SETS:
            named = set(self.state.filter[self._used].tolist()) | {0}
            self.sets = {n: known for n, known in self.sets.items() if n in named}
        number = next(self._numbers)
        self.sets[number] = chosen
        return number

    def step(self, rows: Sequence[Indices], dt: Sequence[Floats], level: int = 0) -> Block:
        """Advance the rows of several sessions in one tick.

        Args:
            rows: Rows of each session.
            dt: `(N,)` seconds of each session's rows.
            level: By how many levels to give way to load.
        """
        which = contiguous(np.concatenate(rows))
        part, passed = self._part(which), np.concatenate(dt)
        if self.watch is not None:
            self.watch(part, passed)
        block = self._step(part, passed, level)
        if not isinstance(which, slice):
            self.state.put(which, part)
        return block

    def consider(self, rows: Characters, dt: Floats) -> tuple[Indices, Considered]:
        """Say what rows would search for and find; see `Tick.consider`."""
        return self._tick.consider(rows, dt, self.sets)

    def _part(self, which: slice | Indices) -> Characters:
        """Return rows to step: views where they lie side by side, else lent."""
        if isinstance(which, slice):
            return self.state.take(which)
        return self.state.borrow(which)

    def _step(self, rows: Characters, dt: Floats, level: int) -> Block:
        """Step rows; those that are far away only when it is their turn."""
        if not (rows.rate_divider.any() or rows.owed.any()):
            return self._tick.step(rows, dt, self.sets, level)
        stepped = holding.due(rows, dt)
        which = contiguous(np.flatnonzero(stepped))
        part = rows.borrow(which)
        block = self._tick.step(part, part.owed.copy(), self.sets, level)
        part.owed[...] = 0.0
        rows.put(which, part)
        return holding.held(rows, stepped, block)

    def _room(self, amount: int) -> int:
        """Return the first row of a free run, at the end if there is none before."""
        free = np.flatnonzero(np.diff(np.concatenate([[0], ~self._used, [0]]).astype(np.int8)))
        for start, stop in free.reshape(-1, 2):
            if stop - start >= amount or stop == len(self._used):
                return int(start)
        return len(self._used)
