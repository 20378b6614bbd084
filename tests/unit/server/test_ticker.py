"""The tick's thread: what is asked of it happens in order."""

import asyncio
import threading

from stridewire._messages import CharacterSpec, Open, Pacing, Step
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_server.ticker import Ticker

DT = 1 / 60.0


def test_a_control_given_while_a_frame_waits_is_kept(small_library: Library) -> None:
    """A frame that was due before a control is made after it, tells it, and does not undo it."""
    newest = asyncio.run(_applied_steps(Ticker(Runtime([small_library], clock=lambda: 0.0))))
    assert newest == [5, 5]


async def _applied_steps(ticker: Ticker) -> list[int]:
    """Ask for a frame, give a control while it waits for a tick, and ask for another frame."""
    opening = Open([CharacterSpec(0)], pacing=Pacing.SERVER)
    busy, paced = [await ticker.open(opening) for _ in range(2)]
    released = threading.Event()
    blocked = asyncio.create_task(ticker.call(released.wait, 10.0))
    first = asyncio.create_task(ticker.advance(busy, DT))
    await asyncio.sleep(0)
    waiting = asyncio.create_task(ticker.advance(paced, DT))
    await asyncio.sleep(0)
    control = asyncio.create_task(ticker.call(ticker.runtime.control, paced, Step(5)))
    await asyncio.sleep(0)
    released.set()
    await asyncio.gather(blocked, first, control)
    frames = [await waiting, await ticker.advance(paced, DT)]
    ticker.shut_down()
    return [frame.applied_step for frame, _ in frames]
