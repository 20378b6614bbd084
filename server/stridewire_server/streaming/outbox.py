"""The outbox of a stream: as many frames as the reader has credits for, and a mailbox behind them.

A slow reader holds as many frames unacknowledged as it has credits. Behind them waits a single one,
always the newest, which tells what its skipped predecessors told.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import replace

from stridewire._errors import Violation
from stridewire._messages import Frame, Notice, Opened, ServerMessage, StreamError
from stridewire_server.streaming.skipping import skip

MAX_WAITING_ERRORS = 64
"""Errors that wait for a slow reader; later ones only add to a count."""

WINDOW_WITHOUT_CREDITS = 30
"""Frames that wait to be written to a reader that gives no credits."""


class Outbox:
    """What waits to be written; one task takes, others put.

    Args:
        credits_of_reader: Frames that may be unacknowledged; 0 means that none are acknowledged.
        dropped: Called for each frame that the reader does not get.
    """

    def __init__(self, credits_of_reader: int, dropped: Callable[[], None] = lambda: None) -> None:
        self._credits = credits_of_reader
        self._dropped = dropped
        self._waiting: deque[ServerMessage] = deque()
        self._errors: deque[StreamError] = deque()
        self._under_way: deque[int] = deque()
        self._mailbox: Frame | None = None
        self._last_sent = 0
        self._finished = False
        self._awaited: asyncio.Future[None] | None = None
        """Set while the writer waits for something to write."""

    def put(self, message: Opened | Notice) -> None:
        """Put a message that comes after what waits already."""
        self._waiting.append(message)
        self._wake()

    def report(self, error: StreamError) -> None:
        """Put an error; errors overtake frames."""
        if len(self._errors) < MAX_WAITING_ERRORS:
            self._errors.append(error)
        else:
            last = self._errors[-1]
            more = last.more + len(error.violations) + error.more
            self._errors[-1] = replace(last, more=more)
        self._wake()

    def offer(self, frame: Frame) -> None:
        """Put a frame: to be written where there is a credit, else into the mailbox."""
        if self._mailbox is not None:
            frame = skip(self._mailbox, frame)
            self._dropped()
        self._mailbox = frame
        self._empty_mailbox()

    def acknowledge(self, last_frame: int) -> Violation | None:
        """Take note that a frame and all before it were taken; returns what is wrong with that."""
        if last_frame > self._last_sent:
            return Violation(
                "step.last_frame",
                f"{last_frame} was not sent yet; the newest frame sent is {self._last_sent}",
            )
        if self._credits:
            self._forget(last_frame)
        return None

    def finish(self) -> None:
        """Put nothing more; what waits is still handed out, credits or not."""
        self._finished = True
        self._empty_mailbox()

    async def take(self) -> ServerMessage | None:
        """Wait for what is to be written next; None at the end."""
        while True:
            if self._errors:
                return self._errors.popleft()
            if self._waiting:
                return self._sent(self._waiting.popleft())
            if self._finished:
                return None
            self._awaited = asyncio.get_running_loop().create_future()
            await self._awaited
            self._awaited = None

    def _empty_mailbox(self) -> None:
        """Let the frame in the mailbox be written, where the reader has room for it."""
        room = (self._credits or WINDOW_WITHOUT_CREDITS) - len(self._under_way)
        if self._mailbox is not None and (room > 0 or self._finished):
            self._under_way.append(self._mailbox.frame)
            self._waiting.append(self._mailbox)
            self._mailbox = None
        self._wake()

    def _wake(self) -> None:
        if self._awaited is not None and not self._awaited.done():
            self._awaited.set_result(None)

    def _sent(self, message: ServerMessage) -> ServerMessage:
        if isinstance(message, Frame):
            self._last_sent = message.frame
            if not self._credits:
                self._forget(message.frame)
        return message

    def _forget(self, frame: int) -> None:
        """Give the credits of a frame and all before it back."""
        while self._under_way and self._under_way[0] <= frame:
            self._under_way.popleft()
        self._empty_mailbox()
