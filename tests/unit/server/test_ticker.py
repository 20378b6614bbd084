"""The tick: what is asked of it happens in order, and a fault stays where it belongs."""

import asyncio
import threading
from typing import Any

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, Open, Pacing, Step
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session
from stridewire_server.metrics import Metrics
from stridewire_server.ticker import Ticker

DT = 1 / 60.0


def test_a_control_given_while_a_frame_waits_is_kept(small_library: Library) -> None:
    """A frame that was due before a control is made before it and does not undo it."""

    async def run() -> list[int]:
        return await _applied_steps(Ticker(Runtime([small_library], clock=lambda: 0.0), Metrics()))

    assert asyncio.run(run()) == [0, 5]


async def _applied_steps(ticker: Ticker) -> list[int]:
    """Ask for a frame, give a control while it waits for a tick, and ask for another frame."""
    opening = Open([CharacterSpec(0)], pacing=Pacing.SERVER)
    paced = await ticker.open(opening)
    released = threading.Event()
    blocked = asyncio.create_task(ticker.query(released.wait, 10.0))
    await asyncio.sleep(0)
    waiting = advanced(ticker, paced)
    control = asyncio.create_task(ticker.call(ticker.runtime.control, paced, Step(5)))
    await asyncio.sleep(0)
    released.set()
    await asyncio.gather(blocked, control)
    first = await waiting
    frames = [first, await advanced(ticker, paced)]
    ticker.shut_down()
    return [frame.applied_step for frame, _ in frames]


def advanced(ticker: Ticker, session: Session) -> "asyncio.Future[Any]":
    """Ask for a frame; return what will come of it."""
    answer: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
    ticker.advance(session, DT, answer.set_result)
    return answer


def test_a_fault_is_told_to_every_stream_of_its_tick(small_library: Library) -> None:
    """An exception of the runtime reaches all who waited, and the next tick works."""

    async def run() -> tuple[list[Any], Any]:
        runtime = Runtime([small_library], clock=lambda: 0.0)
        ticker = Ticker(runtime, Metrics())
        sessions = [await ticker.open(Open([CharacterSpec(0)])) for _ in range(2)]
        works, runtime.advance = runtime.advance, _fails  # type: ignore[method-assign]
        told = await asyncio.gather(*(advanced(ticker, session) for session in sessions))
        runtime.advance = works  # type: ignore[method-assign]
        return told, await advanced(ticker, sessions[0])

    told, after = asyncio.run(run())
    assert [str(error) for error in told] == ["broken", "broken"]
    assert after[0].frame == 1


def _fails(*_: object) -> Any:
    raise ValueError("broken")


def test_a_closed_session_is_not_advanced(small_library: Library) -> None:
    """A step that waits when its session closes is forgotten; its neighbour's is not."""

    async def run() -> tuple[bool, bool]:
        ticker = Ticker(Runtime([small_library], clock=lambda: 0.0), Metrics())
        gone, here = [await ticker.open(Open([CharacterSpec(0)])) for _ in range(2)]
        asked = [advanced(ticker, gone), advanced(ticker, here)]
        ticker.close_session(gone)
        await asked[1]
        return asked[0].done(), asked[1].done()

    assert asyncio.run(run()) == (False, True)


def test_a_step_is_overtaken_only_under_load(small_library: Library) -> None:
    """Rested, every step gets its frame; under strain a newer one takes over, no time is lost."""

    async def run(level: int) -> tuple[object, Any]:
        ticker = Ticker(Runtime([small_library], clock=lambda: 0.0), Metrics())
        ticker._strain.level = level
        session = await ticker.open(Open([CharacterSpec(0)]))
        answer: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        ticker.advance(session, Step(1, DT, facing_yaw=np.array([1.0])), answer.set_result)
        overtaken = ticker.overtake(session, Step(2, DT))
        return overtaken, (await answer)[0]

    overtaken, frame = asyncio.run(run(0))
    assert overtaken is False
    assert frame.applied_step == 1
    overtaken, frame = asyncio.run(run(2))
    assert overtaken is None
    assert frame.applied_step == 2
    assert frame.time_s == pytest.approx(2 * DT)


def test_a_query_that_is_given_up_keeps_its_turn(small_library: Library) -> None:
    """Nothing else is asked of the runtime until the query's thread is through."""

    async def run() -> list[str]:
        ticker = Ticker(Runtime([small_library], clock=lambda: 0.0), Metrics())
        released, order = threading.Event(), []

        def query() -> None:
            released.wait(10.0)
            order.append("query")

        asking = asyncio.create_task(ticker.query(query))
        await asyncio.sleep(0.01)
        asking.cancel()
        calling = asyncio.create_task(ticker.call(order.append, "call"))
        await asyncio.sleep(0.01)
        released.set()
        await calling
        return order

    assert asyncio.run(run()) == ["query", "call"]
