"""What the client makes of trouble: typed errors with their cause, retries of reads alone."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import grpc
import pytest

from stridewire import (
    Client,
    InvalidRequestError,
    NotFoundError,
    NotImplementedYetError,
    ServerError,
    UnavailableError,
)
from stridewire._messages import Open
from stridewire.v1 import library_pb2
from stridewire.v1.animation_pb2_grpc import (
    AnimationServiceServicer,
    add_AnimationServiceServicer_to_server,
)
from stridewire.v1.library_pb2_grpc import (
    ServerServiceServicer,
    add_ServerServiceServicer_to_server,
)


class Flaky(ServerServiceServicer, AnimationServiceServicer):
    """Is unavailable the first two times that each method is called."""

    def __init__(self) -> None:
        self.calls = {"GetInfo": 0, "Animate": 0}
        self.code = grpc.StatusCode.UNAVAILABLE

    def GetInfo(self, request: Any, context: Any) -> library_pb2.GetInfoResponse:
        """Answer the third time."""
        self._fail("GetInfo", context)
        return library_pb2.GetInfoResponse(version="flaky")

    def Animate(self, requests: Any, context: Any) -> Iterator[Any]:
        """Answer the third time."""
        self._fail("Animate", context)
        return iter(())

    def _fail(self, method: str, context: Any) -> None:
        self.calls[method] += 1
        if self.calls[method] < 3:
            context.abort(self.code, "not now")


@pytest.fixture
def flaky() -> Iterator[tuple[Flaky, Client]]:
    """Return a flaky server and a client of it."""
    server = grpc.server(ThreadPoolExecutor(2))
    servicer = Flaky()
    add_ServerServiceServicer_to_server(servicer, server)
    add_AnimationServiceServicer_to_server(servicer, server)
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    with Client(f"127.0.0.1:{port}") as client:
        yield servicer, client
    server.stop(None).wait()


def test_reads_are_retried(flaky: tuple[Flaky, Client]) -> None:
    """A query that is UNAVAILABLE twice succeeds the third time."""
    servicer, client = flaky
    assert client.info().version == "flaky"
    assert servicer.calls["GetInfo"] == 3


def test_other_codes_are_not_retried(flaky: tuple[Flaky, Client]) -> None:
    """A fault of the server is told at once."""
    servicer, client = flaky
    servicer.code = grpc.StatusCode.INTERNAL
    with pytest.raises(ServerError, match="not now"):
        client.info()
    assert servicer.calls["GetInfo"] == 1


def test_streams_are_not_retried(flaky: tuple[Flaky, Client]) -> None:
    """Opening a session fails at once: nobody knows what a stream has done."""
    servicer, client = flaky
    with pytest.raises(UnavailableError):
        client.open_session()
    assert servicer.calls["Animate"] == 1


def test_no_server_is_told_with_what_to_do() -> None:
    """Nobody listens: the address and how to start a server are in the message."""
    with Client("127.0.0.1:1") as client:
        with pytest.raises(UnavailableError, match=r"127\.0\.0\.1:1 .*`stridewire serve`") as told:
            client.open_session()
        assert isinstance(told.value.__cause__, grpc.RpcError)
        with pytest.raises(UnavailableError):
            client.info()


def test_errors_are_typed_and_keep_their_cause(client: Client) -> None:
    """Each status becomes its class, violations included, the gRPC error its cause."""
    with pytest.raises(InvalidRequestError) as invalid:
        client.open_session(0)
    assert [violation.field for violation in invalid.value.violations] == ["open.characters"]
    assert isinstance(invalid.value, ValueError)
    with pytest.raises(NotFoundError) as absent:
        client.open_session(library="nowhere")
    assert isinstance(absent.value, LookupError)
    with pytest.raises(NotImplementedYetError) as later:
        client._transport.open(Open([], resume_token="x"))
    for told in (invalid, absent, later):
        assert isinstance(told.value.__cause__, grpc.RpcError)
        assert told.value.code == told.value.__cause__.code().name
