"""The critic finds what differs and nothing where nothing does; tuning keeps a true front."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.critic import (
    LEGS,
    WINDOW,
    Sample,
    Windows,
    captured_sample,
    columns_of,
    dimensions,
    judge,
    quiet_windows,
    seam_windows,
    stream_sample,
)
from stridewire_engine.evaluation.streaming import Seams, Stream
from stridewire_engine.evaluation.tuning import Candidate, Trial, decide, front
from stridewire_engine.runtime import TickSettings

pytest.importorskip("sklearn")


def sets(shift: float) -> tuple[Sample, ...]:
    """Return four samples of 30 takes: seams and captured, to train on and to quote."""
    rng = np.random.default_rng(1)
    takes = np.arange(300) // 10

    def draw(offset: float) -> Sample:
        return Sample(rng.normal(offset, 1.0, (300, 90)).astype(np.float32), takes)

    return draw(shift), draw(0.0), draw(shift), draw(0.0)


def test_equal_motion_cannot_be_told() -> None:
    """Windows of one distribution give an AUC of about a half."""
    verdict = judge(*sets(0.0))
    assert 0.4 < verdict.auc < 0.6
    assert verdict.low < 0.5 < verdict.high


def test_shifted_motion_is_told() -> None:
    """A shift of a fifth of a deviation in every feature is plain to see."""
    verdict = judge(*sets(0.3))
    assert verdict.auc > 0.9
    assert sorted(verdict.surest.tolist()) == list(range(300))


def test_alike_windows_of_a_take_widen_the_interval() -> None:
    """With three takes instead of thirty the same scores are worth less."""
    many = sets(0.1)
    few = [sample._replace(takes=sample.takes % 3) for sample in many]
    wide, narrow = judge(*few), judge(*many)
    assert wide.auc == pytest.approx(narrow.auc)
    assert wide.high - wide.low != pytest.approx(narrow.high - narrow.low, rel=0.05)


def test_windows_lie_around_seams(replay: Callable[[str], Stream], captured: Captured) -> None:
    """A window has the transition in its middle; features are finite, one row a window."""
    stream = replay("walk-1.4")
    seams = Seams(np.array([5, 40]), np.array([0, 0]), np.array([0, 0]))
    found = seam_windows(replace(stream, seams=seams))
    assert found.frame.tolist() == [40 - WINDOW // 2]
    sample = stream_sample(stream, captured, found)
    assert sample.features.shape == (1, dimensions(captured))
    assert np.isfinite(sample.features).all()


def test_quiet_windows_hold_no_transition(replay: Callable[[str], Stream]) -> None:
    """After a transition at frame 45 the windows from 30 and, still near it, from 60 are left."""
    stream = replay("walk-1.4")
    since = stream.since.copy()
    since[45:, 0] = np.arange(len(since) - 45)
    frames = quiet_windows(replace(stream, since=since)).frame
    assert 0 in frames
    assert 30 not in frames
    assert all(frame < 16 or frame >= 55 for frame in frames)


def test_a_clip_shown_untouched_is_the_captured_window(
    replay: Callable[[str], Stream], captured: Captured
) -> None:
    """The features of streamed and captured windows of the same rows are equal."""
    stream = replay("walk-1.4")
    streamed = stream_sample(stream, captured, Windows(np.array([10]), np.array([0])))
    source = captured_sample(captured, stream.rows[10])
    assert np.allclose(streamed.features, source.features, atol=1e-2)
    assert streamed.takes.tolist() == source.takes.tolist()


def test_legs_are_legs(captured: Captured) -> None:
    """Four joints a side make eight of the skeleton's joints."""
    share = len(columns_of(captured, LEGS)) / dimensions(captured)
    assert share == pytest.approx(8 / len(captured.library.skeleton))


def test_the_front_holds_whom_nobody_beats() -> None:
    """Of four trials one is beaten in both objectives and is not on the front."""
    trials = [
        Trial(Candidate(TickSettings()), f, e, {}) for f, e in ((1, 4), (2, 2), (4, 1), (3, 3))
    ]
    assert [(t.flaws, t.following_error_m) for t in front(trials)] == [(4, 1), (2, 2), (1, 4)]


def test_the_decision_weighs_both_objectives_against_the_defaults() -> None:
    """One that halves the error at a tenth more flaws is chosen; one that is worse never is."""
    begin, better, worse = (
        Trial(Candidate(TickSettings()), f, e, {}) for f, e in ((2.0, 1.0), (2.2, 0.5), (2.1, 1.0))
    )
    assert decide([better, worse], begin) is better
    assert decide([worse], begin) is begin
