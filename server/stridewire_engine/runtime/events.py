"""Events of a tick: kept as arrays, turned into messages only when somebody reads them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np

from stridewire._messages import (
    ClipEnd,
    ContactChange,
    Detail,
    Event,
    TagEntered,
    Transition,
    TransitionReason,
)
from stridewire.motion.array_types import Indices
from stridewire_engine.library import Library
from stridewire_engine.matching.schema import Schema
from stridewire_engine.runtime.tick import Block


@dataclass(frozen=True, eq=False)
class TickEvents(Sequence[Event]):
    """The events of one session in one tick, by character in the order of the frame."""

    block: Block
    rows: slice
    """The session's rows of the block."""
    characters: Indices
    """Ids."""
    frame: int
    detail: Detail
    library: Library
    schema: Schema

    def __len__(self) -> int:
        return len(self._events)

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Event]: ...
    def __getitem__(self, index: int | slice) -> Event | Sequence[Event]:
        return self._events[index]

    @cached_property
    def _events(self) -> list[Event]:
        if self.detail is Detail.NONE:
            return []
        return [*self._transitions(), *self._contacts(), *self._tags()]

    def _transitions(self) -> Iterator[Event]:
        jumps = self.block.jumps
        if jumps is None:
            return
        inside = (jumps.characters >= self.rows.start) & (jumps.characters < self.rows.stop)
        costs = self.detail is Detail.COSTS
        names = [channel.name for channel in self.schema.channels]
        for i in np.flatnonzero(inside):
            character = int(self.characters[jumps.characters[i] - self.rows.start])
            begins = jumps.from_clip[i] < 0
            reason = TransitionReason(int(jumps.reason[i]))
            from_clip = "" if begins else self.library.clips[jumps.from_clip[i]].name
            if reason is TransitionReason.CLIP_END:
                yield ClipEnd(character, self.frame, from_clip)
            yield Transition(
                character,
                self.frame,
                from_clip,
                float(jumps.from_time[i]),
                self.library.clips[jumps.to_clip[i]].name,
                float(jumps.to_time[i]),
                reason,
                float(jumps.cost[i]) if costs else 0.0,
                float(jumps.stay_cost[i]) if costs and not begins else 0.0,
                dict(zip(names, jumps.channel_costs[i].tolist(), strict=True)) if costs else {},
            )

    def _contacts(self) -> Iterator[Event]:
        now, before = self.block.contacts[self.rows], self.block.contacts_before[self.rows]
        for row, joint in np.argwhere(now != before):
            yield ContactChange(
                int(self.characters[row]), self.frame, int(joint), bool(now[row, joint])
            )

    def _tags(self) -> Iterator[Event]:
        entered = self.block.tags_entered[self.rows]
        for row in np.flatnonzero(entered):
            for bit, name in enumerate(self.library.tag_names):
                if int(entered[row]) >> bit & 1:
                    yield TagEntered(int(self.characters[row]), self.frame, name)
