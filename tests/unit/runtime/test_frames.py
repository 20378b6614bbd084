"""Frames: counters, flags, events, and rows that are used again."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import (
    Detail,
    Open,
    Step,
    Transition,
)
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from unit.runtime.conftest import DT, one, opening

NAN = float("nan")


def test_frames_count_and_echo(runtime: Runtime) -> None:
    """Frames number from 1 and carry the step and the caller's clock."""
    session = runtime.open(opening(1))
    for i in range(1, 4):
        frame, _ = one(runtime, session, Step(100 + i, DT, client_time_s=5.5 * i))
        assert (frame.frame, frame.applied_step, frame.client_time_s) == (i, 100 + i, 5.5 * i)
    assert frame.time_s == pytest.approx(3 * DT)


def test_violations_are_listed_up_to_a_hundred(runtime: Runtime) -> None:
    """A thousand bad rows give a hundred violations and the number of the others."""
    session = runtime.open(opening(600))
    ((_, error),) = runtime.advance([(session, Step(1, DT, velocity_xz=np.full((600, 2), NAN)))])
    assert error is not None
    assert (len(error.violations), error.more) == (100, 1100)


def test_detail_none_sends_no_events(runtime: Runtime) -> None:
    """Without detail there are no events and no simulated roots; with events, no costs."""
    quiet = runtime.open(opening(1, detail=Detail.NONE))
    frame, _ = one(runtime, quiet, Step(1, DT))
    assert not frame.events
    assert frame.simulated_root is None
    plain = runtime.open(opening(1, detail=Detail.EVENTS))
    frame, _ = one(runtime, plain, Step(1, DT))
    start = next(event for event in frame.events if isinstance(event, Transition))
    assert (start.cost, start.channels) == (0.0, {})


def test_a_session_paced_by_a_clock_holds_its_controls(runtime: Runtime) -> None:
    """Controls given apart from the tick hold for every following one."""
    session = runtime.open(opening(1))
    assert runtime.control(session, Step(5, velocity_xz=[[0.0, 1.4]], client_time_s=2.0)) is None
    for _ in range(180):
        frame, _ = one(runtime, session, DT)
    assert (frame.applied_step, frame.client_time_s) == (5, 2.0)
    assert frame.root[0, 2] > 1.5


def test_rows_are_used_again(small_library: Library) -> None:
    """Opening and closing sessions a hundred times does not grow the crowd."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    keep = runtime.open(opening(3))
    for _ in range(100):
        session = runtime.open(opening(5))
        one(runtime, session, Step(1, DT))
        runtime.close(session)
    assert len(keep.crowd.state) <= 16
    one(runtime, keep, Step(1, DT))


def test_open_is_copied_not_kept(runtime: Runtime) -> None:
    """A different seed staggers the searches differently, the same one alike."""
    clocks = []
    for seed in (1, 1, 2):
        session = runtime.open(replace(opening(4), seed=seed))
        clocks.append(session.crowd.state.stagger[session.rows].tolist())
    assert clocks[0] == clocks[1] != clocks[2]
    assert isinstance(opening(1), Open)
