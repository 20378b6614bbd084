"""Inverted lists: nearly always the best row, never fewer rows than there are."""

import numpy as np
import pytest

from stridewire_engine.library import Library
from stridewire_engine.library.library import StoredGrouping
from stridewire_engine.matching import candidates, proof
from stridewire_engine.matching.index import ExactIndex, augment_queries
from stridewire_engine.matching.inverted_lists import InvertedLists, group_rows, narrow
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.matching.search import Matcher

PROBES = 128


@pytest.fixture
def grouped(small_library: Library, monkeypatch: pytest.MonkeyPatch) -> Matcher:
    """Return a matcher of the small library that uses lists although it need not."""
    monkeypatch.setattr(candidates, "EXACT_ROWS", 500)
    library = Library.open(small_library.path)
    grouping = group_rows(library.features[library.startable])
    library.grouping = StoredGrouping(grouping.centroids, grouping.lists, PROBES)
    return Matcher(library)


def queries(matcher: Matcher, rng: np.random.Generator, count: int) -> np.ndarray:
    """Return rows with noise of half a deviation."""
    features = matcher.library.features
    rows = rng.integers(len(features), size=count)
    return features[rows] + rng.normal(scale=0.5, size=(count, features.shape[1]))


def weights(rng: np.random.Generator, count: int) -> np.ndarray:
    """Return weights of a quarter to four times the schema's."""
    return LOCOMOTION.weights * 4.0 ** rng.uniform(-1, 1, (count, len(LOCOMOTION.channels)))


def test_nearly_every_best_row_is_found(grouped: Matcher, rng: np.random.Generator) -> None:
    """Under random weights 99 of 100 best rows are found, and no cost is wrong."""
    assert not grouped.candidates.everything.is_exact
    asked, by = queries(grouped, rng, 500), weights(rng, 500)
    everything = grouped.candidates.everything
    found = grouped.look_up(asked, by, np.full((500, 1), -1), 1, everything)
    library = grouped.library
    rows = np.flatnonzero(library.startable)
    exact = ExactIndex(LOCOMOTION, library.features, grouped.bias, rows)
    best = exact.search(augment_queries(LOCOMOTION, asked, by), 1)
    lowest = grouped.costs(asked, by, best).sum(axis=-1)
    assert np.mean(found.costs <= lowest * (1.0 + 1e-6)) >= 0.99
    expected = grouped.costs(asked, by, found.rows).sum(axis=-1)
    np.testing.assert_allclose(found.costs, expected, rtol=1e-12)


@pytest.mark.parametrize("text", ["walk", "idle", "!walk", "walk | run | idle"])
def test_filters_are_obeyed(grouped: Matcher, rng: np.random.Generator, text: str) -> None:
    """With a filter only rows that satisfy it are found, whatever kind of index it got."""
    among = grouped.candidates.get(text, "filter")
    asked = queries(grouped, rng, 100)
    found = grouped.search(asked, weights(rng, 100), np.full((100, 1), -1), 5, among)
    assert among.satisfied[found.rows].all()
    assert np.isfinite(found.costs).all()


def test_never_fewer_than_there_are(grouped: Matcher, rng: np.random.Generator) -> None:
    """Asking for every row of a filter gives every row, however few lists are looked into."""
    grouped.candidates.look_into(1)
    among = grouped.candidates.get("run", "filter")
    asked = queries(grouped, rng, 2)
    found = grouped.search(asked, weights(rng, 2), np.full((2, 1), -1), len(among), among)
    assert np.array_equal(np.sort(found.rows, axis=1), np.tile(among.rows, (2, 1)))


def test_equal_filters_share_one_set(grouped: Matcher) -> None:
    """A filter is parsed and indexed once, spaces around it do not matter."""
    assert grouped.candidates.get("walk", "f") is grouped.candidates.get(" walk ", "f")
    assert grouped.candidates.get("  ", "f") is grouped.candidates.everything


def test_grouping_is_seeded(small_library: Library) -> None:
    """The same features give the same lists."""
    first, again = (group_rows(small_library.features) for _ in range(2))
    assert np.array_equal(first.lists, again.lists)
    assert np.array_equal(first.centroids, again.centroids)


def test_a_narrowed_grouping_has_the_means_of_what_is_left(
    small_library: Library, rng: np.random.Generator
) -> None:
    """Empty lists are gone, each centre is the mean of its rows."""
    features = small_library.features
    which = np.sort(rng.choice(len(features), 300, replace=False))
    narrowed = narrow(group_rows(features), features[which], which)
    assert set(narrowed.lists) == set(range(len(narrowed.centroids)))
    for number, centroid in enumerate(narrowed.centroids):
        assert np.allclose(
            centroid, features[which][narrowed.lists == number].mean(axis=0), atol=1e-5
        )


def test_a_bias_is_part_of_the_order(grouped: Matcher, rng: np.random.Generator) -> None:
    """Rows with a high bias are found after all others, by both kinds of index."""
    library = grouped.library
    rows = np.flatnonzero(library.startable)
    bias = np.zeros(len(library.features), np.float32)
    bias[rows[::2]] = 1e4
    grouping = library.grouping
    assert grouping is not None
    lists = InvertedLists(LOCOMOTION, library.features, bias, rows, grouping, 10_000)  # type: ignore[arg-type]
    exact = ExactIndex(LOCOMOTION, library.features, bias, rows)
    asked = augment_queries(LOCOMOTION, queries(grouped, rng, 20), weights(rng, 20))
    for index in (lists, exact):
        assert not bias[index.search(asked, 10)].any()


def test_the_proof_finds_the_worst_cell(grouped: Matcher, rng: np.random.Generator) -> None:
    """Looking into one list is measurably worse than what tuning finds; the report says so."""
    others = grouped.library.features[::7] + 0.1
    asked = proof.probe_queries(grouped, others, rng)
    grouped.candidates.look_into(1)
    hasty = min(cell.recall for cell in proof.prove(grouped, asked, rng))
    cells = proof.tune_probes(grouped, asked, rng)
    assert hasty < proof.LEAST_RECALL <= min(cell.recall for cell in cells)
    report = proof.report(grouped, cells)
    assert report["worst_cell"]["recall"] == min(cell.recall for cell in cells)
    assert report["index"] == "inverted lists"
    assert {cell.weights for cell in cells} == {"preset", "random", "one-zero"}


def test_a_scanned_library_says_that_it_is_exact(small_library: Library) -> None:
    """Where every row is looked at there is nothing to measure."""
    matcher = Matcher(small_library)
    assert small_library.manifest.schema["proof"]["index"] == "exact"
    assert proof.report(matcher, [])["rows"] == small_library.startable.sum()
