"""A reader that stalls costs itself frames and nobody else anything."""

import queue
import time
from collections.abc import Iterator
from itertools import islice

import grpc
import numpy as np
import pytest

from serving import DEADLINE_S, HeldRuntime, Serve, eventually, opening
from stridewire import Client, Pacing
from stridewire._messages import Limits
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import pose_pb2
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub
from stridewire_engine.library import Library

CREDITS = 5
RATE_HZ = 120.0


class RawSession:
    """A stream of the plain stub that is read only when the test says so."""

    def __init__(self, channel: grpc.Channel, first: pb.AnimateRequest) -> None:
        self.requests: queue.Queue[pb.AnimateRequest | None] = queue.Queue()
        self.requests.put(first)
        self.call = AnimationServiceStub(channel).Animate(
            iter(self.requests.get, None), timeout=2 * DEADLINE_S
        )

    def frames(self, count: int) -> Iterator[pb.Frame]:
        """Read messages until there were `count` frames."""
        frames = (r.frame for r in self.call if r.WhichOneof("message") == "frame")
        return islice(frames, count)

    def send(self, **given: object) -> None:
        """Send a Step."""
        self.requests.put(pb.AnimateRequest(step=pb.Step(**given)))

    def end(self) -> None:
        """Cancel the call and let its sender go."""
        self.call.cancel()
        self.requests.put(None)


@pytest.fixture
def stalled(address: str) -> Iterator[RawSession]:
    """Return a session with server pacing and few credits, which nobody acknowledges."""
    with grpc.insecure_channel(address) as channel:
        session = RawSession(
            channel,
            opening(
                pacing=pb.PACING_SERVER,
                rate_hz=RATE_HZ,
                max_frames_in_flight=CREDITS,
                detail=pb.DETAIL_EVENTS,
            ),
        )
        session.send(velocity_xz=[0.0, 1.4])
        yield session
        session.end()


def test_a_stalled_reader_gets_the_newest_frame_next(stalled: RawSession, client: Client) -> None:
    """After its credits nothing is sent; then the newest comes and tells what was skipped."""
    *_, last = stalled.frames(CREDITS)
    assert last.frame == CREDITS
    with client.open_session(pacing=Pacing.SERVER, rate_hz=RATE_HZ) as neighbour:
        seen = list(islice(neighbour.frames(), 90))
    stalled.send(ack_only=True, last_frame=last.frame)
    (after,) = stalled.frames(1)
    assert after.dropped == after.frame - last.frame - 1
    assert after.dropped >= 60
    assert [frame.frame for frame in seen] == list(range(1, 91))
    assert not any(frame.dropped for frame in seen)
    planted = [e for e in after.events if e.WhichOneof("event") == "contact"]
    assert {event.frame for event in planted} - {after.frame}


def test_root_motion_of_skipped_frames_is_not_lost(stalled: RawSession, client: Client) -> None:
    """The root before, moved by root_delta, is the root after, over however many skipped frames."""
    *_, last = stalled.frames(CREDITS)
    with client.open_session(pacing=Pacing.SERVER, rate_hz=RATE_HZ) as neighbour:
        list(islice(neighbour.frames(), 60))
    stalled.send(ack_only=True, last_frame=last.frame)
    (after,) = stalled.frames(1)
    (x, y, z, w, _, turn, _), (dx, dy, dz, dyaw) = last.root, after.root_delta
    yaw = 2.0 * np.arctan2(turn, w)
    sin, cos = np.sin(yaw), np.cos(yaw)
    moved = (x + cos * dx + sin * dz, y + dy, z - sin * dx + cos * dz)
    np.testing.assert_allclose(after.root[:3], moved, atol=1e-4)
    yaw_after = 2.0 * np.arctan2(after.root[5], after.root[3])
    assert np.cos(yaw_after - yaw - dyaw) == pytest.approx(1.0, abs=1e-6)


def test_a_reader_without_credits_is_cut_off(serve: Serve) -> None:
    """Who wants no credits and does not read is ended by the watchdog; the session is gone."""
    address = serve(limits=Limits(write_timeout_s=0.3))
    with grpc.insecure_channel(address) as channel, Client(address) as client:
        session = RawSession(
            channel,
            opening(512, pacing=pb.PACING_SERVER, rate_hz=240.0, max_frames_in_flight=0),
        )
        assert eventually(lambda: client.info().sessions == 1)
        assert eventually(lambda: client.info().sessions == 0)
        with pytest.raises(grpc.RpcError) as raised:
            list(session.call)
        assert raised.value.code() is grpc.StatusCode.RESOURCE_EXHAUSTED
        session.requests.put(None)


def test_a_flood_of_steps_is_held_back(serve: Serve, small_library: Library) -> None:
    """While a tick is held, a sender that never waits is stopped by the transport soon."""
    runtime = HeldRuntime(small_library)
    address = serve(runtime)
    velocity = [1.0] * 4
    bulky = [pb.Sparse(trajectory=pose_pb2.Trajectory(times_s=range(1, 9)))] * 300
    step = pb.AnimateRequest(step=pb.Step(dt_s=1 / 60, velocity_xz=velocity, sparse=bulky))
    sent = 0

    def flood() -> Iterator[pb.AnimateRequest]:
        nonlocal sent
        yield opening(2)
        while True:
            sent += 1
            yield step

    with grpc.insecure_channel(address) as channel, Client(address) as client:
        call = AnimationServiceStub(channel).Animate(flood(), timeout=2 * DEADLINE_S)
        assert runtime.inside.wait(DEADLINE_S)
        pauses = 0
        while pauses < 30:
            before = sent
            time.sleep(0.01)
            pauses = pauses + 1 if sent == before else 0
            assert sent * step.ByteSize() < 64 << 20
        call.cancel()
        runtime.go.set()
        assert eventually(lambda: client.info().sessions == 0)
