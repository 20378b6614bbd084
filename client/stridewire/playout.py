"""Playout: showing frames evenly that come unevenly.

What an engine does that draws at a rate of its own, over a network that delays, bunches and loses:

1. **Clock**: frames carry the session's time; how much the receiver's clock is ahead of it is the
   least that was seen lately (a frame can be late, never early).
2. **Delay**: frames are shown so much later that the next one is nearly always there when the one
   before it is due: as the jitter and the losses of late demand, within bounds.
3. **Playhead**: goes on evenly with the receiver's clock and drifts towards where it should be by
   10 % at most, so that nobody sees it; it leaps only after a break.
4. **Pose**: between the two frames around the playhead; never across a teleport. Where the next
   frame is missing the last one stays.

Events are handed out once, when the playhead passes their frame.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stridewire._messages import Event, Frame, FrameFlag
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors

_MARGIN_S = 0.004
"""A frame is there so much before it is needed; less, and the receiver's own loop misses some."""
_SLEW = 0.1
_LEAP_S = 0.5
_SLEW_S = 0.5
"""An error of the playhead is made good within about so many seconds."""


@dataclass(frozen=True)
class Shown:
    """What is to be drawn at a moment; arrays as in `Frame`."""

    time_s: float
    """Session time of the playhead."""
    characters: Indices
    root: Floats
    hips: Vectors
    rotations: Quaternions
    contacts: Indices
    events: Sequence[Event]
    """Those passed since the moment shown before."""


class ClockSync:
    """Tells how far the receiver's clock is ahead of the session's, and how late frames come.

    Args:
        window: Frames that are remembered.
    """

    def __init__(self, window: int = 300) -> None:
        self._ahead: deque[float] = deque(maxlen=window)
        self._needed: deque[float] = deque(maxlen=window)
        self._last_time_s: float | None = None

    def add(self, time_s: float, received_s: float) -> None:
        """Take note of a frame's session time and of when it came."""
        self._ahead.append(received_s - time_s)
        # a frame is needed when the one before it is shown, whatever was lost in between
        if self._last_time_s is not None:
            self._needed.append(received_s - self._last_time_s)
        self._last_time_s = time_s

    @property
    def ahead_s(self) -> float:
        """Least difference of both clocks: what a frame has that was not delayed."""
        return min(self._ahead)

    def needed_s(self, share: float) -> float:
        """Return the delay with which so large a share of frames is there when it is needed.

        Not a number before two frames came.
        """
        needed = np.quantile(self._needed, share) if self._needed else np.nan
        return float(needed) - self.ahead_s


class Playout:
    """Takes frames as they come and tells what to draw at any time.

    Args:
        least_delay_s: The delay is not less.
        most_delay_s: Nor more: later frames count as lost.
        share: Of the frames that are to be there in time.
    """

    def __init__(
        self,
        *,
        least_delay_s: float = 0.0,
        most_delay_s: float = 0.25,
        share: float = 0.99,
    ) -> None:
        self.clock = ClockSync()
        self.starved = 0
        """Moments shown for which no frame ahead was there."""
        self._bounds = (least_delay_s, most_delay_s)
        self._share = share
        self._frames: deque[Frame] = deque()
        self._playhead: float | None = None
        self._last_now = 0.0

    @property
    def delay_s(self) -> float:
        """Time between the earliest that a frame can come and when it is shown."""
        return float(np.clip(self.clock.needed_s(self._share) + _MARGIN_S, *self._bounds))

    def add(self, frame: Frame, received_s: float) -> None:
        """Take a frame.

        Args:
            frame: As it came; one that is no newer than the newest is left out.
            received_s: When, by the receiver's clock; seconds.
        """
        self.clock.add(frame.time_s, received_s)
        if not self._frames or frame.time_s > self._frames[-1].time_s:
            self._frames.append(frame)

    def sample(self, now_s: float) -> Shown | None:
        """Return what to draw now; None before two frames came and the first of them is due.

        Args:
            now_s: The receiver's clock; it must not go back.
        """
        if self._playhead is None and len(self._frames) < 2:
            return None
        at = self._advance(now_s)
        events: list[Event] = []
        while len(self._frames) > 1 and self._frames[1].time_s <= at:
            self._frames.popleft()
            events += self._frames[0].events
        before = self._frames[0]
        if at < before.time_s:
            return None
        if len(self._frames) == 1:
            self.starved += at > before.time_s + 1e-9
            return _as_it_is(before, events)
        return _between(before, self._frames[1], at, events)

    def _advance(self, now_s: float) -> float:
        """Move the playhead and return it; session seconds."""
        wanted = now_s - self.clock.ahead_s - self.delay_s
        if self._playhead is None or abs(wanted - self._playhead) > _LEAP_S:
            self._playhead = wanted
        else:
            passed = now_s - self._last_now
            error = wanted - (self._playhead + passed)
            self._playhead += passed * (1.0 + float(np.clip(error / _SLEW_S, -_SLEW, _SLEW)))
        self._last_now = now_s
        return self._playhead


def _as_it_is(frame: Frame, events: Sequence[Event]) -> Shown:
    return Shown(
        frame.time_s,
        frame.characters,
        frame.root,
        frame.hips,
        frame.rotations,
        frame.contacts,
        tuple(events),
    )


def _between(before: Frame, after: Frame, at: float, events: Sequence[Event]) -> Shown:
    """Interpolate the characters that both frames have; others stay, or wait for their frame."""
    weight = np.float32((at - before.time_s) / (after.time_s - before.time_s))
    _, here, there = np.intersect1d(
        before.characters, after.characters, assume_unique=True, return_indices=True
    )
    here, there = here[(stays := ~_teleported(after)[there])], there[stays]
    root, hips, rotations = before.root.copy(), before.hips.copy(), before.rotations.copy()
    a, b = before.root[here], after.root[there]
    root[here, :3] = a[:, :3] + weight * (b[:, :3] - a[:, :3])
    share = np.full(len(here), weight, np.float32)
    root[here, 3:] = quaternion.nlerp(a[:, 3:], b[:, 3:], share)
    hips[here] += weight * (after.hips[there] - before.hips[here])
    rotations[here] = quaternion.nlerp(
        before.rotations[here], after.rotations[there], share[:, None]
    )
    nearest = before if weight < 0.5 else after
    contacts = before.contacts.copy()
    contacts[here] = nearest.contacts[there if nearest is after else here]
    return Shown(at, before.characters, root, hips, rotations, contacts, tuple(events))


def _teleported(frame: Frame) -> Flags:
    return np.asarray((frame.flags >> np.uint32(FrameFlag.TELEPORTED)) & 1 == 1)
