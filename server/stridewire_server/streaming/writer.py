"""The one task of a stream that writes.

A write that has begun is never cancelled, for gRPC would still have it under way. A reader that
lets one write take too long ends its stream instead.
"""

import asyncio

from stridewire._codec.responses import encode_response
from stridewire._errors import ExhaustedError
from stridewire.v1 import animation_pb2 as pb
from stridewire_server.streaming.outbox import Outbox
from stridewire_server.streaming.wire import Wire


class Writer:
    """Writes what an outbox hands out."""

    def __init__(self, wire: Wire, outbox: Outbox, timeout_s: float) -> None:
        self._wire = wire
        self._outbox = outbox
        self._timeout_s = timeout_s
        self._under_way: asyncio.Future[None] | None = None

    async def run(self) -> None:
        """Write until the outbox is finished and empty.

        Raises:
            ExhaustedError: If one write took too long.
        """
        while (message := await self._outbox.take()) is not None:
            await self._write(encode_response(message))

    async def settle(self) -> None:
        """Wait for the write under way, if any: until it is through, the stream has no status.

        gRPC refuses the status of a stream while its first write is being made. A write that took
        too long already is not waited for again.
        """
        if self._under_way is not None:
            await asyncio.wait({self._under_way}, timeout=self._timeout_s)

    async def _write(self, response: pb.AnimateResponse) -> None:
        writing = asyncio.ensure_future(self._wire.write(response))
        writing.add_done_callback(_forget)
        self._under_way = writing
        done, _ = await asyncio.wait({writing}, timeout=self._timeout_s)
        self._under_way = None
        if not done:
            raise ExhaustedError(
                f"the reader took nothing for {self._timeout_s:g} s; read frames as they come, "
                "or give fewer max_frames_in_flight"
            )
        await writing


def _forget(writing: "asyncio.Future[None]") -> None:
    """Look at the outcome, so that a write nobody waits for any more does not complain."""
    if not writing.cancelled():
        writing.exception()
