"""The tick: one thread runs the runtime, and all sessions that are due together share a call.

The runtime is not thread-safe, so that everything asked of it goes through this thread, in order.
Steps that arrive while a tick runs are gathered for the next one.
"""

import asyncio
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

from stridewire._messages import Frame, Open, Step, StreamError
from stridewire_engine.runtime import Runtime, Session

P = ParamSpec("P")
T = TypeVar("T")
Advanced = tuple[Frame, StreamError | None]


_FEW_SESSIONS = 4
_GATHER_S = 1 / 240
"""Ticks of more sessions than that begin at least so long after each other."""


@dataclass(frozen=True)
class _Due:
    session: Session
    step: Step | float
    answer: asyncio.Future[Advanced]


class Ticker:
    """Runs a runtime in a thread of its own; to be made and used in an event loop."""

    def __init__(self, runtime: Runtime) -> None:
        self.runtime = runtime
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="stridewire-tick")
        self._due: list[_Due] = []
        self._ticking: asyncio.Task[None] | None = None
        self._query_turn = asyncio.Lock()
        self._sessions = 0
        self._began = 0.0

    async def open(self, message: Open) -> Session:
        """Open a session; one that is given up meanwhile is closed as soon as it is open."""
        opening = self._thread.submit(self.runtime.open, message)
        try:
            session = await asyncio.shield(asyncio.wrap_future(opening))
            self._sessions += 1
            return session
        except asyncio.CancelledError:
            opening.add_done_callback(self._close_opened)
            raise

    def close_session(self, session: Session) -> None:
        """Close a session after what was asked of it before; returns at once."""
        self._sessions -= 1
        self._thread.submit(self.runtime.close, session)

    async def advance(self, session: Session, step: Step | float) -> Advanced:
        """Advance a session in the next tick, by a step or by seconds."""
        answer: asyncio.Future[Advanced] = asyncio.get_running_loop().create_future()
        self._due.append(_Due(session, step, answer))
        if self._ticking is None:
            self._ticking = asyncio.create_task(self._tick())
        return await answer

    async def call(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call something short in the runtime's thread."""
        return await asyncio.wrap_future(self._thread.submit(function, *args, **kwargs))

    async def query(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call something longer in the runtime's thread; a tick waits for one query at most."""
        async with self._query_turn:
            return await self.call(function, *args, **kwargs)

    def shut_down(self) -> None:
        """End the thread after what was asked of it before."""
        self._thread.shutdown(wait=False)

    async def _tick(self) -> None:
        try:
            while self._due:
                await self._gather()
                due, self._due = [d for d in self._due if not d.answer.done()], []
                if due:
                    await self._advance_all(due)
        finally:
            self._ticking = None

    async def _gather(self) -> None:
        """Wait for more steps, where sessions are many: a tick of a few costs that of dozens."""
        now = asyncio.get_running_loop().time()
        if self._sessions > _FEW_SESSIONS and now < self._began + _GATHER_S:
            await asyncio.sleep(self._began + _GATHER_S - now)
            now = self._began + _GATHER_S
        self._began = now

    async def _advance_all(self, due: list[_Due]) -> None:
        try:
            advanced = await self.call(self.runtime.advance, [(d.session, d.step) for d in due])
        except Exception as error:  # a fault of the runtime: it belongs to every stream of the tick
            for d in due:
                if not d.answer.done():
                    d.answer.set_exception(error)
            return
        for d, result in zip(due, advanced, strict=True):
            if not d.answer.done():
                d.answer.set_result(result)

    def _close_opened(self, opening: Future[Session]) -> None:
        if not opening.cancelled() and opening.exception() is None:
            self._thread.submit(self.runtime.close, opening.result())
