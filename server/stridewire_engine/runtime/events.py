"""Events of a tick: kept as arrays, turned into messages only when somebody reads them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import overload

from stridewire._messages import (
    ClipEnd,
    ContactChange,
    Detail,
    Event,
    FallbackReason,
    TagEntered,
    Transition,
    TransitionReason,
)
from stridewire.motion.array_types import Indices
from stridewire_engine.matching.explanation import explain
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime.choice import Jumps, Sets, exclusions
from stridewire_engine.runtime.tick import Block

_RUNNERS_UP = 2


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
    matcher: Matcher
    sets: Sets

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
        jumped, clips = self.block.jumped, self.matcher.library.clips
        costs = self.detail >= Detail.COSTS
        for i in jumped.within(self.rows):
            character = self._id(jumped.rows[i])
            from_clip = "" if jumps.from_clip[i] < 0 else clips[jumps.from_clip[i]].name
            reason = TransitionReason(int(jumps.reason[i]))
            if reason is TransitionReason.CLIP_END:
                yield ClipEnd(character, self.frame, from_clip)
            fallback = int(self.block.fallback[jumps.characters[i]])
            transition = Transition(
                character,
                self.frame,
                from_clip,
                float(jumps.from_time[i]),
                clips[jumps.to_clip[i]].name,
                float(jumps.to_time[i]),
                reason,
                fallback=FallbackReason(fallback) if fallback else None,
                refined_frames=int(self.block.refined_frames[jumps.characters[i]]),
            )
            yield self._with_costs(transition, jumps, i) if costs else transition

    def _with_costs(self, transition: Transition, jumps: Jumps, i: int) -> Transition:
        """Add what the choice cost, what else fitted and what was excluded."""
        # the chosen moment comes first among the matches
        matches, excluded = explain(
            self.matcher,
            jumps.queries[i],
            jumps.weights[i],
            exclusions(jumps.excluded[i]),
            1 + _RUNNERS_UP,
            self.sets[int(jumps.sets[i])],
        )
        names = [channel.name for channel in self.matcher.schema.channels]
        begins = jumps.from_clip[i] < 0
        return replace(
            transition,
            cost=float(jumps.cost[i]),
            stay_cost=0.0 if begins else float(jumps.stay_cost[i]),
            bias=0.0 if begins else float(jumps.bias[i]),
            channels=dict(zip(names, jumps.channel_costs[i].tolist(), strict=True)),
            runners_up=matches[1:],
            excluded=excluded,
        )

    def _contacts(self) -> Iterator[Event]:
        changed, contacts = self.block.contacts_changed, self.block.contacts
        for i in changed.within(self.rows):
            row, joint = changed.rows[i], changed.what[i]
            yield ContactChange(self._id(row), self.frame, joint, bool(contacts[row, joint]))

    def _tags(self) -> Iterator[Event]:
        begun, entered = self.block.tags_begun, self.block.tags_entered
        for i in begun.within(self.rows):
            row = begun.rows[i]
            for bit, name in enumerate(self.matcher.library.tag_names):
                if int(entered[row]) >> bit & 1:
                    yield TagEntered(self._id(row), self.frame, name)

    def _id(self, row: int) -> int:
        """Return the id of the character in a row of the block."""
        return int(self.characters[row - self.rows.start])
