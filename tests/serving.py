"""A real server for tests: one event loop in a thread, a small synthetic library, free ports."""

import asyncio
import inspect
import threading
import time
from collections.abc import AsyncGenerator, Awaitable, Callable, Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple, TypeVar

import grpc
import pytest

from stridewire import AsyncClient, Client
from stridewire._messages import Frame, Limits, Step, StreamError
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub
from stridewire_engine.building import build_library
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session
from stridewire_server.server import AnimationServer
from stridewire_server.settings import ServerSettings

T = TypeVar("T")
Serve = Callable[..., str]
Stop = Callable[[], None]

KINDS = ("idle", "walk", "stroll")
"""Names of the synthetic clips that make the small library."""
DEADLINE_S = 20.0
"""Longest wait for what is expected to happen soon; generous, for slow machines."""


class Doors(NamedTuple):
    """Where a server listens, and what stops it."""

    grpc: str
    websocket: str
    stop: Stop


class HeldRuntime(Runtime):
    """Holds every tick of sessions of two characters until it is let go; notes who shared it."""

    def __init__(self, library: Library) -> None:
        super().__init__([library])
        self.shared: list[int] = []
        self.inside = threading.Event()
        self.go = threading.Event()

    def advance(
        self, due: Sequence[tuple[Session, Step | float]], level: int = 0
    ) -> list[tuple[Frame, StreamError | None]]:
        """Advance, later."""
        if len(due[0][0]) == 2:
            self.shared.append(len(due))
            self.inside.set()
            self.go.wait(DEADLINE_S)
        return super().advance(due, level)


class LoopThread:
    """One event loop for all servers of a run: gRPC's poller binds to the first one it sees."""

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()

    def call(self, work: Awaitable[T]) -> T:
        """Run something awaitable in the loop and wait for it."""

        async def run() -> T:
            return await work

        return asyncio.run_coroutine_threadsafe(run(), self._loop).result(DEADLINE_S)

    def stop(self) -> None:
        """End the loop."""
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(DEADLINE_S)
        self._loop.close()


class Awaited:
    """An object of asyncio as a blocking one: the loop's thread waits for each call."""

    def __init__(self, thread: LoopThread, target: Any) -> None:
        self._thread = thread
        self._target = target

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._target, name)
        if name == "_transport":
            return Awaited(self._thread, value)
        return self._blocking(value) if callable(value) else value

    def __enter__(self) -> "Awaited":
        return Awaited(self._thread, self._thread.call(self._target.__aenter__()))

    def __exit__(self, *error: Any) -> None:
        self._thread.call(self._target.__aexit__(*error))

    def _blocking(self, method: Callable[..., Any]) -> Callable[..., Any]:
        def call(*args: Any, **kwargs: Any) -> Any:
            result = method(*args, **kwargs)
            if inspect.isasyncgen(result):
                return self._iterate(result)
            if inspect.iscoroutine(result):
                return self._thread.call(result)
            return Awaited(self._thread, result)

        return call

    def _iterate(self, generator: AsyncGenerator[Any, None]) -> Iterator[Any]:
        while True:
            try:
                yield self._thread.call(anext(generator))
            except StopAsyncIteration:
                return


@pytest.fixture(scope="session")
def loop_thread() -> Iterator[LoopThread]:
    """Return the event loop in which servers run."""
    thread = LoopThread()
    yield thread
    thread.stop()


@pytest.fixture(scope="session")
def small_library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Return a library of the slower synthetic clips, built once a run."""
    folder = tmp_path_factory.getbasetemp() / "small-library"
    if folder.exists():
        return Library.open(folder)
    return build_library(
        [clip for clip in synthetic_clips() if clip.name.startswith(KINDS)],
        folder,
        name="small",
        synthetic=True,
        licence="Apache-2.0",
        credit="Generated for tests.",
        mirror=False,
    )


@pytest.fixture(scope="session")
def address(loop_thread: LoopThread, small_library: Library) -> Iterator[str]:
    """Return the address of a server that the whole run shares."""
    server, bound = _start(loop_thread, Runtime([small_library]), ServerSettings("127.0.0.1:0"))
    yield bound
    loop_thread.call(server.stop())


@pytest.fixture
def serve(loop_thread: LoopThread, small_library: Library) -> Iterator[Serve]:
    """Return a starter of servers of a test's own; `runtime` and limits can be given."""
    servers = []

    def start(runtime: Runtime | None = None, limits: Limits | None = None, **given: Any) -> str:
        runtime = runtime or Runtime([small_library], limits=limits)
        settings = ServerSettings("127.0.0.1:0", drain_s=0.2, **given)
        server, bound = _start(loop_thread, runtime, settings)
        servers.append(server)
        return bound

    yield start
    for server in servers:
        loop_thread.call(server.stop())


@pytest.fixture
def stopping(loop_thread: LoopThread, small_library: Library) -> Iterator[tuple[str, Stop]]:
    """Return the address of a server of a test's own, and what stops it."""
    settings = ServerSettings("127.0.0.1:0", drain_s=0.2)
    server, bound = _start(loop_thread, Runtime([small_library]), settings)
    stop = cache(lambda: loop_thread.call(server.stop()))
    yield bound, stop
    stop()


@pytest.fixture(scope="session")
def door(loop_thread: LoopThread, small_library: Library) -> Iterator[Doors]:
    """Return the doors of a server with both, which the whole run shares."""
    doors = _open_doors(loop_thread, Runtime([small_library]), drain_s=0.2)
    yield doors
    doors.stop()


@pytest.fixture
def own_door(loop_thread: LoopThread, small_library: Library) -> Iterator[Callable[..., Doors]]:
    """Return a starter of servers with both doors of a test's own; settings can be given."""
    opened = []

    def start(**given: Any) -> Doors:
        settings = {"drain_s": 0.2, **given}
        opened.append(_open_doors(loop_thread, Runtime([small_library]), **settings))
        return opened[-1]

    yield start
    for doors in opened:
        doors.stop()


@pytest.fixture
def client(address: str) -> Iterator[Client]:
    """Return a client of the shared server."""
    with Client(address, timeout_s=DEADLINE_S) as opened:
        yield opened


@pytest.fixture(params=["blocking", "asyncio", "in process", "in process, asyncio"])
def either(
    request: pytest.FixtureRequest, address: str, small_library: Library, loop_thread: LoopThread
) -> Iterator[Any]:
    """Return a client of each kind in turn, all used like the blocking one."""
    folder = str(small_library.path)
    make: dict[str, Callable[[], Any]] = {
        "blocking": lambda: Client(address, timeout_s=DEADLINE_S),
        "asyncio": lambda: Awaited(loop_thread, AsyncClient(address, timeout_s=DEADLINE_S)),
        "in process": lambda: Client.in_process(folder),
        "in process, asyncio": lambda: Awaited(loop_thread, AsyncClient.in_process(folder)),
    }
    with make[request.param]() as client:
        yield client


@pytest.fixture
def raw_stream(address: str) -> Iterator[Callable[..., list[pb.AnimateResponse]]]:
    """Return a caller of Animate with the plain stub: sends messages, half-closes, reads all."""
    with grpc.insecure_channel(address) as channel:
        animate = AnimationServiceStub(channel).Animate

        def call(*requests: pb.AnimateRequest) -> list[pb.AnimateResponse]:
            return list(animate(iter(requests), timeout=DEADLINE_S))

        yield call


def opening(characters: int = 1, **given: Any) -> pb.AnimateRequest:
    """Return an Open for characters with ids from 0."""
    specs = [pb.CharacterSpec(id=i) for i in range(characters)]
    return pb.AnimateRequest(open=pb.Open(characters=specs, **given))


def stepping(**given: Any) -> pb.AnimateRequest:
    """Return a Step of a 60th of a second."""
    return pb.AnimateRequest(step=pb.Step(**{"dt_s": 1.0 / 60.0, **given}))


def eventually(condition: Callable[[], bool], within_s: float = DEADLINE_S) -> bool:
    """Wait until a condition holds; false where it does not in time."""
    end = time.monotonic() + within_s
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


def _start(
    thread: LoopThread, runtime: Runtime, settings: ServerSettings
) -> tuple[AnimationServer, str]:
    async def start() -> tuple[AnimationServer, str]:
        server = AnimationServer(runtime, settings)
        return server, await server.start()

    return thread.call(start())


def _open_doors(thread: LoopThread, runtime: Runtime, **given: Any) -> Doors:
    settings = ServerSettings("127.0.0.1:0", websocket="127.0.0.1:0", **given)
    server, bound = _start(thread, runtime, settings)
    return Doors(bound, server.websocket_address, cache(lambda: thread.call(server.stop())))
