"""Figures of whole streams: the capture itself is flawless, three cheats each lose somewhere."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from stridewire.motion.clip import Pose
from stridewire_engine.evaluation.captured import TOES, Captured
from stridewire_engine.evaluation.figures import Figures, Judged
from stridewire_engine.evaluation.streaming import Seams, Stream
from stridewire_engine.evaluation.tally import interval

WALK = "walk-1.4"
Replay = Callable[[str], Stream]


def value(figures: Figures, name: str) -> float:
    """Return a figure without its interval."""
    return interval(figures[name])[0]


def judged(stream: Stream, captured: Captured) -> tuple[Figures, Figures]:
    """Return the figures of a stream and of the capture it played."""
    mask = np.ones(stream.since.shape, bool)
    found = Judged(stream, captured)
    return found.streamed(mask), found.captured(mask)


def test_the_capture_itself_measures_as_the_capture(captured: Captured, replay: Replay) -> None:
    """A clip that is shown untouched has its own figures, jerk ratio 1, no lag, no jump."""
    streamed, source = judged(replay(WALK), captured)
    for name in ("sliding_a_cm_s", "sliding_b_cm_s", "sliding_c_cm_s", "float_cm"):
        assert value(streamed, name) == pytest.approx(value(source, name), abs=0.05)
    assert value(streamed, "jerk_ratio") == pytest.approx(1.0, abs=0.02)
    assert value(streamed, "clip_lag_cm") == pytest.approx(0.0, abs=0.01)
    assert value(streamed, "following_error_m") == pytest.approx(0.0, abs=0.03)
    assert value(streamed, "knee_extension_p99") <= value(source, "knee_extension_p99") + 0.001


def test_a_floating_character_floats(captured: Captured, replay: Replay) -> None:
    """Ten centimetres up, A has nothing to count, but float tells."""
    stream = replay(WALK)
    high = replace(stream, positions=stream.positions + np.array([0.0, 0.1, 0.0]))
    streamed, source = judged(high, captured)
    assert np.isnan(value(streamed, "sliding_a_cm_s"))
    assert value(streamed, "float_cm") > value(source, "float_cm") + 5.0


def test_a_frozen_character_slides_or_does_not_follow(captured: Captured, replay: Replay) -> None:
    """One that stands still has no sliding and no jerk, but goes nowhere."""
    stream = replay(WALK)
    first = Pose(*(np.broadcast_to(a[:1], a.shape) for a in vars(stream.pose).values()))
    still = np.broadcast_to(stream.positions[:1], stream.positions.shape)
    streamed, _ = judged(replace(stream, pose=first, positions=still), captured)
    assert value(streamed, "sliding_c_cm_s") == 0.0
    assert value(streamed, "jerk_ratio") == pytest.approx(0.0, abs=1e-6)
    assert value(streamed, "following_error_m") > 0.5
    assert value(streamed, "clip_lag_cm") > 10.0


def test_glued_feet_leave_the_clip(captured: Captured, replay: Replay) -> None:
    """Toes nailed to the ground never slide, but stay away from the clip's."""
    stream = replay(WALK)
    feet = captured.library.skeleton.indices((*TOES, "LeftFoot", "RightFoot"))
    positions = stream.positions.copy()
    positions[:, :, feet] = positions[:1, :, feet]
    streamed, _ = judged(replace(stream, positions=positions), captured)
    assert value(streamed, "sliding_c_cm_s") == 0.0
    assert value(streamed, "clip_lag_cm") > 10.0


def test_known_sliding_is_found_under_the_labels(captured: Captured, replay: Replay) -> None:
    """A whole body that drifts sideways at 30 cm/s slides by at least that, less its own noise."""
    stream = replay("idle-1")
    drift = np.arange(len(stream.positions))[:, None, None, None] / 60.0 * (0.3, 0.0, 0.0)
    streamed, source = judged(replace(stream, positions=stream.positions + drift), captured)
    assert value(streamed, "sliding_c_cm_s") == pytest.approx(
        30.0, abs=value(source, "sliding_c_cm_s") + 0.1
    )
    assert value(streamed, "skating_pct") == pytest.approx(100.0)


def test_a_transition_is_refined_if_it_was_guided_for_eight_frames(
    captured: Captured, replay: Replay
) -> None:
    """Of five: one guided, one cut off after seven frames, one not guided, two more guided."""
    stream = replay(WALK)
    frames = np.array([20, 40, 47, 80, 100])
    since = np.full(stream.since.shape, 1000)
    for frame in frames:
        since[frame:, 0] = np.arange(len(since) - frame)
    led = np.ones(since.shape, bool)
    led[47:80] = False
    seams = Seams(frames, np.zeros(5, int), stream.rows[frames - 1, 0])
    streamed, _ = judged(replace(stream, since=since, refined=led, seams=seams), captured)
    assert value(streamed, "refined_pct") == pytest.approx(60.0)
    assert np.isnan(value(judged(stream, captured)[0], "refined_pct"))
