"""A session whose server is lost is opened again where its characters were."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from serving import DEADLINE_S, Awaited, LoopThread
from stridewire import AsyncClient, CharacterSpec, Client, Pacing, UnavailableError
from stridewire._messages import CharacterUpdate, Sparse
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_server.server import AnimationServer
from stridewire_server.settings import ServerSettings


class Restarted:
    """A server that can be stopped and started anew at the same address."""

    def __init__(self, thread: LoopThread, library: Library) -> None:
        self._thread = thread
        self._library = library
        self.runtime = Runtime([library])
        self.address = "127.0.0.1:0"
        self.start()

    def start(self) -> None:
        """Start with a fresh runtime."""
        self.runtime = Runtime([self._library])

        async def start() -> AnimationServer:
            server = AnimationServer(self.runtime, ServerSettings(self.address, drain_s=0.0))
            self.address = await server.start()
            return server

        self._server = self._thread.call(start())

    def stop(self) -> None:
        """Stop, open sessions or not."""
        self._thread.call(self._server.stop())


@pytest.fixture
def restarted(loop_thread: LoopThread, small_library: Library) -> Iterator[Restarted]:
    """Return a server of the test's own."""
    server = Restarted(loop_thread, small_library)
    yield server
    server.stop()


@pytest.fixture(params=["blocking", "asyncio"])
def connect(request: pytest.FixtureRequest, loop_thread: LoopThread) -> Callable[[str], Any]:
    """Return a maker of clients of both kinds."""
    if request.param == "blocking":
        return lambda address: Client(address, timeout_s=DEADLINE_S)
    return lambda address: Awaited(loop_thread, AsyncClient(address, timeout_s=DEADLINE_S))


def test_a_lost_session_goes_on_at_its_last_roots(
    restarted: Restarted, connect: Callable[[str], Any]
) -> None:
    """Characters, places, controls and settings are those before; the next frame is near by."""
    specs = [CharacterSpec(7), CharacterSpec(9)]
    with (
        connect(restarted.address) as client,
        client.open_session(specs, reconnect_s=DEADLINE_S) as session,
    ):
        session.edit(update=[CharacterUpdate(CharacterSpec(9, stitcher="none"), ("stitcher",))])
        session.teleport(9, (5.0, 0.0, -3.0), 1.0)
        filters = [Sparse(7, filter="walk")]
        for _ in range(60):
            before = session.step(velocity=[(0.0, 1.2), (1.0, 0.0)], sparse=filters)
        restarted.stop()
        restarted.start()
        after = session.step()
        assert session.reopened == 1
        assert after.characters.tolist() == [7, 9]
        np.testing.assert_allclose(after.root[:, :3], before.root[:, :3], atol=0.1)
        for _ in range(120):
            after = session.step()
        way = after.root[:, :3] - before.root[:, :3]
        assert way[0, 2] > 1.5 > abs(way[0, 0])
        assert way[1, 0] > 1.2 > abs(way[1, 2])
        assert session._opening_again().characters[0].filter == "walk"
        assert session._opening_again().characters[1].stitcher == "none"


def test_a_paced_session_goes_on_too(restarted: Restarted, connect: Callable[[str], Any]) -> None:
    """`frames` yields on after the server is back; the control still holds."""
    with (
        connect(restarted.address) as client,
        client.open_session(pacing=Pacing.SERVER, reconnect_s=DEADLINE_S) as session,
    ):
        session.control(velocity=(0.0, 1.3))
        frames = session.frames()
        for _ in range(30):
            before = next(frames)
        restarted.stop()
        restarted.start()
        for frame in frames:
            if session.reopened and frame.frame >= 60:
                break
        assert frame.root[0, 2] > before.root[0, 2] + 0.5


def test_without_leave_a_lost_session_is_lost(
    restarted: Restarted, connect: Callable[[str], Any]
) -> None:
    """By default nothing is opened again behind the caller's back."""
    with connect(restarted.address) as client, client.open_session() as session:
        session.step()
        restarted.stop()
        restarted.start()
        with pytest.raises(UnavailableError):
            session.step()
        assert session.reopened == 0


def test_time_to_reconnect_runs_out(restarted: Restarted, connect: Callable[[str], Any]) -> None:
    """Where no server comes back, what was lost is raised."""
    with connect(restarted.address) as client, client.open_session(reconnect_s=0.3) as session:
        session.step()
        restarted.stop()
        with pytest.raises(UnavailableError):
            session.step()
        restarted.start()
