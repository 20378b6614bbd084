"""The writer never cancels a write, and gives up a reader that takes none."""

import asyncio

import pytest

from stridewire._errors import ExhaustedError
from stridewire._messages import Notice
from stridewire.v1 import animation_pb2 as pb
from stridewire_server.streaming.outbox import Outbox
from stridewire_server.streaming.writer import Writer


class Call:
    """A call whose writes go through when it is let go."""

    def __init__(self) -> None:
        self.go = asyncio.Event()
        self.written: list[str] = []
        self.cancelled = False

    async def write(self, response: bytes) -> None:
        """Write, in time."""
        try:
            await self.go.wait()
        except asyncio.CancelledError:
            self.cancelled = True
            raise
        self.written.append(pb.AnimateResponse.FromString(response).notice.message)


def test_messages_are_written_in_order() -> None:
    """All that was put is written, and the writer ends with the outbox."""

    async def run() -> list[str]:
        call, outbox = Call(), Outbox(1)
        call.go.set()
        for text in "abc":
            outbox.put(Notice(1, text))
        outbox.finish()
        await Writer(call, outbox, 5.0).run()
        return call.written

    assert asyncio.run(run()) == ["a", "b", "c"]


def test_a_write_that_takes_too_long_is_told_of() -> None:
    """The watch says why; the write itself is left to finish."""

    async def run() -> Call:
        call, outbox = Call(), Outbox(1)
        outbox.put(Notice(1, "late"))
        writer = Writer(call, outbox, 0.01)
        writing = asyncio.create_task(writer.run())
        with pytest.raises(ExhaustedError, match="the reader took nothing"):
            await writer.watch()
        await writer.stop(writing)
        call.go.set()
        await asyncio.sleep(0)
        return call

    assert not asyncio.run(run()).cancelled


def test_stopping_leaves_a_write_alone() -> None:
    """A stream that ends in the middle of a write lets it finish, and writes nothing more."""

    async def run() -> Call:
        call, outbox = Call(), Outbox(1)
        outbox.put(Notice(1, "last"))
        outbox.put(Notice(1, "too late"))
        writer = Writer(call, outbox, 5.0)
        writing = asyncio.create_task(writer.run())
        await asyncio.sleep(0.01)
        stopping = asyncio.create_task(writer.stop(writing))
        await asyncio.sleep(0.01)
        call.go.set()
        await stopping
        return call

    call = asyncio.run(run())
    assert call.written == ["last"]
    assert not call.cancelled


def test_stopping_an_idle_writer_ends_it() -> None:
    """Where nothing is under way there is nothing to wait for."""

    async def run() -> bool:
        writer = Writer(Call(), Outbox(1), 5.0)
        writing = asyncio.create_task(writer.run())
        await asyncio.sleep(0)
        await writer.stop(writing)
        await asyncio.wait({writing})
        return writing.cancelled()

    assert asyncio.run(run())
