"""Whatever is sent, in whatever order: a status of the contract, and a healthy server after it."""

from collections.abc import Iterator
from contextlib import suppress

import grpc
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from serving import DEADLINE_S, Serve, eventually
from stridewire import Client
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import pose_pb2
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub

ALLOWED = {
    "OK",
    "INVALID_ARGUMENT",
    "NOT_FOUND",
    "FAILED_PRECONDITION",
    "RESOURCE_EXHAUSTED",
    "UNIMPLEMENTED",
}

ids = st.integers(0, 4)
numbers = st.floats(width=32) | st.sampled_from([0.0, 1.0, -1.0, 1e30, float("nan")])
floats = st.lists(numbers, max_size=6)
roots = st.none() | st.builds(
    pose_pb2.GroundPose,
    position=st.builds(pose_pb2.Vector3, x=numbers, y=numbers, z=numbers),
    yaw=numbers,
)
specs = st.builds(
    pb.CharacterSpec,
    id=ids,
    root=roots,
    stitcher=st.sampled_from(["", "none", "spring", "glue"]),
    foot_lock=st.none() | st.booleans(),
    rate_divider=st.integers(0, 2),
)
opens = st.builds(
    pb.Open,
    library=st.sampled_from(["", "", "small", "nowhere"]),
    pacing=st.integers(0, 3),
    rate_hz=st.sampled_from([0.0, 240.0, 1e9, float("nan")]),
    characters=st.lists(specs, max_size=3),
    max_frames_in_flight=st.none() | st.sampled_from([0, 1, 5, 9999]),
    detail=st.integers(0, 4),
)
sparse = st.builds(
    pb.Sparse,
    character=ids,
    trajectory=st.none()
    | st.builds(pose_pb2.Trajectory, positions_xz=floats, facings_yaw=floats, times_s=floats),
    root_correction=st.none() | st.builds(pb.RootCorrection, root=roots, mode=st.integers(0, 3)),
    force_search=st.booleans(),
)
steps = st.builds(
    pb.Step,
    step=st.integers(0, 2**32 - 1),
    dt_s=st.sampled_from([1 / 60, 0.0, 5.0, -1.0, float("inf"), float("nan")]),
    last_frame=st.sampled_from([0, 1, 2**32 - 1]),
    client_time_s=st.floats(),
    characters=st.lists(ids, max_size=3),
    velocity_xz=floats,
    facing_yaw=floats,
    sparse=st.lists(sparse, max_size=2),
    ack_only=st.booleans(),
)
edits = st.builds(
    pb.Edit,
    add=st.lists(specs, max_size=2),
    remove=st.lists(ids, max_size=2),
    update=st.lists(st.builds(pb.CharacterUpdate, spec=specs), max_size=2),
)
messages = st.one_of(
    st.builds(pb.AnimateRequest, step=steps),
    st.builds(pb.AnimateRequest, edit=edits),
    st.builds(pb.AnimateRequest, open=opens),
    st.builds(pb.AnimateRequest, close=st.just(pb.Close())),
)
good_open = st.just(pb.AnimateRequest(open=pb.Open(characters=[pb.CharacterSpec(id=1)])))
conversations = st.tuples(good_open | messages, st.lists(messages, max_size=6)).map(
    lambda parts: [parts[0], *parts[1]]
)


shared_server = settings(
    max_examples=80,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@pytest.fixture
def own_server(serve: Serve) -> Iterator[tuple[grpc.Channel, Client]]:
    """Return a channel and a client of a server of the test's own."""
    address = serve()
    with grpc.insecure_channel(address) as channel, Client(address) as client:
        yield channel, client


@shared_server
@given(conversation=conversations)
def test_any_conversation_ends_well(
    own_server: tuple[grpc.Channel, Client], conversation: list[pb.AnimateRequest]
) -> None:
    """No fault, no session left over, and whatever frames came are finite."""
    channel, client = own_server
    call = AnimationServiceStub(channel).Animate(iter(conversation), timeout=DEADLINE_S)
    with suppress(grpc.RpcError):
        for response in call:
            if response.WhichOneof("message") == "frame":
                frame = response.frame
                assert all(abs(value) < 1e9 for value in (*frame.root, *frame.rotations))
    assert call.code().name in ALLOWED, call.details()
    assert eventually(lambda: client.info().sessions == 0)


@shared_server
@given(
    conversation=conversations,
    place=st.integers(0, 200),
    byte=st.integers(0, 255),
    cut=st.booleans(),
)
def test_damaged_bytes_end_well(
    own_server: tuple[grpc.Channel, Client],
    conversation: list[pb.AnimateRequest],
    place: int,
    byte: int,
    cut: bool,
) -> None:
    """A byte changed or the rest cut off in each message: the same promises hold."""
    channel, client = own_server
    damaged = []
    for message in conversation:
        data = bytearray(message.SerializeToString())
        if data:
            data[place % len(data)] = byte
        damaged.append(bytes(data[: len(data) // 2] if cut else data))
    animate = channel.stream_stream("/stridewire.v1.AnimationService/Animate")
    call = animate(iter(damaged), timeout=DEADLINE_S)
    with suppress(grpc.RpcError):
        list(call)
    assert call.code().name in ALLOWED, call.details()
    assert eventually(lambda: client.info().sessions == 0)
