"""Driving: what is sent when, and that no missing or late frame is overlooked."""

import numpy as np
import pytest

from stridewire import Client
from stridewire._messages import Frame
from stridewire.driving import Run, drive
from stridewire.recording import Recording
from stridewire.scripts import script
from stridewire_engine.library import Library


@pytest.fixture
def run_of(small_library: Library) -> Run:
    """Return a second of two characters, as fast as frames come, in this process."""
    with (
        Client.in_process(small_library.path) as client,
        client.open_session(2) as session,
    ):
        return drive(
            session, lambda t: script("stop-and-go").controls(t, 2, 3), 1.0, realtime=False
        )


def test_every_step_is_driven(run_of: Run) -> None:
    """Sixty controls, sixty frames of even time, figures of the run."""
    figures = run_of.figures()
    assert (run_of.sent, len(run_of.recording), figures["frames"]) == (60, 60, 60)
    assert len(run_of.recording.clip(0, "a")) == 60
    assert figures["dropped_pct"] == 0.0
    assert figures["p50_ms"] <= figures["p99_ms"] <= figures["max_ms"]
    assert figures["transitions"] == pytest.approx(2 * figures["transitions_per_s"])


def test_wall_clock_speed_keeps_to_its_schedule(small_library: Library) -> None:
    """At wall-clock speed the echoed times are the scheduled ones, a period apart."""
    seen: list[Frame] = []
    with (
        Client.in_process(small_library.path) as client,
        client.open_session(1) as session,
    ):
        drive(
            session,
            lambda t: script("stroll").controls(t, 1),
            0.25,
            rate_hz=120.0,
            open_loop=False,
            watch=seen.append,
        )
    assert [frame.applied_step for frame in seen] == list(range(1, 31))
    np.testing.assert_allclose(np.diff([frame.client_time_s for frame in seen]), 1 / 120.0)


def test_missing_frames_are_late(run_of: Run) -> None:
    """Of 60 sent, 3 late and 12 missing: a quarter is late."""
    frames = run_of.recording._frames[:48]
    run = Run(Recording(run_of.recording._skeleton), 60.0, realtime=True, sent=60)
    for number, frame in enumerate(frames):
        run.take(frame, frame.client_time_s + (0.1 if number < 3 else 0.001))
    figures = run.figures()
    assert figures["late_pct"] == pytest.approx(25.0)
    assert figures["dropped_pct"] == pytest.approx(20.0)
    assert np.isclose(figures["max_ms"], 100.0, atol=1e-3)
