"""The outbox: credits, the one-slot mailbox, errors first, nothing unbounded."""

import asyncio
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from stridewire._errors import Violation
from stridewire._messages import Frame, Notice, StreamError
from stridewire_server.streaming.outbox import (
    MAX_WAITING_ERRORS,
    WINDOW_WITHOUT_CREDITS,
    Outbox,
)

MakeFrame = Callable[[int], Frame]
Drain = Callable[[Outbox], list[object]]


@pytest.fixture
def frame() -> MakeFrame:
    """Return a maker of frames of one character by number."""

    def make(number: int) -> Frame:
        none = np.zeros(1, np.uint32)
        return Frame(
            number,
            number,
            number / 60.0,
            0.0,
            none,
            np.zeros((1, 7)),
            np.zeros((1, 4)),
            np.zeros((1, 3)),
            np.zeros((1, 1, 4)),
            none,
            np.zeros((1, 2, 3)),
            none,
        )

    return make


@pytest.fixture
def drain() -> Iterator[Drain]:
    """Return a taker of whatever can be taken without waiting, in one event loop."""

    async def take_all(outbox: Outbox) -> list[object]:
        taken: list[object] = []
        while True:
            try:
                taken.append(await asyncio.wait_for(outbox.take(), 0.01))
            except TimeoutError:
                return taken

    with asyncio.Runner() as runner:
        yield lambda outbox: runner.run(take_all(outbox))


def numbers(taken: list[object]) -> list[tuple[int, int]]:
    """Return numbers and drop counts of frames."""
    return [(frame.frame, frame.dropped) for frame in taken if isinstance(frame, Frame)]


def test_frames_within_the_credits_are_all_sent(frame: MakeFrame, drain: Drain) -> None:
    """A burst that fits loses nothing, even before anything was written."""
    outbox = Outbox(5)
    for number in range(1, 6):
        outbox.offer(frame(number))
    assert numbers(drain(outbox)) == [(n, 0) for n in range(1, 6)]


def test_beyond_the_credits_only_the_newest_waits(frame: MakeFrame, drain: Drain) -> None:
    """Ten thousand frames for a reader that takes none: two are sent and one waits."""
    outbox = Outbox(2)
    for number in range(1, 10_001):
        outbox.offer(frame(number))
    assert numbers(drain(outbox)) == [(1, 0), (2, 0)]
    assert outbox.acknowledge(1) is None
    assert numbers(drain(outbox)) == [(10_000, 9_997)]
    outbox.offer(frame(10_001))
    assert numbers(drain(outbox)) == []
    assert outbox.acknowledge(10_000) is None
    assert numbers(drain(outbox)) == [(10_001, 0)]


def test_without_credits_a_stuck_writer_holds_a_bounded_number(
    frame: MakeFrame, drain: Drain
) -> None:
    """Frames pile up to the window while nobody takes them, then the newest wins."""
    outbox = Outbox(0)
    for number in range(1, 1001):
        outbox.offer(frame(number))
    taken = numbers(drain(outbox))
    assert len(taken) == WINDOW_WITHOUT_CREDITS + 1
    assert taken[-1] == (1000, 1000 - WINDOW_WITHOUT_CREDITS - 1)


def test_a_frame_that_was_not_sent_cannot_be_acknowledged(frame: MakeFrame, drain: Drain) -> None:
    """The future is refused and changes nothing; the past and the present are taken."""
    outbox = Outbox(1)
    outbox.offer(frame(1))
    outbox.offer(frame(2))
    wrong = outbox.acknowledge(1)
    assert wrong is not None
    assert wrong.field == "step.last_frame"
    assert numbers(drain(outbox)) == [(1, 0)]
    assert outbox.acknowledge(2) is not None
    assert numbers(drain(outbox)) == []
    assert outbox.acknowledge(0) is None
    assert outbox.acknowledge(1) is None
    assert numbers(drain(outbox)) == [(2, 0)]


def test_errors_overtake_frames(frame: MakeFrame, drain: Drain) -> None:
    """An error reaches the reader before the frame of its step."""
    outbox = Outbox(2)
    outbox.offer(frame(1))
    error = StreamError(1, (Violation("step.dt_s", "no"),))
    outbox.report(error)
    taken = drain(outbox)
    assert taken[0] is error
    assert numbers(taken) == [(1, 0)]


def test_errors_do_not_pile_up(drain: Drain) -> None:
    """A flood of bad steps is counted, not kept."""
    outbox = Outbox(1)
    for step in range(1000):
        outbox.report(StreamError(step, (Violation("step.dt_s", "no"),), more=2))
    taken = drain(outbox)
    assert len(taken) == MAX_WAITING_ERRORS
    last = taken[-1]
    assert isinstance(last, StreamError)
    told = sum(len(e.violations) + e.more for e in taken if isinstance(e, StreamError))
    assert told == 3000


def test_what_waits_is_sent_at_the_end(frame: MakeFrame) -> None:
    """After the end the mailbox is emptied, credits or not, and None comes last."""
    outbox = Outbox(1)
    notice = Notice(1, "bye")
    outbox.offer(frame(1))
    outbox.put(notice)
    outbox.offer(frame(2))
    outbox.finish()

    async def take() -> list[object]:
        return [await outbox.take() for _ in range(4)]

    taken = asyncio.run(take())
    assert taken[1] is notice
    assert taken[3] is None
    assert numbers(taken) == [(1, 0), (2, 0)]
