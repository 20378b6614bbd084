"""What a client needs of whatever runs the characters: a server, or a runtime in process."""

from collections.abc import AsyncIterator, Iterator
from importlib.metadata import entry_points
from typing import Any, Protocol

from stridewire._errors import StridewireError
from stridewire._messages import (
    AnswerT,
    Edit,
    Open,
    Opened,
    PartsQuery,
    PartT,
    Query,
    ServerMessage,
    Step,
)


class Stream(Protocol):
    """One session: messages out, messages in."""

    opened: Opened

    def send(self, message: Step | Edit) -> None:
        """Send a message; returns without waiting for an answer."""

    def receive(self, timeout_s: float) -> ServerMessage | None:
        """Wait for the next message; None when the stream has ended.

        Raises:
            TimeoutError: If nothing came in time.
            StridewireError: If the stream ended with an error.
        """

    def close(self) -> None:
        """End the session and free what it holds; twice is harmless."""


class Transport(Protocol):
    """Opens sessions and answers queries."""

    def open(self, message: Open) -> Stream:
        """Open a session."""

    def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query."""

    def parts(self, query: PartsQuery[PartT]) -> Iterator[PartT]:
        """Answer a query part by part."""

    def close(self) -> None:
        """Free what the transport holds; twice is harmless."""


class AsyncStream(Protocol):
    """`Stream` for asyncio."""

    opened: Opened

    async def send(self, message: Step | Edit) -> None:
        """Send a message; returns without waiting for an answer."""

    async def receive(self, timeout_s: float) -> ServerMessage | None:
        """Wait for the next message; None when the stream has ended.

        Raises:
            TimeoutError: If nothing came in time.
            StridewireError: If the stream ended with an error.
        """

    async def close(self) -> None:
        """End the session and free what it holds; twice is harmless."""


class AsyncTransport(Protocol):
    """`Transport` for asyncio; used within one event loop."""

    async def open(self, message: Open) -> AsyncStream:
        """Open a session."""

    async def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query."""

    def parts(self, query: PartsQuery[PartT]) -> AsyncIterator[PartT]:
        """Answer a query part by part."""

    async def close(self) -> None:
        """Free what the transport holds; twice is harmless."""


def in_process_transport(library: str | None) -> Transport:
    """Return a runtime in this process over a library folder; None means the embedded library.

    Raises:
        StridewireError: If the extra that runs characters is not installed.
    """
    transport: Transport = _factory("in-process")(library)
    return transport


def async_in_process_transport(library: str | None) -> AsyncTransport:
    """Return the same for asyncio; the library is opened when it is first needed.

    Raises:
        StridewireError: If the extra that runs characters is not installed.
    """
    transport: AsyncTransport = _factory("in-process-asyncio")(library)
    return transport


def _factory(name: str) -> Any:
    for point in entry_points(group="stridewire.transports", name=name):
        try:
            return point.load()
        except ModuleNotFoundError as error:
            raise StridewireError(
                f"running characters in this process needs {error.name}: "
                "pip install 'stridewire[server]'"
            ) from error
    raise StridewireError(
        "no runtime is installed in this environment: pip install 'stridewire[server]', "
        "or give the address of a server"
    )
