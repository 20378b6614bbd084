"""The wire of a stream: whole messages in and out, whichever door the client came through."""

from typing import Protocol

from stridewire.v1 import animation_pb2 as pb


class Wire(Protocol):
    """One stream of messages in each direction.

    A client that is gone ends both: `read` returns None, `write` raises what the door raises.
    """

    async def read(self) -> pb.AnimateRequest | None:
        """Wait for the next message; None at the end.

        Raises:
            DecodeError: If the bytes are no message.
        """

    async def write(self, response: bytes) -> None:
        """Hand the bytes of an `AnimateResponse` over; returns when there is room for the next."""
