"""The one task of a stream that writes, and the one that watches it.

A write that has begun is never cancelled, for gRPC would still have it under way. A reader that
lets one write take too long ends its stream instead.
"""

import asyncio
import time

from stridewire._codec.responses import response_bytes
from stridewire._errors import ExhaustedError
from stridewire_server.streaming.outbox import Outbox
from stridewire_server.streaming.wire import Wire

_LOOKS = 4
"""So often the watch looks within the longest time that a write may take."""


class Writer:
    """Writes what an outbox hands out."""

    def __init__(self, wire: Wire, outbox: Outbox, timeout_s: float) -> None:
        self._wire = wire
        self._outbox = outbox
        self._timeout_s = timeout_s
        self._began: float | None = None
        """When the write under way began."""
        self._stopped = False

    async def run(self) -> None:
        """Write until the outbox is finished and empty."""
        while not self._stopped and (message := await self._outbox.take()) is not None:
            self._began = time.monotonic()
            await self._wire.write(response_bytes(message))
            self._began = None

    async def watch(self) -> None:
        """Look now and then whether a write takes too long; a timer for each would cost more.

        Raises:
            ExhaustedError: If one does.
        """
        while not self._takes_too_long():
            await asyncio.sleep(self._timeout_s / _LOOKS)
        raise ExhaustedError(
            f"the reader took nothing for {self._timeout_s:g} s; read frames as they come, "
            "or give fewer max_frames_in_flight"
        )

    async def stop(self, running: "asyncio.Task[None]") -> None:
        """End the task that runs; its write under way, if any, is waited for.

        gRPC refuses the status of a stream while its first write is being made. A write that took
        too long already is not waited for again.
        """
        self._stopped = True
        running.add_done_callback(_forget)
        if self._began is None:
            running.cancel()
        elif not self._takes_too_long():
            await asyncio.wait({running}, timeout=self._timeout_s)

    def _takes_too_long(self) -> bool:
        return self._began is not None and time.monotonic() - self._began > self._timeout_s


def _forget(running: "asyncio.Task[None]") -> None:
    """Look at the outcome, so that a write nobody waits for any more does not complain."""
    if not running.cancelled():
        running.exception()
