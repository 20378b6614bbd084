"""Recording a session where it is driven: a transport that writes down what passes through.

With client pacing the order of the messages is all that decides, so that any transport can be
recorded. A session that a server paces is recorded where its clock is: `stridewire serve --record`.
"""

from collections.abc import Iterator
from pathlib import Path

from stridewire._errors import ProtocolError
from stridewire._messages import (
    AnswerT,
    Edit,
    Frame,
    Open,
    Opened,
    Pacing,
    PartsQuery,
    PartT,
    Query,
    ServerMessage,
    Step,
)
from stridewire._transport import Stream, Transport
from stridewire.formats.session_file import SessionWriter


class RecordingTransport:
    """Records the sessions opened through it; a `stridewire._transport.Transport`.

    Args:
        transport: What runs the characters.
        path: File of the first session; further ones get a number: `walk.jsonl`, `walk-2.jsonl`.
    """

    def __init__(self, transport: Transport, path: Path) -> None:
        self._transport = transport
        self._path = path
        self._count = 0

    def open(self, message: Open) -> "RecordedStream":
        """Open a session and its file.

        Raises:
            ProtocolError: If the server is to pace the session.
        """
        if message.pacing is Pacing.SERVER:
            raise ProtocolError(
                "a session that the server paces is recorded where its clock is: "
                "stridewire serve --record FOLDER"
            )
        stream = self._transport.open(message)
        self._count += 1
        path = self._path
        if self._count > 1:
            path = path.with_stem(f"{path.stem}-{self._count}")
        return RecordedStream(stream, SessionWriter(path, message, stream.opened))

    def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query."""
        return self._transport.ask(query)

    def parts(self, query: PartsQuery[PartT]) -> Iterator[PartT]:
        """Answer a query part by part."""
        return self._transport.parts(query)

    def close(self) -> None:
        """Free what the transport holds."""
        self._transport.close()


class RecordedStream:
    """One session whose messages are written down."""

    def __init__(self, stream: Stream, writer: SessionWriter) -> None:
        self.opened: Opened = stream.opened
        self._stream = stream
        self._writer = writer

    def send(self, message: Step | Edit) -> None:
        """Send and note a message."""
        if isinstance(message, Edit):
            self._writer.edit(message)
        elif not message.ack_only:
            self._writer.advance(message)
        self._stream.send(message)

    def receive(self, timeout_s: float) -> ServerMessage | None:
        """Wait for the next message; frames are noted."""
        message = self._stream.receive(timeout_s)
        if isinstance(message, Frame):
            self._writer.frame(message)
        return message

    def close(self) -> None:
        """End the session and its file."""
        self._stream.close()
        self._writer.close()
