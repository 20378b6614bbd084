"""The search: exact under any weights, neighbours left out, ties to the lowest row."""

import numpy as np
import pytest

from stridewire_engine.library import Library
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.matching.search import NEIGHBOURHOOD_FRAMES, Matcher, typical_cost

NONE = -np.ones((1, 1), np.int64)


@pytest.fixture(scope="module")
def matcher(small_library: Library) -> Matcher:
    """Return the matcher of the small library."""
    return Matcher(small_library)


def brute_force(library: Library, query: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the exact cost of every row, infinite where it may not be chosen."""
    difference = library.features.astype(np.float64) - query
    costs = (difference**2 * weights[LOCOMOTION.channel_of]).sum(axis=1)
    return np.where(library.startable, costs, np.inf)


def random_queries(library: Library, rng: np.random.Generator, count: int) -> np.ndarray:
    """Return rows with noise of half a deviation, which lie off the data."""
    rows = rng.integers(len(library.features), size=count)
    return library.features[rows] + rng.normal(scale=0.5, size=(count, LOCOMOTION.dimensions))


@pytest.mark.parametrize("weighted", [False, True])
def test_equals_brute_force(
    small_library: Library, matcher: Matcher, rng: np.random.Generator, weighted: bool
) -> None:
    """On 1,000 queries, with the schema's and with random weights, the best row is the best row."""
    queries = random_queries(small_library, rng, 1000)
    weights = np.tile(LOCOMOTION.weights, (1000, 1))
    if weighted:
        weights *= 4.0 ** rng.uniform(-1, 1, weights.shape)
    found = matcher.search(queries, weights, np.tile(NONE, (1000, 1)))
    for query, w, row, cost in zip(
        queries, weights, found.rows[:, 0], found.costs[:, 0], strict=True
    ):
        costs = brute_force(small_library, query, w)
        assert row == costs.argmin()
        assert cost == pytest.approx(costs.min(), rel=1e-9)


def test_a_stored_row_finds_itself_at_no_cost(small_library: Library, matcher: Matcher) -> None:
    """A query that is a row of the library costs nothing there."""
    row = int(np.flatnonzero(small_library.startable)[100])
    found = matcher.search(small_library.features[[row]], LOCOMOTION.weights[None], NONE)
    assert found.costs[0, 0] == 0.0
    assert np.all(small_library.features[found.rows[0, 0]] == small_library.features[row])


def test_the_neighbourhood_of_excluded_rows_is_left_out(
    small_library: Library, matcher: Matcher
) -> None:
    """Nothing within a third of a second of an excluded row is found, and others are."""
    row = int(np.flatnonzero(small_library.startable)[100])
    query = small_library.features[[row]]
    found = matcher.search(query, LOCOMOTION.weights[None], np.array([[row]]), k=30)
    same = small_library.clip_of[found.rows[0]] == small_library.clip_of[row]
    assert np.all(np.abs(found.rows[0][same] - row) >= NEIGHBOURHOOD_FRAMES)
    assert np.all(np.isfinite(found.costs))


def test_excluding_many_asks_again_until_enough_are_found(
    small_library: Library, matcher: Matcher
) -> None:
    """With the best 40 moments excluded, k others are still found."""
    query = small_library.features[[500]]
    excluded = np.array([np.flatnonzero(small_library.startable)[np.arange(40) * 7]])
    found = matcher.search(query, LOCOMOTION.weights[None], excluded, k=50)
    assert np.all(found.rows >= 0)
    assert len(set(found.rows[0].tolist())) == 50


def test_more_than_there_are_gives_all_there_are(small_library: Library, matcher: Matcher) -> None:
    """Asking for more rows than may be chosen fills up with -1 and infinity."""
    everything = int(small_library.startable.sum())
    query = small_library.features[:1]
    found = matcher.search(query, LOCOMOTION.weights[None], NONE, k=everything)
    assert sorted(found.rows[0].tolist()) == np.flatnonzero(small_library.startable).tolist()
    assert np.all(np.diff(found.costs[0]) >= 0.0)


def test_channel_costs_add_up(
    small_library: Library, matcher: Matcher, rng: np.random.Generator
) -> None:
    """The costs by channel of a match are the whole of its cost."""
    queries = random_queries(small_library, rng, 20)
    weights = np.tile(LOCOMOTION.weights, (20, 1))
    found = matcher.search(queries, weights, np.tile(NONE, (20, 1)), k=3)
    assert np.allclose(found.channel_costs.sum(axis=-1), found.costs, rtol=1e-12)


def test_ties_go_to_the_lowest_row(small_library: Library) -> None:
    """Among rows of equal cost the lowest row comes first."""

    class Twice:
        """The same features twice over."""

        def __init__(self, library: Library) -> None:
            self.name = "twice"
            self.manifest = library.manifest
            self.features = np.tile(library.features[:200], (2, 1))
            self.startable = np.ones(400, np.bool_)
            self.root_yaw = np.zeros(400)
            self.grouping = None
            self.clip_of = np.repeat([0, 1], 200)

    matcher = Matcher(Twice(small_library))  # type: ignore[arg-type]
    query = small_library.features[150:151]
    for k in (1, 2):
        found = matcher.search(query, LOCOMOTION.weights[None], NONE, k=k)
        assert found.rows[0, 0] == min(found.rows[0])
        assert found.rows[0, 0] < 200


def test_results_do_not_depend_on_the_batch(
    small_library: Library, matcher: Matcher, rng: np.random.Generator
) -> None:
    """A query alone and among 63 others gives the same row and the same cost to the last bit."""
    queries = random_queries(small_library, rng, 64)
    weights = np.tile(LOCOMOTION.weights, (64, 1))
    together = matcher.search(queries, weights, np.tile(NONE, (64, 1)))
    for i in range(0, 64, 9):
        alone = matcher.search(queries[i : i + 1], weights[:1], NONE)
        assert alone.rows[0, 0] == together.rows[i, 0]
        assert alone.costs[0, 0] == together.costs[i, 0]


def test_only_startable_rows_are_candidates(small_library: Library, matcher: Matcher) -> None:
    """The rows that may be chosen are candidates and no others."""
    everything = matcher.candidates.everything
    assert np.array_equal(everything.rows, np.flatnonzero(small_library.startable))
    assert everything.is_exact


def test_typical_cost_is_the_median_of_the_nearest_other_moment(small_library: Library) -> None:
    """It stands in the manifest, is positive, and is what a plain loop over some rows finds."""
    library = small_library
    arguments = (LOCOMOTION, library.features, library.startable, library.clip_of)
    cost = typical_cost(*arguments)
    assert cost == library.manifest.schema["typical_cost"] > 0.0
    rows = np.flatnonzero(library.startable)
    rows = rows[np.linspace(0, len(rows) - 1, 1000).astype(int)]
    nearest = []
    for row in rows[::10]:
        costs = brute_force(library, library.features[row], LOCOMOTION.weights)
        near = np.abs(np.arange(len(costs)) - row) < NEIGHBOURHOOD_FRAMES
        costs[near & (library.clip_of == library.clip_of[row])] = np.inf
        nearest.append(costs.min())
    assert cost == pytest.approx(np.median(nearest), rel=0.5)
