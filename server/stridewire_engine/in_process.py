"""The transport without a wire: a runtime in this process behind the same interface as a server."""

import time
from collections import deque

from stridewire._errors import ProtocolError
from stridewire._messages import (
    Edit,
    Open,
    Opened,
    Pacing,
    SearchQuery,
    SearchResult,
    ServerInfo,
    ServerMessage,
    Step,
    StreamError,
)
from stridewire_engine.building import open_library
from stridewire_engine.runtime import Runtime, Session


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

    def search(self, query: SearchQuery) -> SearchResult:
        """Search the motion database."""
        return self.runtime.search(query)

    def info(self) -> ServerInfo:
        """Tell versions, libraries, limits."""
        return self.runtime.info()

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
        if self._inbox:
            return self._inbox.popleft()
        if self._closed:
            return None
        if not self._paced:
            raise TimeoutError("nothing to receive: a frame comes only after a step")
        wait = self._next - time.monotonic()
        if wait > timeout_s:
            time.sleep(timeout_s)
            raise TimeoutError(f"no frame within {timeout_s} s")
        time.sleep(max(wait, 0.0))
        self._next = max(self._next + self._interval, time.monotonic() - self._interval)
        self._advance(self._session.held_step(self._interval))
        return self._inbox.popleft()

    def _advance(self, step: Step) -> None:
        ((frame, error),) = self._runtime.advance([(self._session, step)])
        self._report(error)  # before its frame, as a server sends it
        self._inbox.append(frame)

    def _report(self, error: StreamError | None) -> None:
        if error is not None:
            self._inbox.append(error)

    def close(self) -> None:
        """End the session."""
        self._closed = True
        self._runtime.close(self._session)
