"""Bad input at the WebSocket door: refused or bounded, and the session beside it goes on."""

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus, WebSocketException
from websockets.sync.client import ClientConnection, connect

from serving import DEADLINE_S, Doors, eventually, opening, stepping
from stridewire import Client
from stridewire.v1 import animation_pb2 as pb

CONNECTS = 1000


def dial(doors: Doors, **given: object) -> ClientConnection:
    """Connect to the WebSocket door."""
    url = f"ws://{doors.websocket}/v1/animate"
    return connect(url, compression=None, open_timeout=DEADLINE_S, **given)  # type: ignore[arg-type]


def raw(doors: Doors, data: bytes = b"") -> socket.socket:
    """Open a bare socket and send some bytes."""
    host, port = doors.websocket.split(":")
    opened = socket.create_connection((host, int(port)), timeout=DEADLINE_S)
    opened.sendall(data)
    return opened


def cut_off(opened: socket.socket) -> bool:
    """Tell whether the server has ended a connection; whatever it said before is read over."""
    opened.settimeout(0.0)
    try:
        while opened.recv(65536):
            pass
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True


@pytest.fixture
def healthy(door: Doors) -> Iterator[Callable[[], None]]:
    """Keep a session through each door; what is given checks that both still make frames."""
    with Client(door.grpc) as client, client.open_session() as beside, dial(door) as connection:
        connection.send(opening().SerializeToString())
        connection.recv(DEADLINE_S)

        def check() -> None:
            assert beside.step().root.shape == (1, 7)
            connection.send(stepping().SerializeToString())
            answer = pb.AnimateResponse.FromString(bytes(connection.recv(DEADLINE_S, decode=False)))
            assert answer.WhichOneof("message") == "frame"

        check()
        yield check
        check()


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1", "https://127.0.0.1:1", ""]
)
def test_a_foreign_page_is_not_let_in(
    door: Doors, healthy: Callable[[], None], origin: str
) -> None:
    """A browser tells the page's origin; any but the door's own is answered 403."""
    with pytest.raises(InvalidStatus) as raised:
        dial(door, additional_headers={"Origin": origin})
    assert raised.value.response.status_code == 403
    assert b"--origin" in raised.value.response.body
    with pytest.raises(InvalidStatus):
        dial(door, additional_headers=[("Origin", f"http://{door.websocket}"), ("Origin", origin)])


def test_a_page_of_the_door_and_a_program_are_let_in(
    door: Doors, own_door: Callable[..., Doors]
) -> None:
    """The door's own origin, none at all, and one that was named."""
    for origin in (None, f"http://{door.websocket}"):
        with dial(door, origin=origin) as connection:
            connection.send(opening().SerializeToString())
            assert connection.recv(DEADLINE_S)
    named = own_door(origins=("http://localhost:3000",))
    with dial(named, origin="http://localhost:3000"):
        pass


@pytest.mark.parametrize("path", ["/v1/animate", "/v1/layout.json"])
def test_another_name_for_this_machine_is_refused(door: Doors, path: str) -> None:
    """A name that was made to lead to loopback makes its pages foreign, whatever they tell."""
    host = f"evil.example:{door.websocket.split(':')[1]}"
    ask = f"GET {path} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n\r\n"
    with raw(door, ask.encode()) as opened:
        assert b"403" in opened.recv(65536).split(b"\r\n")[0]


@pytest.mark.parametrize("first", [True, False])
def test_text_ends_the_stream_alone(door: Doors, healthy: Callable[[], None], first: bool) -> None:
    """A text message is INVALID_ARGUMENT, as the first message or a later one."""
    with dial(door) as connection:
        if not first:
            connection.send(opening().SerializeToString())
            connection.recv(DEADLINE_S)
        connection.send('{"open": {}}')
        with pytest.raises(ConnectionClosed):
            connection.recv(DEADLINE_S)
        assert connection.close_code == 4003
        assert "binary" in str(connection.close_reason)


def test_bytes_that_are_no_message_end_the_stream_alone(
    door: Doors, healthy: Callable[[], None]
) -> None:
    """Garbage, and a message cut in half: INVALID_ARGUMENT as over gRPC."""
    for garbage in (b"\xff" * 9, opening(3).SerializeToString()[:-1]):
        with dial(door) as connection:
            connection.send(garbage)
            with pytest.raises(ConnectionClosed):
                connection.recv(DEADLINE_S)
            assert connection.close_code == 4003


@pytest.mark.parametrize("fragments", [1, 64])
def test_a_giant_message_ends_the_stream_alone(
    door: Doors, healthy: Callable[[], None], fragments: int
) -> None:
    """More than 1 MiB, whole or in fragments, is closed with 1009 before it is kept."""
    with dial(door) as connection, suppress(ConnectionClosed):
        part = b"\x00" * ((2 << 20) // fragments)
        connection.send(part if fragments == 1 else (part for _ in range(fragments)))
        connection.recv(DEADLINE_S)
    assert connection.close_code == 1009


def test_a_frame_that_claims_to_be_giant_is_not_waited_for(door: Doors) -> None:
    """A header that announces 2**62 bytes ends the connection; nothing is set aside for it."""
    with raw(door, handshake(door)) as opened:
        assert b"101" in opened.recv(65536).split(b"\r\n")[0]
        opened.sendall(b"\x82\xff" + (1 << 62).to_bytes(8, "big") + b"\x00" * 4)
        assert eventually(lambda: cut_off(opened))


def test_half_open_sockets_are_given_up(door: Doors, healthy: Callable[[], None]) -> None:
    """Silence, half a request, and a handshake without an Open: each ends within its time."""
    begun = time.monotonic()
    with ExitStack() as kept, dial(door) as waiting:
        sockets = [
            kept.enter_context(raw(door, data))
            for data in (b"", b"GET /v1/animate HTTP/1.1\r\nHost: ", handshake(door)) * 5
        ]
        healthy()
        assert eventually(lambda: all(map(cut_off, sockets)))
        with pytest.raises(ConnectionClosed):
            waiting.recv(DEADLINE_S)
        assert waiting.close_code == 4009
        assert "no Open within" in str(waiting.close_reason)
    assert time.monotonic() - begun > 4.0, "they were not given time at all"


def test_a_client_that_fell_silent_loses_its_session(own_door: Callable[..., Doors]) -> None:
    """A connection that answers no ping any more, and was never closed, frees its place."""
    doors = own_door()
    with Client(doors.grpc) as client, raw(doors, handshake(doors)) as opened:
        data = opening().SerializeToString()
        opened.sendall(bytes([0x82, 0x80 | len(data)]) + b"\x00" * 4 + data)
        assert eventually(lambda: client.info().sessions == 1)
        assert eventually(lambda: client.info().sessions == 0)


def test_a_thousand_connects_are_bounded(own_door: Callable[..., Doors]) -> None:
    """Most are cut off as they come; a session that was there goes on, and places come back."""
    doors = own_door(max_sessions=8)
    with Client(doors.grpc) as client, client.open_session() as session, ExitStack() as kept:
        sockets = [kept.enter_context(raw(doors)) for _ in range(CONNECTS)]
        assert session.step().frame == 1
        assert eventually(lambda: sum(map(cut_off, sockets)) >= CONNECTS - 8 - 64)
        assert sum(map(cut_off, sockets)) < CONNECTS, "nobody was let in"
        assert session.step().frame == 2
        kept.close()
        assert eventually(lambda: opens(doors))


def test_other_methods_and_bad_requests_are_answered(
    door: Doors, healthy: Callable[[], None]
) -> None:
    """POST, no HTTP at all, endless headers: an answer of 4xx or the end, never a fault."""
    endless = b"GET / HTTP/1.1\r\n" + b"X-A: b\r\n" * 1000
    for data in (b"POST / HTTP/1.1\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\r\n\r\n", endless):
        with raw(door, data) as opened:
            answer = opened.recv(65536)
            assert answer == b"" or answer.startswith(b"HTTP/1.1 4")


def opens(doors: Doors) -> bool:
    """Tell whether a session can be opened through the door now."""
    try:
        with dial(doors) as connection:
            connection.send(opening().SerializeToString())
            return bool(connection.recv(DEADLINE_S))
    except (OSError, EOFError, WebSocketException):
        return False


def handshake(doors: Doors) -> bytes:
    """Return a WebSocket's opening handshake."""
    return (
        f"GET /v1/animate HTTP/1.1\r\nHost: {doors.websocket}\r\nUpgrade: websocket\r\n"
        "Connection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
        "Sec-WebSocket-Version: 13\r\n\r\n"
    ).encode()
