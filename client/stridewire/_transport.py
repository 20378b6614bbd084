"""What a `Client` needs of whatever runs the characters: a server, or a runtime in process."""

from importlib.metadata import entry_points
from typing import Protocol

from stridewire._errors import StridewireError
from stridewire._messages import (
    Edit,
    Open,
    Opened,
    SearchQuery,
    SearchResult,
    ServerInfo,
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

    def search(self, query: SearchQuery) -> SearchResult:
        """Search the motion database."""

    def info(self) -> ServerInfo:
        """Tell versions, libraries, limits."""

    def close(self) -> None:
        """Free what the transport holds; twice is harmless."""


def in_process_transport(library: str | None) -> Transport:
    """Return a runtime in this process over a library folder; None means the embedded library.

    Raises:
        StridewireError: If the extra that runs characters is not installed.
    """
    for point in entry_points(group="stridewire.transports", name="in-process"):
        try:
            factory = point.load()
        except ModuleNotFoundError as error:
            raise StridewireError(
                f"running characters in this process needs {error.name}: "
                "pip install 'stridewire[server]'"
            ) from error
        transport: Transport = factory(library)
        return transport
    raise StridewireError(
        "no runtime is installed in this environment: pip install 'stridewire[server]', "
        "or give the address of a server"
    )
