"""The sessions of a process: opened through any door, limited together, drained together."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from stridewire._codec.requests import decode_request
from stridewire._errors import ExhaustedError, ProtocolError, UnavailableError
from stridewire._messages import Notice, Open
from stridewire.v1 import animation_pb2 as pb
from stridewire_server.settings import ServerSettings
from stridewire_server.streaming.stream import AnimateStream
from stridewire_server.streaming.wire import Wire
from stridewire_server.ticker import Ticker


class Sessions:
    """Opens sessions and keeps them until they end; to be made and used in one event loop."""

    def __init__(self, ticker: Ticker, settings: ServerSettings) -> None:
        self._ticker = ticker
        self._settings = settings
        self._places = settings.max_sessions
        self._streams: set[AnimateStream] = set()
        self._draining = False
        self._empty = asyncio.Event()
        self._empty.set()
        ticker.strained = self._tell_strain

    async def serve(self, wire: Wire) -> None:
        """Serve one stream until it ends.

        Raises:
            StridewireError: If it cannot begin, or is ended for what the client does.
            DecodeError: If bytes that are no message come.
        """
        opening = await _read_open(wire)
        with self._place():
            session = await self._ticker.open(opening)
            stream = AnimateStream(wire, self._ticker, session)
            self._streams.add(stream)
            try:
                await stream.run()
            finally:
                self._streams.discard(stream)
                self._ticker.close_session(session)

    async def drain(self) -> None:
        """Open nothing more, tell those who are here, and wait for them as long as is allowed."""
        self._draining = True
        for stream in self._streams:
            stream.notify(
                Notice(
                    pb.NOTICE_KIND_DRAINING,
                    f"the server stops in {self._settings.drain_s:g} s; open a session elsewhere",
                    self._settings.drain_s,
                )
            )
        await self.wait_until_empty(self._settings.drain_s)

    def _tell_strain(self, strained: bool) -> None:
        """Tell all streams that the runtime gives way to load, or that it need not any more."""
        kind = pb.NOTICE_KIND_DEGRADED if strained else pb.NOTICE_KIND_RECOVERED
        told = "too much to do: less is refined and searched" if strained else "back to normal"
        for stream in self._streams:
            stream.notify(Notice(kind, told))

    async def wait_until_empty(self, timeout_s: float) -> None:
        """Wait until no session is open, or until the time is up."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._empty.wait(), timeout_s)

    @contextmanager
    def _place(self) -> Iterator[None]:
        """Hold one of the places that the server has for sessions."""
        if self._draining:
            raise UnavailableError("the server is stopping; open the session elsewhere")
        if not self._places:
            raise ExhaustedError(
                f"all {self._settings.max_sessions} sessions are taken; end one, try later, or put "
                "more characters into one session",
                retry_after_s=1.0,
            )
        self._places -= 1
        self._empty.clear()
        try:
            yield
        finally:
            self._places += 1
            if self._places == self._settings.max_sessions:
                self._empty.set()


async def _read_open(wire: Wire) -> Open:
    request = await wire.read()
    if request is None:
        raise ProtocolError("the stream ended before Open; send Open first")
    message = decode_request(request)
    if not isinstance(message, Open):
        raise ProtocolError(
            f"{type(message).__name__} before Open; the first message of a stream is Open"
        )
    return message
