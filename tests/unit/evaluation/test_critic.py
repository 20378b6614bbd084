"""The critic finds what differs and nothing where nothing does; tuning keeps a true front."""

import numpy as np
import pytest

from stridewire_engine.evaluation.critic import (
    WINDOW,
    Windows,
    judge,
    seam_windows,
    stream_features,
)
from stridewire_engine.evaluation.streaming import Stream
from stridewire_engine.evaluation.tuning import Candidate, Trial, front
from stridewire_engine.runtime import TickSettings

pytest.importorskip("sklearn")


def sets(shift: float) -> tuple[np.ndarray, ...]:
    """Return four sets of windows: seams and captured, to train on and to quote."""
    rng = np.random.default_rng(1)
    draw = lambda offset: rng.normal(offset, 1.0, (300, 90)).astype(np.float32)  # noqa: E731
    return draw(shift), draw(0.0), draw(shift), draw(0.0)


def windows() -> Windows:
    """Return places for 300 windows."""
    return Windows(np.arange(300), np.zeros(300, int))


def test_equal_motion_cannot_be_told() -> None:
    """Windows of one distribution give an AUC of about a half."""
    verdict = judge(*sets(0.0), windows())
    assert 0.4 < verdict.auc < 0.6
    assert verdict.low < 0.5 < verdict.high


def test_shifted_motion_is_told() -> None:
    """A shift of a fifth of a deviation in every feature is plain to see."""
    assert judge(*sets(0.3), windows()).auc > 0.9


def test_windows_lie_around_seams(replay: object) -> None:
    """A window has the transition in its middle; features are finite, one row a window."""
    from dataclasses import replace

    from stridewire_engine.evaluation.streaming import Seams

    stream: Stream = replay("walk-1.4")  # type: ignore[operator]
    seams = Seams(np.array([5, 40]), np.array([0, 0]), np.array([0, 0]))
    found = seam_windows(replace(stream, seams=seams))
    assert found.frame.tolist() == [40 - WINDOW // 2]
    features = stream_features(stream, found)
    assert features.shape[0] == 1
    assert np.isfinite(features).all()


def test_the_front_holds_whom_nobody_beats() -> None:
    """Of four trials one is beaten in both objectives and is not on the front."""
    trials = [
        Trial(Candidate(TickSettings()), f, e, {}) for f, e in ((1, 4), (2, 2), (4, 1), (3, 3))
    ]
    assert [(t.flaws, t.following_error_m) for t in front(trials)] == [(4, 1), (2, 2), (1, 4)]
