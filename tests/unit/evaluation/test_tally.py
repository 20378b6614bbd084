"""Tallies pool as ratios of sums and as histograms, and intervals come from whole units."""

import numpy as np
import pytest

from stridewire_engine.evaluation.tally import Mean, Percentile, from_data, interval, pool, ratio


def test_a_mean_leaves_nan_out_and_pools_by_frames() -> None:
    """Units of different length weigh by what was counted in them."""
    one = Mean.of(np.array([[1.0], [np.nan], [3.0]]))
    four = Mean.of(np.full((4, 1), 10.0))
    assert interval(one)[0] == 2.0
    assert interval(pool([one, four]))[0] == pytest.approx((1 + 3 + 40) / 6)


def test_nothing_counted_is_no_number() -> None:
    """A figure without a frame is NaN, not zero."""
    assert np.isnan(interval(Mean.of(np.full((3, 2), np.nan)))[0])
    assert np.isnan(interval(Percentile.of(np.full((3, 2), np.nan), 95.0, 0.0, 1.0))[0])


def test_a_percentile_is_right_to_a_bin(rng: np.random.Generator) -> None:
    """The histogram's percentile is numpy's to one bin, and stays so when pooled."""
    values = rng.random((500, 6))
    parts = [Percentile.of(values[:, :2], 95.0, 0.0, 1.0), Percentile.of(values[:, 2:], 95.0, 0, 1)]
    assert interval(pool(parts))[0] == pytest.approx(np.percentile(values, 95.0), abs=1 / 400)


def test_intervals_cover_the_truth_about_as_often_as_they_say() -> None:
    """Of 95 % intervals of the mean of 30 units, 85 to 100 % hold it."""
    rng = np.random.default_rng(5)
    hits = 0
    for trial in range(100):
        level = rng.normal(size=30)
        low, high = interval(Mean.of(level + rng.normal(size=(20, 30))), seed=trial)[1:]
        hits += low <= 0.0 <= high
    assert 85 <= hits <= 100


def test_a_paired_ratio_is_narrower_than_its_parts(rng: np.random.Generator) -> None:
    """What varies from unit to unit in both drops out of their ratio."""
    level = rng.uniform(1.0, 9.0, 40)
    above, below = Mean.of(2.0 * level[None]), Mean.of(level[None])
    assert ratio(above, below) == pytest.approx((2.0, 2.0, 2.0))


def test_json_keeps_everything(rng: np.random.Generator) -> None:
    """What is read back has the same figure and interval."""
    for figure in (
        Mean.of(rng.random((9, 4)), 3.0),
        Percentile.of(rng.random((9, 4)), 99.0, 0.0, 1.0),
    ):
        assert interval(from_data(figure.data())) == interval(figure)
