"""The transports without a wire: a runtime in this process behind the interface of a server."""

import asyncio
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

from stridewire._errors import ProtocolError
from stridewire._messages import (
    AnswerT,
    Edit,
    Open,
    Opened,
    Pacing,
    PartsQuery,
    PartT,
    Query,
    ServerMessage,
    Step,
    StreamError,
)
from stridewire_engine.answering import answer_parts
from stridewire_engine.building import open_library
from stridewire_engine.runtime import Runtime, Session

P = ParamSpec("P")
T = TypeVar("T")


class InProcess:
    """Runs characters in this process; a `stridewire._transport.Transport`."""

    def __init__(self, library: str | None = None) -> None:
        """Open a library folder, a folder of motion files, or the embedded library.

        Raises:
            LibraryError: If the folder is no usable library.
        """
        self.runtime = Runtime([open_library(library)])

    def open(self, message: Open) -> "InProcessStream":
        """Open a session."""
        return InProcessStream(self.runtime, self.runtime.open(message))

    def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query."""
        return self.runtime.ask(query)

    def parts(self, query: PartsQuery[PartT]) -> Iterator[PartT]:
        """Answer a query part by part."""
        return answer_parts(self.runtime, query)

    def close(self) -> None:
        """Do nothing: sessions free themselves."""


class InProcessStream:
    """One session: what is sent is worked off at once.

    With server pacing, frames come by the clock.
    """

    def __init__(self, runtime: Runtime, session: Session) -> None:
        self.opened: Opened = session.opened
        self._runtime = runtime
        self._session = session
        self._inbox: deque[ServerMessage] = deque()
        self._paced = session.opened.settings.pacing is Pacing.SERVER
        self._interval = 1.0 / session.opened.settings.rate_hz
        self._next = time.monotonic()
        self._closed = False

    def send(self, message: Step | Edit) -> None:
        """Work a message off; answers wait to be received.

        Raises:
            ProtocolError: If the session was closed.
        """
        if self._closed:
            raise ProtocolError("the session is closed; open another one")
        if isinstance(message, Edit):
            self._report(self._runtime.edit(self._session, message))
        elif message.ack_only:
            return
        elif self._paced:
            self._report(self._runtime.control(self._session, message))
        else:
            self._advance(message)

    def receive(self, timeout_s: float) -> ServerMessage | None:
        """Return the next message; None when the session was closed.

        Raises:
            TimeoutError: If there is none and none will come, or none in time.
        """
        wait_s = self.due_in()
        time.sleep(min(wait_s, timeout_s))
        if wait_s > timeout_s:
            raise TimeoutError(f"no frame within {timeout_s} s")
        return self.take()

    def due_in(self) -> float:
        """Return after how many seconds there is something to take.

        Raises:
            TimeoutError: If there will be nothing.
        """
        if self._inbox or self._closed:
            return 0.0
        if not self._paced:
            raise TimeoutError("nothing to receive: a frame comes only after a step")
        return max(self._next - time.monotonic(), 0.0)

    def take(self) -> ServerMessage | None:
        """Return the next message, made now where it is due; None when the session was closed."""
        if not self._inbox and not self._closed:
            self._next = max(self._next + self._interval, time.monotonic() - self._interval)
            self._advance(self._interval)
        return self._inbox.popleft() if self._inbox else None

    def close(self) -> None:
        """End the session."""
        self._closed = True
        self._runtime.close(self._session)

    def _advance(self, step: Step | float) -> None:
        ((frame, error),) = self._runtime.advance([(self._session, step)])
        self._report(error)  # before its frame, as a server sends it
        self._inbox.append(frame)

    def _report(self, error: StreamError | None) -> None:
        if error is not None:
            self._inbox.append(error)


class AsyncInProcess:
    """The same for asyncio; a `stridewire._transport.AsyncTransport`.

    The runtime works in one thread of its own, so that the event loop goes on meanwhile.
    """

    def __init__(self, library: str | None = None) -> None:
        """Take note of the library; it is opened when it is first needed."""
        self._library = library
        self._opened: InProcess | None = None
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="stridewire-run")

    async def open(self, message: Open) -> "AsyncInProcessStream":
        """Open a session.

        Raises:
            LibraryError: If the folder is no usable library.
        """
        stream = await self.call(lambda: self._transport().open(message))
        return AsyncInProcessStream(self, stream)

    async def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query.

        Raises:
            LibraryError: If the folder is no usable library.
        """
        return await self.call(lambda: self._transport().ask(query))

    async def parts(self, query: PartsQuery[PartT]) -> AsyncIterator[PartT]:
        """Answer a query part by part.

        Raises:
            LibraryError: If the folder is no usable library.
        """
        parts: Iterator[Any] = await self.call(lambda: self._transport().parts(query))
        while (part := await self.call(next, parts, None)) is not None:
            yield part

    async def close(self) -> None:
        """End the thread; sessions free themselves."""
        self._thread.shutdown(wait=False)

    async def call(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call something in the runtime's thread."""
        return await asyncio.wrap_future(self._thread.submit(function, *args, **kwargs))

    def _transport(self) -> InProcess:
        if self._opened is None:
            self._opened = InProcess(self._library)
        return self._opened


class AsyncInProcessStream:
    """One session; what is sent is worked off in the runtime's thread."""

    def __init__(self, transport: AsyncInProcess, stream: InProcessStream) -> None:
        self.opened = stream.opened
        self._transport = transport
        self._stream = stream

    async def send(self, message: Step | Edit) -> None:
        """Work a message off; answers wait to be received.

        Raises:
            ProtocolError: If the session was closed.
        """
        await self._transport.call(self._stream.send, message)

    async def receive(self, timeout_s: float) -> ServerMessage | None:
        """Return the next message; None when the session was closed.

        Raises:
            TimeoutError: If there is none and none will come, or none in time.
        """
        wait_s = self._stream.due_in()
        await asyncio.sleep(min(wait_s, timeout_s))
        if wait_s > timeout_s:
            raise TimeoutError(f"no frame within {timeout_s} s")
        return await self._transport.call(self._stream.take)

    async def close(self) -> None:
        """End the session; twice is harmless."""
        try:
            await self._transport.call(self._stream.close)
        except RuntimeError:  # the transport was closed before, and with it the thread
            return
