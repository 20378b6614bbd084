"""Proof: how often the inverted lists find the best row, and the cost when they do not.

Measured when a library is built, over queries that are not rows of it, under the schema's weights,
under random ones (a quarter to four times) and with one channel left out; without a filter and for
each tag. Sets that are scanned row by row are exact by construction and not measured.
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.matching.candidates import CandidateSet
from stridewire_engine.matching.index import ExactIndex, augment_queries
from stridewire_engine.matching.search import Matcher

QUERIES = 500
LEAST_RECALL = 0.996
"""A little above what is promised, since other queries than the tried ones will come."""
MOST_COST_RATIO = 1.01
_PROBES = (16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
_AMONG = 8
"""So many of the exact scan's float32 candidates are ranked in float64."""


@dataclass(frozen=True)
class Cell:
    """One kind of query under one filter."""

    weights: str
    """`preset`, `random` or `one-zero`."""
    filter: str
    rows: int
    recall: float
    """Share of queries whose best row was found."""
    cost_ratio: float
    """Cost of what was found to the lowest cost, summed over the queries."""


def probe_queries(matcher: Matcher, others: Floats, rng: np.random.Generator) -> Floats:
    """Return 500 queries `(Q, D)` that are not rows of the library.

    Half of them are moments of others; half join the pose of one moment to the trajectory of
    another, off the manifold of captured motion.

    Args:
        matcher: Of the library.
        others: `(M, D)` normalised features of motion that is not in the library.
        rng: Draws the moments.
    """
    half = QUERIES // 2
    known = others[rng.integers(len(others), size=half)].astype(np.float64)
    features = matcher.library.features
    mixed = features[rng.integers(len(features), size=QUERIES - half)].astype(np.float64)
    other = features[rng.integers(len(features), size=QUERIES - half)]
    for channel in matcher.schema.channels:
        if channel.is_trajectory:
            columns = matcher.schema.slice(channel)
            mixed[:, columns] = other[:, columns]
    return np.concatenate([known, mixed])


def prove(matcher: Matcher, queries: Floats, rng: np.random.Generator) -> list[Cell]:
    """Measure every kind of weights for all rows and for each tag whose rows are not scanned."""
    return [_measure(matcher, trial) for trial in _trials(matcher, queries, rng)]


def tune_probes(matcher: Matcher, queries: Floats, rng: np.random.Generator) -> list[Cell]:
    """Set the fewest lists to look into for which every cell is good enough; return the cells."""
    trials = [*_trials(matcher, queries, rng)]
    cells: list[Cell] = []
    for probes in _PROBES:
        matcher.candidates.look_into(probes)
        for among in {id(trial.among): trial.among for trial in trials}.values():
            among.look_into(probes)
        cells = [_measure(matcher, trial) for trial in trials]
        if all(c.recall >= LEAST_RECALL and c.cost_ratio <= MOST_COST_RATIO for c in cells):
            break
    return cells


def report(matcher: Matcher, cells: list[Cell]) -> dict[str, Any]:
    """Return what the manifest says: exact, or the worst cell among so many."""
    everything = matcher.candidates.everything
    if everything.is_exact:
        return {"index": "exact", "rows": len(everything)}
    worst = min(cells, key=lambda cell: (cell.recall, -cell.cost_ratio))
    return {
        "index": "inverted lists",
        "rows": len(everything),
        "probes": matcher.candidates.lists.probes if matcher.candidates.lists else 0,
        "queries_a_cell": QUERIES,
        "cells": len(cells),
        "worst_cell": asdict(worst),
        "worst_cost_ratio": max(cell.cost_ratio for cell in cells),
    }


@dataclass(frozen=True)
class _Trial:
    """Queries of one kind under one filter, and what there is to find."""

    name: str
    among: CandidateSet
    queries: Floats
    weights: Floats
    best_rows: Indices
    best_costs: Floats


def _trials(matcher: Matcher, queries: Floats, rng: np.random.Generator) -> Iterator[_Trial]:
    for among in (matcher.candidates.everything, *_large_tags(matcher)):
        if among.is_exact:
            continue
        features = matcher.library.features
        reference = ExactIndex(matcher.schema, features, matcher.bias, among.rows)
        for name, weights in _weightings(matcher, len(queries), rng):
            augmented = augment_queries(matcher.schema, queries, weights)
            nearest = reference.search(augmented, _AMONG)
            rows, costs = _best(matcher, queries, weights, nearest)
            yield _Trial(name, among, queries, weights, rows, costs)


def _large_tags(matcher: Matcher) -> Iterator[CandidateSet]:
    library = matcher.library
    for i, tag in enumerate(library.tag_names):
        holds = library.tag_bits >> np.uint64(i) & np.uint64(1) == 1
        if (holds & library.startable).any():
            yield matcher.candidates.get(tag, "tag")


def _weightings(
    matcher: Matcher, count: int, rng: np.random.Generator
) -> Iterator[tuple[str, Floats]]:
    preset = np.tile(matcher.schema.weights, (count, 1))
    yield "preset", preset
    yield "random", preset * 4.0 ** rng.uniform(-1.0, 1.0, preset.shape)
    left_out = rng.integers(preset.shape[1], size=(count, 1))
    yield "one-zero", preset * (np.arange(preset.shape[1]) != left_out)


def _measure(matcher: Matcher, trial: _Trial) -> Cell:
    nothing = np.full((len(trial.queries), 1), -1)
    found = matcher.look_up(trial.queries, trial.weights, nothing, 1, trial.among)
    costs, best = found.costs[:, 0], trial.best_costs
    # an equal cost is as good a find as the very row
    hit = (found.rows[:, 0] == trial.best_rows) | (costs <= best * (1.0 + 1e-9))
    ratio = float(costs.sum() / max(best.sum(), 1e-12))
    return Cell(trial.name, trial.among.text, len(trial.among), float(hit.mean()), ratio)


def _best(
    matcher: Matcher, queries: Floats, weights: Floats, rows: Indices
) -> tuple[Indices, Floats]:
    costs = matcher.costs(queries, weights, rows).sum(axis=-1) + matcher.bias[rows]
    first = np.lexsort((rows, costs), axis=-1)[:, :1]
    return (
        np.take_along_axis(rows, first, axis=1)[:, 0],
        np.take_along_axis(costs, first, axis=1)[:, 0],
    )
