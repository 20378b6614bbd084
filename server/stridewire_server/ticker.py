"""The tick: all sessions that are due together share a call of the runtime, in the event loop.

The runtime is not thread-safe, so that everything asked of it takes turns, in order. Only queries
leave the loop's thread, one at a time, and nothing else is asked meanwhile. Steps that arrive while
a tick runs are gathered for the next one. Why no thread of its own: `docs/adr/0007`.
"""

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, Literal, ParamSpec, TypeVar

from stridewire._messages import Frame, Open, Step, StreamError
from stridewire_engine.runtime import Runtime, Session
from stridewire_server.metrics import Metrics
from stridewire_server.strain import Strain

P = ParamSpec("P")
T = TypeVar("T")
Advanced = tuple[Frame, StreamError | None]

_FEW_SESSIONS = 4
_GATHER_S = 1 / 160
"""Ticks of more sessions than that begin at least so long after each other."""


@dataclass(frozen=True)
class _Due:
    session: Session
    step: Step | float
    done: Callable[[Advanced | Exception], None]


class Ticker:
    """Runs a runtime; to be made and used in one event loop.

    Args:
        runtime: That is run.
        metrics: Told of each tick.
    """

    def __init__(self, runtime: Runtime, metrics: Metrics) -> None:
        self.runtime = runtime
        self.metrics = metrics
        self.strained: Callable[[bool], None] = lambda strained: None
        """Called when the runtime begins to give way to load, and when it need not any more."""
        self._queries = ThreadPoolExecutor(1, thread_name_prefix="stridewire-query")
        self._due: dict[str, _Due] = {}
        self._ticking: asyncio.Task[None] | None = None
        self._turn = asyncio.Lock()
        self._strain = Strain(time.monotonic(), time.thread_time())
        self._sessions = 0
        self._began = 0.0

    @property
    def level(self) -> int:
        """By how many levels the runtime gives way to load now."""
        return self._strain.level

    async def open(self, message: Open) -> Session:
        """Open a session."""
        session = await self.call(self.runtime.open, message)
        self._count(1)
        return session

    def close_session(self, session: Session) -> None:
        """Close a session; a step of it that waits is forgotten."""
        self._due.pop(session.id, None)
        self.runtime.close(session)
        self._count(-1)

    def advance(
        self, session: Session, step: Step | float, done: Callable[[Advanced | Exception], None]
    ) -> None:
        """Advance a session in the next tick, by a step or by seconds.

        Args:
            session: With no step that waits already.
            step: How.
            done: Called with what came of it, from the loop.
        """
        self._due[session.id] = _Due(session, step, done)
        if self._ticking is None:
            self._ticking = asyncio.create_task(self._tick())

    def overtake(self, session: Session, step: Step) -> StreamError | Literal[False] | None:
        """Let a step that waits be overtaken, where the runtime gives way to load.

        Its controls are taken over and its time is added to the newer step's: nothing is lost but
        a frame.

        Returns:
            What was wrong with the controls; False where nothing is overtaken.
        """
        waiting = self._due.get(session.id)
        if self._strain.level == 0 or self._turn.locked() or waiting is None:
            return False
        if isinstance(waiting.step, float):
            return False
        both = waiting.step.dt_s + step.dt_s
        if not 0.0 < both <= self.runtime.limits.max_dt_s:
            return False
        wrong = self.runtime.control(session, waiting.step)
        self._due[session.id] = replace(waiting, step=replace(step, dt_s=both))
        return wrong

    async def call(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call something short."""
        async with self._turn:
            return function(*args, **kwargs)

    async def query(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call something longer, in a thread; a tick waits for one query at most.

        It has its turn until it is done, also where nobody waits for it any more.
        """

        async def ask() -> T:
            async with self._turn:
                asked = self._queries.submit(function, *args, **kwargs)
                return await asyncio.wrap_future(asked)

        asking = asyncio.create_task(ask())
        asking.add_done_callback(_look_at)
        return await asyncio.shield(asking)

    def shut_down(self) -> None:
        """End the thread after what was asked of it before."""
        self._queries.shutdown(wait=False)

    async def _tick(self) -> None:
        try:
            while self._due:
                await self._gather()
                async with self._turn:
                    due, self._due = list(self._due.values()), {}
                    self._advance_all(due)
                # what arrived meanwhile is read before the next tick
                await asyncio.sleep(0)
        finally:
            self._ticking = None

    async def _gather(self) -> None:
        """Wait for more steps, where sessions are many: a tick of a few costs that of dozens."""
        now = time.monotonic()
        if self._sessions > _FEW_SESSIONS and now < self._began + _GATHER_S:
            await asyncio.sleep(self._began + _GATHER_S - now)
            now = self._began + _GATHER_S
        self._began = now

    def _advance_all(self, due: list[_Due]) -> None:
        if not due:
            return
        began, level = time.monotonic(), self._strain.level
        try:
            advanced = self.runtime.advance([(d.session, d.step) for d in due], level)
        except Exception as error:  # a fault of the runtime: it belongs to every stream of the tick
            for d in due:
                d.done(error)
            return
        self._note(began, level, advanced[0][0], len(due))
        for d, result in zip(due, advanced, strict=True):
            d.done(result)

    def _note(self, began: float, level: int, frame: Frame, frames: int) -> None:
        """Take note of a tick."""
        ended = time.monotonic()
        self._strain.note(ended, time.thread_time())
        self.metrics.ticked(ended - began, frames, level, frame.timings_ms)
        if bool(self._strain.level) != bool(level):
            self.strained(self._strain.level > 0)

    def _count(self, more: int) -> None:
        self._sessions += more
        self.metrics.populated(self._sessions, self.runtime.characters)


def _look_at(done: "asyncio.Task[Any]") -> None:
    """Look at an outcome, so that one which nobody waits for any more does not complain."""
    if not done.cancelled():
        done.exception()
