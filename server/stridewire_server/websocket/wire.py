"""The wire of a WebSocket: each binary message is one protobuf message."""

import asyncio

import grpc
from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from stridewire._codec.responses import response_bytes
from stridewire._codec.status import MAX_VIOLATIONS
from stridewire._errors import InvalidRequestError, ProtocolError, StridewireError
from stridewire._messages import StreamError
from stridewire.v1 import animation_pb2 as pb

CLOSE_CODE_BASE = 4000
"""A stream that ends with a gRPC status closes its WebSocket with this and the status's number."""

_MAX_REASON_BYTES = 123
"""What a close frame has room for."""


class WebSocketWire:
    """Reads requests from and writes responses to one connection.

    Args:
        connection: That is open.
        open_timeout_s: Longest wait for the first message.
    """

    def __init__(self, connection: ServerConnection, open_timeout_s: float) -> None:
        self._connection = connection
        self._open_timeout_s: float | None = open_timeout_s

    async def read(self) -> pb.AnimateRequest | None:
        """Wait for the next message; None where the client is gone.

        Raises:
            DecodeError: If the bytes are no message.
            InvalidRequestError: If the message is text.
            ProtocolError: If the first message does not come in time.
        """
        try:
            async with asyncio.timeout(self._open_timeout_s):
                data = await self._connection.recv()
        except ConnectionClosed:
            return None
        except TimeoutError:
            waited = self._open_timeout_s
            raise ProtocolError(f"no Open within {waited:g} s; send Open first") from None
        self._open_timeout_s = None
        if isinstance(data, str):
            raise InvalidRequestError(
                "a text message; send each AnimateRequest as one binary message"
            )
        return pb.AnimateRequest.FromString(data)

    async def write(self, response: bytes) -> None:
        """Send a message; returns when there is room for the next one."""
        await self._connection.send(response)


async def refuse(connection: ServerConnection, error: StridewireError) -> None:
    """End a stream with an error: its fields as an Error message, then code and reason."""
    if error.violations:
        listed = error.violations[:MAX_VIOLATIONS]
        told = StreamError(0, listed, len(error.violations) - len(listed))
        await connection.send(response_bytes(told))
    await connection.close(close_code(error.code), _cut(str(error)))


def close_code(status: str) -> int:
    """Return the close code of a gRPC status by name: 4003 for INVALID_ARGUMENT, for instance."""
    number: int = grpc.StatusCode[status].value[0]
    return CLOSE_CODE_BASE + number


def _cut(reason: str) -> str:
    """Return as much of a reason as a close frame has room for."""
    data = reason.encode()
    if len(data) <= _MAX_REASON_BYTES:
        return reason
    return data[: _MAX_REASON_BYTES - len("…".encode())].decode(errors="ignore") + "…"
