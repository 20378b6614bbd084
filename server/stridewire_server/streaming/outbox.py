"""The outbox of a stream: credits for frames, and a one-slot mailbox behind them.

A slow reader holds as many frames unacknowledged as it has credits. Behind them waits a single one,
always the newest, which tells what its skipped predecessors told.
"""

import asyncio
from collections import deque
from dataclasses import replace

from stridewire._errors import Violation
from stridewire._messages import Frame, Notice, Opened, ServerMessage, StreamError
from stridewire_server.streaming.skipping import skip

MAX_WAITING = 64
"""Messages other than frames that wait for a slow reader; later errors only add to a count."""


class Outbox:
    """What waits to be written; one task takes, others put."""

    def __init__(self, credits_of_reader: int) -> None:
        self._credits = credits_of_reader
        self._messages: deque[Opened | StreamError | Notice] = deque()
        self._frame: Frame | None = None
        self._unacknowledged: deque[int] = deque()
        self._last_sent = 0
        self._finished = False
        self._changed = asyncio.Event()

    def put(self, message: Opened | StreamError | Notice) -> None:
        """Put a message that is not skipped."""
        last = self._messages[-1] if self._messages else None
        if (
            len(self._messages) >= MAX_WAITING
            and isinstance(message, StreamError)
            and isinstance(last, StreamError)
        ):
            more = last.more + len(message.violations) + message.more
            self._messages[-1] = replace(last, more=more)
        else:
            self._messages.append(message)
        self._changed.set()

    def offer(self, frame: Frame) -> None:
        """Put a frame in the place of the one that waits, if any."""
        self._frame = frame if self._frame is None else skip(self._frame, frame)
        self._changed.set()

    def acknowledge(self, last_frame: int) -> Violation | None:
        """Take note that a frame and all before it were taken; returns what is wrong with that."""
        if last_frame > self._last_sent:
            return Violation(
                "step.last_frame",
                f"{last_frame} was not sent yet; the newest frame sent is {self._last_sent}",
            )
        while self._unacknowledged and self._unacknowledged[0] <= last_frame:
            self._unacknowledged.popleft()
        self._changed.set()
        return None

    def finish(self) -> None:
        """Put nothing more; what waits is still handed out, credits or not."""
        self._finished = True
        self._changed.set()

    async def take(self) -> ServerMessage | None:
        """Wait for what is to be written next; None at the end."""
        while True:
            if self._messages:
                return self._messages.popleft()
            if self._frame is not None and self._may_send():
                return self._send_frame(self._frame)
            if self._finished:
                return None
            self._changed.clear()
            await self._changed.wait()

    def _may_send(self) -> bool:
        return self._credits == 0 or self._finished or len(self._unacknowledged) < self._credits

    def _send_frame(self, frame: Frame) -> Frame:
        self._frame = None
        self._last_sent = frame.frame
        if self._credits:
            self._unacknowledged.append(frame.frame)
        return frame
