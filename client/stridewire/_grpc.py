"""The transport over gRPC, blocking."""

import queue
import threading
import weakref
from collections.abc import Callable, Iterator
from typing import Any

import grpc

from stridewire._channel import CHANNEL_OPTIONS, PARTS_TIMEOUT_S, encode_query, rpc_error
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

_WAITING_REQUESTS = 64
_WAITING_RESPONSES = 2
_CLOSE_TIMEOUT_S = 2.0


class GrpcTransport:
    """A server at an address; connects when it is first used.

    Args:
        address: `host:port`.
        timeout_s: Longest wait for the answer to a query or to Open.
    """

    def __init__(self, address: str, timeout_s: float = 5.0) -> None:
        self._address = address
        self._timeout_s = timeout_s
        self._channel = grpc.insecure_channel(address, CHANNEL_OPTIONS)
        self._animation = AnimationServiceStub(self._channel)
        self._streams: weakref.WeakSet[GrpcStream] = weakref.WeakSet()

    def open(self, message: Open) -> "GrpcStream":
        """Open a session."""
        stream = GrpcStream(self._animation.Animate, self._address, message, self._timeout_s)
        self._streams.add(stream)
        return stream

    def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query."""
        call = CALL_BY_QUERY[type(query)]
        method = self._channel.unary_unary(call.path, bytes, bytes)
        try:
            data = method(encode_query(call, query), timeout=self._timeout_s)
        except grpc.RpcError as error:
            raise rpc_error(error, self._address) from error
        answer: AnswerT = call.deserialize(data)
        return answer

    def parts(self, query: PartsQuery[PartT]) -> Iterator[PartT]:
        """Answer a query part by part; the call ends when the iterator is closed."""
        call = CALL_BY_PARTS_QUERY[type(query)]
        method = self._channel.unary_stream(call.path, bytes, bytes)
        stream: Any = method(encode_query(call, query), timeout=PARTS_TIMEOUT_S)
        try:
            for data in stream:
                yield call.deserialize(data)
        except grpc.RpcError as error:
            raise rpc_error(error, self._address) from error
        finally:
            stream.cancel()

    def close(self) -> None:
        """End all sessions and close the connection."""
        for stream in list(self._streams):
            stream.close()
        self._channel.close()


class GrpcStream:
    """One session over gRPC.

    A thread of its own reads; it holds two messages at most, so that a caller who does not take
    them is felt by the server and not by this process's memory.
    """

    def __init__(
        self, animate: Callable[[Any], Any], address: str, message: Open, timeout_s: float
    ) -> None:
        self._address = address
        self._requests: queue.Queue[Any] = queue.Queue(_WAITING_REQUESTS)
        self._responses: queue.Queue[ServerMessage | StridewireError | None] = queue.Queue(
            _WAITING_RESPONSES
        )
        self._timeout_s = timeout_s
        self._ended = threading.Event()
        self._end: StridewireError | None = None
        self._closing = False
        self._requests.put(encode_request(message))
        self._call = animate(iter(self._requests.get, None))
        threading.Thread(target=self._read, name="stridewire-read", daemon=True).start()
        self.opened = self._wait_opened()

    def send(self, message: Step | Edit) -> None:
        """Send a message.

        Raises:
            StridewireError: If the session has ended: what ended it.
            TimeoutError: If the server takes nothing.
        """
        self._send(message)

    def receive(self, timeout_s: float) -> ServerMessage | None:
        """Wait for the next message; None when the stream has ended.

        Raises:
            TimeoutError: If nothing came in time.
            StridewireError: If the stream ended with an error.
        """
        try:
            message = self._responses.get(timeout=timeout_s)
        except queue.Empty:
            raise TimeoutError(f"no message from the server within {timeout_s:g} s") from None
        if message is None or isinstance(message, StridewireError):
            self._responses.put(message)  # the end stays the end
        if isinstance(message, StridewireError):
            raise message
        return message

    def close(self) -> None:
        """End the session and free what it holds; twice is harmless."""
        if self._closing:
            return
        self._closing = True
        if not self._ended.is_set():
            try:
                self._send(Close())
                self._requests.put(None, timeout=self._timeout_s)
            except (StridewireError, TimeoutError, queue.Full):
                self._call.cancel()
        timer = threading.Timer(_CLOSE_TIMEOUT_S, self._call.cancel)
        timer.start()
        while not self._ended.is_set() or not self._responses.empty():
            self._discard()
        timer.cancel()

    def _send(self, message: ClientMessage) -> None:
        if self._ended.is_set():
            raise self._end or ProtocolError("the session has ended; open another one")
        try:
            self._requests.put(encode_request(message), timeout=self._timeout_s)
        except queue.Full:
            raise TimeoutError(
                f"the server took no message for {self._timeout_s:g} s; send less often"
            ) from None

    def _wait_opened(self) -> Opened:
        try:
            first = self.receive(self._timeout_s)
        except BaseException:
            self._call.cancel()
            raise
        if not isinstance(first, Opened):
            self._call.cancel()
            raise ProtocolError(f"the server began with {type(first).__name__} instead of Opened")
        return first

    def _read(self) -> None:
        try:
            for response in self._call:
                self._responses.put(decode_response(response))
        except grpc.RpcError as error:
            if not (self._closing and error.code() is grpc.StatusCode.CANCELLED):
                self._end = rpc_error(error, self._address)
                self._end.__cause__ = error
        except StridewireError as error:
            self._end = error
        finally:
            self._ended.set()
            self._release_sender()
            self._responses.put(self._end)

    def _release_sender(self) -> None:
        """Let the thread in which gRPC waits for requests end."""
        while True:
            try:
                self._requests.put_nowait(None)
                return
            except queue.Full:
                self._discard_request()

    def _discard_request(self) -> None:
        try:
            self._requests.get_nowait()
        except queue.Empty:
            return

    def _discard(self) -> None:
        try:
            self._responses.get(timeout=0.05)
        except queue.Empty:
            return
