"""Boxes: the best row by bounds is the best row of all, whatever the weights and exclusions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stridewire_engine.library import Library
from stridewire_engine.matching.boxes import Boxes
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.matching.search import NEIGHBOURHOOD_FRAMES as NEAR
from stridewire_engine.matching.search import Matcher

CHANNELS, NUMBERS = len(LOCOMOTION.channels), LOCOMOTION.dimensions


def lowest(
    features: np.ndarray,
    bias: np.ndarray,
    clip_of: np.ndarray,
    rows: np.ndarray,
    query: np.ndarray,
    weights: np.ndarray,
    excluded: np.ndarray,
) -> tuple[int, float]:
    """Return the best allowed row and its cost after a look at every one, in float64."""
    squares = (features[rows].astype(np.float64) - query) ** 2
    costs = np.add.reduceat(squares, LOCOMOTION.starts, axis=1) @ weights + bias[rows]
    for other in excluded[excluded >= 0]:
        near = np.abs(rows - other) < NEAR
        costs[near & (clip_of[rows] == clip_of[other])] = np.inf
    at = int(np.argmin(costs))
    return (int(rows[at]), float(costs[at])) if np.isfinite(costs[at]) else (-1, np.inf)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 400),
    groups=st.integers(1, 60),
    spread=st.sampled_from([0.0, 0.1, 1.0, 50.0]),
)
def test_it_is_the_best_of_all(seed: int, count: int, groups: int, spread: float) -> None:
    """Any groups, weights of 0, biases, exclusions, ties: row and cost are brute force's."""
    rng = np.random.default_rng(seed)
    features = np.cumsum(rng.normal(size=(2 * count, NUMBERS)), axis=0).astype(np.float32)
    features[count:] = features[:count]
    clip_of = np.repeat([0, 1, 2], [count, count // 2, count - count // 2])
    bias = rng.choice(np.float32([0.0, 0.0, 3.0]), 2 * count)
    rows = np.flatnonzero(rng.random(2 * count) < 0.8)
    if not len(rows):
        return
    boxes = Boxes(LOCOMOTION, features, bias, clip_of, rows, rng.integers(0, groups, len(rows)))
    asked = features[rng.integers(2 * count, size=8)] + rng.normal(scale=spread, size=(8, NUMBERS))
    weights = rng.exponential(size=(8, CHANNELS)) * (rng.random((8, CHANNELS)) < 0.8)
    excluded = rng.integers(-1, 2 * count, (8, 3))
    found, costs, by_channel = boxes.best(asked, weights, excluded, NEAR)
    for i in range(8):
        row, cost = lowest(features, bias, clip_of, rows, asked[i], weights[i], excluded[i])
        assert costs[i, 0] == pytest.approx(cost, rel=1e-9, abs=1e-12)
        assert found[i, 0] == row
        if row >= 0:
            assert by_channel[i, 0].sum() + bias[row] == pytest.approx(cost, abs=1e-9)


def test_both_ways_of_the_search_agree(small_library: Library, rng: np.random.Generator) -> None:
    """On a library that is scanned, under filters and without, bounds change nothing."""
    library, matcher = small_library, Matcher(small_library)
    asked = library.features[rng.integers(len(library.features), size=200)].astype(np.float64)
    asked += rng.normal(scale=0.5, size=asked.shape)
    weights = LOCOMOTION.weights * 4.0 ** rng.uniform(-1, 1, (200, CHANNELS))
    excluded = rng.integers(-1, len(library.features), (200, 6))
    for text in ("", "walk", "idle | run"):
        among = matcher.candidates.get(text, "filter")
        assert among.is_exact
        found = matcher.search(asked, weights, excluded, 1, among)
        expected = matcher.look_up(asked, weights, excluded, 1, among)
        assert np.array_equal(found.rows, expected.rows)
        np.testing.assert_allclose(found.costs, expected.costs, rtol=1e-12)
        np.testing.assert_allclose(found.channel_costs, expected.channel_costs, rtol=1e-12)
