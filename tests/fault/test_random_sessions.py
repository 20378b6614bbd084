"""Random sessions over the wire and in process are equal; hostile ones end as the contract says."""

from collections.abc import Iterator
from typing import Any

import grpc
import pytest
from hypothesis import HealthCheck, given, settings

from serving import DEADLINE_S, Serve, opening
from sessions import assert_alike, hostile_ends, hostile_in_stream, plans, play
from stridewire import Client
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub
from stridewire_engine.library import Library

random_sessions = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[
        HealthCheck.function_scoped_fixture,
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
    ],
)


@pytest.fixture(scope="module")
def here(small_library: Library) -> Client:
    """Return a client of a runtime in this process."""
    return Client.in_process(small_library.path)


@pytest.fixture
def channel(serve: Serve) -> Iterator[grpc.Channel]:
    """Return a channel to a server of the test's own."""
    with grpc.insecure_channel(serve()) as opened:
        yield opened


@random_sessions
@given(plan=plans)
def test_any_session_is_the_same_over_the_wire(client: Client, here: Client, plan: Any) -> None:
    """Characters that come and go, paths, corrections, filters, rigs, pauses: all equal."""
    assert_alike(play(client, plan), play(here, plan))


@random_sessions
@given(hostile=hostile_ends)
def test_a_hostile_session_ends_as_the_contract_says(channel: grpc.Channel, hostile: Any) -> None:
    """Its own status, and the next session works."""
    messages, code = hostile
    call = AnimationServiceStub(channel).Animate(iter(messages), timeout=DEADLINE_S)
    with pytest.raises(grpc.RpcError):
        list(call)
    assert call.code().name == code, call.details()
    assert_works(channel)


@random_sessions
@given(hostile=hostile_in_stream)
def test_bad_messages_in_a_stream_are_refused_one_by_one(
    channel: grpc.Channel, hostile: Any
) -> None:
    """Each is named, every step makes its frame, and the next session works."""
    before, bad, after = hostile
    messages = [opening_of_one(), *before, *(message for message, _ in bad), *after]
    responses = list(AnimationServiceStub(channel).Animate(iter(messages), timeout=DEADLINE_S))
    refused = [
        violation.field
        for response in responses
        if response.WhichOneof("message") == "error"
        for violation in response.error.violations
    ]
    assert [field for _, field in bad] == refused
    steps = sum(message.WhichOneof("message") == "step" for message in messages)
    frames = [r.frame for r in responses if r.WhichOneof("message") == "frame"]
    assert frames[-1].frame == steps
    assert_works(channel)


def opening_of_one() -> pb.AnimateRequest:
    """Return an Open for a character called 1."""
    request = opening(1)
    request.open.characters[0].id = 1
    return request


def assert_works(channel: grpc.Channel) -> None:
    """Open a session and make a frame."""
    messages = [opening(2), pb.AnimateRequest(step=pb.Step(step=1, dt_s=1 / 60))]
    responses = list(AnimationServiceStub(channel).Animate(iter(messages), timeout=DEADLINE_S))
    assert [r.WhichOneof("message") for r in responses] == ["opened", "frame"]
