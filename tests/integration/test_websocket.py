"""The WebSocket door: the same sessions, errors and credits as over gRPC."""

import json
import struct
import urllib.error
import urllib.request
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from serving import DEADLINE_S, Doors, eventually, opening, stepping
from stridewire import Client
from stridewire._codec.responses import decode_response
from stridewire._messages import Frame
from stridewire.v1 import animation_pb2 as pb


def dial(doors: Doors, **given: Any) -> ClientConnection:
    """Connect to the WebSocket door."""
    url = f"ws://{doors.websocket}/v1/animate"
    return connect(url, compression=None, open_timeout=DEADLINE_S, **given)


def say(connection: ClientConnection, *requests: pb.AnimateRequest) -> None:
    """Send messages."""
    for request in requests:
        connection.send(request.SerializeToString())


def hear(connection: ClientConnection) -> Iterator[pb.AnimateResponse]:
    """Yield messages until the server closes."""
    try:
        while True:
            yield pb.AnimateResponse.FromString(bytes(connection.recv(DEADLINE_S, decode=False)))
    except ConnectionClosed:
        return


def conversation(
    doors: Doors, *requests: pb.AnimateRequest
) -> tuple[list[pb.AnimateResponse], int, str]:
    """Send messages; return what is answered until the server closes, and how it closes."""
    with dial(doors) as connection:
        say(connection, *requests)
        answers = list(hear(connection))
        assert connection.close_code is not None
        return answers, connection.close_code, connection.close_reason or ""


CLOSE = pb.AnimateRequest(close=pb.Close())


def test_both_doors_give_the_same_frames(door: Doors) -> None:
    """The same steps make the same bytes in every block, over gRPC and through the WebSocket."""
    velocity = [[0.0, 0.1 * i] for i in range(20)]
    with Client(door.grpc) as client, client.open_session(2) as session:
        expected = [session.step(velocity=(v[0], v[1])) for v in velocity]
    steps = [stepping(step=i + 1, velocity_xz=v * 2) for i, v in enumerate(velocity)]
    answers, code, _ = conversation(door, opening(2), *steps, CLOSE)
    assert code == 1000
    assert [answer.WhichOneof("message") for answer in answers] == ["opened"] + ["frame"] * 20
    for answer, wanted in zip(answers[1:], expected, strict=True):
        frame = decode_response(answer)
        assert isinstance(frame, Frame)
        assert frame.root.tobytes() == wanted.root.tobytes()
        assert frame.rotations.tobytes() == wanted.rotations.tobytes()


def test_a_bad_control_is_refused_in_the_stream(door: Doors) -> None:
    """An Error names the field, and the session lives: as over gRPC."""
    bad = stepping(step=1, velocity_xz=[float("nan"), 0.0])
    answers, code, _ = conversation(door, opening(), bad, stepping(step=2), CLOSE)
    kinds = [answer.WhichOneof("message") for answer in answers]
    assert (kinds, code) == (["opened", "error", "frame", "frame"], 1000)
    assert answers[1].error.violations[0].field == "step.velocity_xz[0]"


@pytest.mark.parametrize(
    ("requests", "code", "says"),
    [
        ([stepping()], 4009, "Step before Open"),
        ([opening(), opening()], 4009, "a second Open"),
        ([opening(library="nowhere")], 4005, "no library 'nowhere'"),
        ([opening(rate_hz=5.0)], 4003, "open.rate_hz: 5.0"),
    ],
)
def test_a_stream_ends_with_the_status_as_close_code(
    door: Doors, requests: list[pb.AnimateRequest], code: int, says: str
) -> None:
    """4000 and the number of gRPC's status; the reason is its message."""
    _, closed, reason = conversation(door, *requests)
    assert closed == code
    assert says in reason


def test_every_wrong_field_of_open_is_told_before_the_close(door: Doors) -> None:
    """A reason is short; the fields come as an Error message, each with its path."""
    wrong = pb.CharacterSpec(stitcher="glue", height_m=9.0)
    request = pb.AnimateRequest(open=pb.Open(rate_hz=1.0, characters=[wrong]))
    answers, code, reason = conversation(door, request)
    assert code == 4003
    assert len(reason.encode()) <= 123
    fields = [violation.field for violation in answers[0].error.violations]
    assert {"open.rate_hz", "open.characters[0].stitcher"} <= set(fields)


def test_credits_hold_a_slow_reader_to_the_newest_frame(door: Doors) -> None:
    """With 3 frames unacknowledged the rest is skipped, counted and told by the next frame."""
    with dial(door) as connection:
        say(connection, opening(max_frames_in_flight=3))
        say(connection, *[stepping(step=i + 1) for i in range(20)])
        answers = hear(connection)
        assert next(answers).WhichOneof("message") == "opened"
        assert [next(answers).frame.frame for _ in range(3)] == [1, 2, 3]
        with Client(door.grpc) as client, client.open_session() as other:
            for _ in range(30):  # by then the twenty steps are done with
                other.step()
        say(connection, pb.AnimateRequest(step=pb.Step(ack_only=True, last_frame=3)))
        newest = next(answers).frame
        assert (newest.frame, newest.applied_step, newest.dropped) == (20, 20, 16)


def test_sessions_of_both_doors_share_the_limit(own_door: Any) -> None:
    """A place that a WebSocket takes is not there for gRPC, and is free when it goes."""
    doors = own_door(max_sessions=1)
    with Client(doors.grpc, timeout_s=DEADLINE_S) as client:
        with dial(doors) as connection:
            say(connection, opening())
            next(hear(connection))
            assert client.info().sessions == 1
            _, code, reason = conversation(doors, opening())
            assert code == 4008
            assert "all 1 sessions are taken" in reason
        assert eventually(lambda: client.info().sessions == 0)
        with client.open_session() as session:
            assert session.step().frame == 1


def test_a_server_that_stops_tells_and_closes(own_door: Any) -> None:
    """A Notice with the time left, then the close; nobody is let in meanwhile."""
    doors = own_door()
    with dial(doors) as connection:
        say(connection, opening())
        answers = hear(connection)
        next(answers)
        doors.stop()
        kinds = [answer.WhichOneof("message") for answer in answers]
        assert kinds == ["notice"]
        assert connection.close_code == 1001


def test_the_layout_alone_is_enough_to_read_a_frame(door: Doors) -> None:
    """A reader that knows varints and the JSON, and no protobuf, finds every block in its shape."""
    with urllib.request.urlopen(f"http://{door.websocket}/v1/layout.json") as response:
        layout = json.load(response)
    with dial(door) as connection:
        say(connection, opening(3, detail=pb.DETAIL_COSTS), stepping(step=7), CLOSE)
        opened, framed = (bytes(connection.recv(DEADLINE_S, decode=False)) for _ in range(2))
    skeleton = read(layout, "AnimateResponse", opened)["opened"]["skeleton"]
    frame = read(layout, "AnimateResponse", framed)["frame"]
    wanted = decode_response(pb.AnimateResponse.FromString(framed))
    assert isinstance(wanted, Frame)
    sizes = {"N": 3, "J": len(skeleton["joints"])}
    for name in ("root", "root_delta", "hips", "rotations", "foot_targets", "simulated_root"):
        shape = [sizes.get(size, size) for size in layout["blocks"][name]["shape"]]
        np.testing.assert_array_equal(frame[name].reshape(shape), getattr(wanted, name))
    assert frame["applied_step"] == 7
    assert frame["characters"].tolist() == [0, 1, 2]
    assert frame["events"][0]["transition"]["to"]["clip"] == wanted.events[0].to_clip


def test_the_layout_tells_the_shape_of_every_block() -> None:
    """No packed or half-float field of a Frame is left to guess."""
    from stridewire_server.websocket.layout import layout

    found = layout()
    blocks = {
        name
        for name, field in found["messages"]["Frame"].items()
        if field.get("repeated") == "packed" or field["type"] == "bytes"
    }
    assert blocks == set(found["blocks"])


def test_what_is_not_there_is_not_found(door: Doors) -> None:
    """Another path, as a page or as a WebSocket, is answered 404 and told where streams are."""
    with pytest.raises(urllib.error.HTTPError, match="404") as raised:
        urllib.request.urlopen(f"http://{door.websocket}/../../etc/passwd")
    assert b"/v1/animate" in raised.value.read()


READ = {"float32": "<f4", "float64": "<f8", "float16": "<f2"}


def read(layout: dict[str, Any], message: str, data: bytes) -> dict[str, Any]:
    """Read a message by the layout alone."""
    by_tag = {field["tag"]: (name, field) for name, field in layout["messages"][message].items()}
    found: dict[str, Any] = {}
    at = 0
    while at < len(data):
        tag, at = varint(data, at)
        match tag & 7:
            case 0:
                value, at = varint(data, at)
            case 1 | 5 as wire_type:
                size = 8 if wire_type == 1 else 4
                (value,) = struct.unpack("<d" if size == 8 else "<f", data[at : at + size])
                at += size
            case 2:
                size, at = varint(data, at)
                value, at = data[at : at + size], at + size
        if tag not in by_tag:
            continue
        name, field = by_tag[tag]
        if field["type"] == "message":
            value = read(layout, field["of"], value)
        elif field.get("repeated") == "packed":
            value = packed(field["type"], value)
        elif field["type"] == "string":
            value = value.decode()
        if field.get("repeated") == "one by one":
            found.setdefault(name, []).append(value)
        else:
            found[name] = value
    return found


def packed(kind: str, data: bytes) -> np.ndarray:
    """Read the numbers of a packed field."""
    if kind in READ:
        return np.frombuffer(data, READ[kind])
    numbers, at = [], 0
    while at < len(data):
        number, at = varint(data, at)
        numbers.append(number)
    return np.array(numbers)


def varint(data: bytes, at: int) -> tuple[int, int]:
    """Read a varint; return it and where it ends."""
    number = shift = 0
    while True:
        byte = data[at]
        number |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return number, at
