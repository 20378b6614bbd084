"""Explanations: what else fitted, and why nearer moments were not taken."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stridewire._messages import ExcludedMatch, Match
from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.matching.candidates import CandidateSet
from stridewire_engine.matching.search import NEIGHBOURHOOD_FRAMES, Found, Matcher


@dataclass(frozen=True)
class Exclusion:
    """A moment whose neighbourhood must not be chosen."""

    row: int
    why: str


def explain(
    matcher: Matcher,
    query: Floats,
    weights: Floats,
    exclusions: Sequence[Exclusion],
    k: int,
    candidates: CandidateSet,
) -> tuple[tuple[Match, ...], tuple[ExcludedMatch, ...]]:
    """Return the k best distinct moments, and the excluded ones better than the last of them.

    Args:
        matcher: Of the library.
        query: `(D,)` normalised features.
        weights: `(C,)`.
        exclusions: What must not be chosen, and why.
        k: Number of moments, no two of them in one neighbourhood.
        candidates: Rows that may be chosen.
    """
    # neighbours come together, so many more rows than k are ranked
    ask = min(len(candidates), 2 * NEIGHBOURHOOD_FRAMES * (k + len(exclusions) + 1))
    nothing = np.full((1, 1), -1)
    found = matcher.search(query[None], weights[None], nothing, ask, candidates)
    rows = found.rows[0][found.rows[0] >= 0]
    reasons = _reasons(matcher, rows, exclusions)
    matches: list[int] = []
    excluded: list[int] = []
    for i, row in enumerate(rows):
        chosen = excluded if reasons[i] else matches
        if not matcher.near(row, rows[chosen]).any():
            chosen.append(i)
        if len(matches) == k:
            break
    return (
        tuple(_match(matcher, found, i) for i in matches),
        tuple(ExcludedMatch(_match(matcher, found, i), reasons[i]) for i in excluded),
    )


def _reasons(matcher: Matcher, rows: Indices, exclusions: Sequence[Exclusion]) -> list[str]:
    reasons = [""] * len(rows)
    for exclusion in exclusions:
        for i in np.flatnonzero(matcher.near(rows, np.array(exclusion.row))):
            reasons[i] = reasons[i] or exclusion.why
    return reasons


def _match(matcher: Matcher, found: Found, i: int) -> Match:
    library = matcher.library
    row = int(found.rows[0, i])
    entry = library.clips[library.clip_of[row]]
    names = [channel.name for channel in matcher.schema.channels]
    return Match(
        entry.name,
        (row - entry.start) / library.frame_rate,
        library.tags_at(row),
        float(found.costs[0, i]),
        dict(zip(names, found.channel_costs[0, i].tolist(), strict=True)),
        float(matcher.bias[row]),
    )
