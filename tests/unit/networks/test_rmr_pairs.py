"""Pairs: other moments under the take's path, seams without a step, the same for the same seed."""

import numpy as np
import pytest

from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.networks.rmr.assembly import assemble, spring
from stridewire_engine.networks.rmr.pairs import LENGTHS, PairMaker, Pairs
from stridewire_engine.networks.rmr.takes import LOWER, Takes


@pytest.fixture(scope="module")
def takes() -> Takes:
    """Return synthetic walks and runs, mirrored."""
    return Takes.of(clip for clip in synthetic_clips() if len(clip) < 400)


@pytest.fixture(scope="module")
def pairs(takes: Takes) -> Pairs:
    """Return pairs of windows all along the takes."""
    return PairMaker(takes).make(takes.windows(60), np.random.default_rng(3))


def test_segments_are_other_moments(takes: Takes, pairs: Pairs) -> None:
    """What is set in is neither the take nor its mirrored copy around the same time."""
    own = takes.clip[pairs.truth] % takes.originals == takes.clip[pairs.rows] % takes.originals
    near = np.abs(takes.frame[pairs.truth] - takes.frame[pairs.rows]) < 40
    begun = np.cumsum(pairs.starts, axis=1) > 0
    assert len(pairs) > 50
    assert not (own & near)[begun].any()
    np.testing.assert_array_equal(pairs.rows[~begun], pairs.truth[~begun])


def test_segments_run_on_within_their_clips(takes: Takes, pairs: Pairs) -> None:
    """Between seams, which lie at multiples of ten, rows follow each other in one clip."""
    goes_on = ~pairs.starts[:, 1:]
    assert (np.diff(pairs.rows, axis=1)[goes_on] == 1).all()
    assert (np.diff(takes.clip[pairs.rows], axis=1)[goes_on] == 0).all()
    assert set(np.nonzero(pairs.starts)[1]) <= set(LENGTHS)
    assert set(pairs.starts.sum(axis=1)) == {1, 2}


def test_the_same_seed_makes_the_same_pairs(takes: Takes, pairs: Pairs) -> None:
    """All that is drawn comes from the generator."""
    again = PairMaker(takes).make(takes.windows(60), np.random.default_rng(3))
    np.testing.assert_array_equal(again.rows, pairs.rows)
    np.testing.assert_array_equal(again.help, pairs.help)


def test_the_path_is_the_takes(takes: Takes, pairs: Pairs) -> None:
    """Whatever is set in, the root goes where the take's goes; before a seam so do the feet."""
    made = assemble(takes, pairs)
    truth = np.linalg.norm(np.diff(takes.root[pairs.truth], axis=1), axis=-1)
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(made.plans.root, axis=1), axis=-1), truth, atol=1e-9
    )
    before = made.plans.since_first < 0
    np.testing.assert_allclose(made.sprung.toes[before], made.truth.toes[before], atol=1e-5)
    assert np.abs(made.clip.toes - made.truth.toes)[~before].mean() > 0.02


def test_springs_leave_no_step(takes: Takes, pairs: Pairs) -> None:
    """Over seams positions go on and so do velocities, as good as within takes."""
    hips = takes.hips[pairs.rows].astype(np.float64)
    turns = takes.rotations[pairs.rows][:, :, : len(LOWER)].astype(np.float64)
    shown, _ = spring(takes, pairs.rows, pairs.starts, hips, turns)
    n, t = np.nonzero(pairs.starts)

    def steps(values: np.ndarray) -> np.ndarray:
        second = values[n, t + 1] - 2 * values[n, t] + values[n, t - 1]
        return np.linalg.norm(second, axis=-1)

    assert np.percentile(steps(shown), 95) < 0.3 * np.percentile(steps(hips), 95)


def test_toes_a_frame_earlier_know_no_seam(takes: Takes, pairs: Pairs) -> None:
    """Within a clip `before` is the frame before; at a seam it is the coming clip's own."""
    made = assemble(takes, pairs)
    inside = ~pairs.starts[:, 1:]
    before, toes = made.before[:, 1:], made.clip.toes[:, :-1]
    np.testing.assert_allclose(before[inside], toes[inside])
    step = np.linalg.norm(made.clip.toes - made.before, axis=-1)
    assert step[pairs.starts].max() < 0.25
