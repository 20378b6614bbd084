"""The transport over gRPC for asyncio."""

import asyncio
import weakref
from collections.abc import AsyncIterator
from typing import Any

import grpc
from grpc.aio import EOF  # type: ignore[attr-defined]

from stridewire._channel import (
    CHANNEL_OPTIONS,
    PARTS_TIMEOUT_S,
    encode_query,
    rpc_error,
    to_error,
)
from stridewire._codec.calls import CALL_BY_PARTS_QUERY, CALL_BY_QUERY
from stridewire._codec.requests import encode_request
from stridewire._codec.responses import decode_response
from stridewire._errors import ProtocolError, StridewireError
from stridewire._messages import (
    AnswerT,
    ClientMessage,
    Close,
    Edit,
    Open,
    Opened,
    PartsQuery,
    PartT,
    Query,
    ServerMessage,
    Step,
)
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub

_CLOSE_TIMEOUT_S = 2.0
_LOST_IN_WRITE = "Internal error from Core"
"""What gRPC says, with INTERNAL, of a connection that broke during a write."""


class AsyncGrpcTransport:
    """A server at an address; connects when it is first used, within one event loop.

    Args:
        address: `host:port`.
        timeout_s: Longest wait for the answer to a query or to Open.
    """

    def __init__(self, address: str, timeout_s: float = 5.0) -> None:
        self._address = address
        self._timeout_s = timeout_s
        self._opened_channel: Any = None
        self._streams: weakref.WeakSet[AsyncGrpcStream] = weakref.WeakSet()

    async def open(self, message: Open) -> "AsyncGrpcStream":
        """Open a session."""
        animate = AnimationServiceStub(self._channel).Animate
        stream = await AsyncGrpcStream.start(animate, self._address, message, self._timeout_s)
        self._streams.add(stream)
        return stream

    async def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query."""
        call = CALL_BY_QUERY[type(query)]
        method = self._channel.unary_unary(call.path, bytes, bytes)
        try:
            data = await method(encode_query(call, query), timeout=self._timeout_s)
        except grpc.RpcError as error:
            raise rpc_error(error, self._address) from error
        answer: AnswerT = call.deserialize(data)
        return answer

    async def parts(self, query: PartsQuery[PartT]) -> AsyncIterator[PartT]:
        """Answer a query part by part; the call ends when the iterator is closed."""
        call = CALL_BY_PARTS_QUERY[type(query)]
        method = self._channel.unary_stream(call.path, bytes, bytes)
        stream = method(encode_query(call, query), timeout=PARTS_TIMEOUT_S)
        try:
            async for data in stream:
                yield call.deserialize(data)
        except grpc.RpcError as error:
            raise rpc_error(error, self._address) from error
        finally:
            stream.cancel()

    async def close(self) -> None:
        """End all sessions and close the connection."""
        for stream in list(self._streams):
            await stream.close()
        if self._opened_channel is not None:
            await self._opened_channel.close()

    @property
    def _channel(self) -> Any:
        if self._opened_channel is None:  # a channel belongs to the loop in which it is made
            self._opened_channel = grpc.aio.insecure_channel(self._address, CHANNEL_OPTIONS)
        return self._opened_channel


class AsyncGrpcStream:
    """One session over gRPC.

    A single read is always under way: so a caller who takes nothing is felt by the server and not
    by this process's memory, and the end of the stream is known before something is sent.
    """

    opened: Opened

    def __init__(self, call: Any, address: str, timeout_s: float) -> None:
        self._call = call
        self._address = address
        self._timeout_s = timeout_s
        self._reading: asyncio.Task[Any] = asyncio.create_task(_read(call))
        self._closing = False
        self._ended = False
        self._end: StridewireError | None = None

    @classmethod
    async def start(
        cls, animate: Any, address: str, message: Open, timeout_s: float
    ) -> "AsyncGrpcStream":
        """Open a session.

        Raises:
            StridewireError: If it is refused.
            TimeoutError: If no answer came in time.
        """
        stream = cls(animate(), address, timeout_s)
        try:
            await stream._send(message)
            first = await stream.receive(timeout_s)
        except BaseException:
            stream._call.cancel()
            raise
        if not isinstance(first, Opened):
            stream._call.cancel()
            raise ProtocolError(f"the server began with {type(first).__name__} instead of Opened")
        stream.opened = first
        return stream

    async def send(self, message: Step | Edit) -> None:
        """Send a message.

        Raises:
            StridewireError: If the session has ended: what ended it.
            TimeoutError: If the server takes nothing.
        """
        await self._send(message)

    async def receive(self, timeout_s: float) -> ServerMessage | None:
        """Wait for the next message; None when the stream has ended.

        Raises:
            TimeoutError: If nothing came in time.
            StridewireError: If the stream ended with an error.
        """
        if self._ended:
            self._raise_end()
            return None
        done, _ = await asyncio.wait({self._reading}, timeout=timeout_s)
        if not done:
            raise TimeoutError(f"no message from the server within {timeout_s:g} s")
        response = self._reading.result()
        if response is EOF:
            await self._note_end()
            self._raise_end()
            return None
        self._reading = asyncio.create_task(_read(self._call))
        return decode_response(response)

    async def close(self) -> None:
        """End the session and free what it holds; twice is harmless."""
        if self._closing:
            return
        self._closing = True
        try:
            async with asyncio.timeout(_CLOSE_TIMEOUT_S):
                await self._send(Close())
                await self._call.done_writing()
                while await self.receive(_CLOSE_TIMEOUT_S) is not None:
                    continue
        except (StridewireError, TimeoutError, grpc.RpcError, asyncio.InvalidStateError):
            pass
        self._call.cancel()
        await asyncio.wait({self._reading})

    async def _send(self, message: ClientMessage) -> None:
        if self._reading.done() and self._reading.result() is EOF:
            await self._note_end()
            raise self._end or ProtocolError("the session has ended; open another one")
        try:
            async with asyncio.timeout(self._timeout_s):
                await self._call.write(encode_request(message))
        except (grpc.RpcError, asyncio.InvalidStateError):
            await self._note_end()
            self._raise_end()
            raise ProtocolError("the session has ended; open another one") from None
        except TimeoutError:
            raise TimeoutError(
                f"the server took no message for {self._timeout_s:g} s; send less often"
            ) from None

    async def _note_end(self) -> None:
        """Find out how the stream ended."""
        if self._ended:
            return
        self._ended = True
        code = await self._call.code()
        if code is not grpc.StatusCode.OK and not self._closing:
            metadata = await self._call.trailing_metadata()
            details = await self._call.details()
            if details == _LOST_IN_WRITE:
                code = grpc.StatusCode.UNAVAILABLE
            self._end = to_error(code, details, metadata, self._address)

    def _raise_end(self) -> None:
        if self._end is not None:
            raise self._end


async def _read(call: Any) -> Any:
    """Return the next message; EOF at the end, whatever it is."""
    try:
        return await call.read()
    except (grpc.RpcError, asyncio.CancelledError):
        return EOF
