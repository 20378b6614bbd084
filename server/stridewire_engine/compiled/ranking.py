"""Ranking for kernels: the cheapest allowed candidate of each query, exactly.

The counterpart of `Matcher._rank` for one row a query: float64, ties to the lowest row.
"""

import math

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.compiled import kernel


@kernel
def rank(
    features: Floats,
    channel_of: Indices,
    bias: Floats,
    clip_of: Indices,
    neighbourhood: int,
    queries: Floats,
    weights: Floats,
    candidates: Indices,
    excluded: Indices,
    rows: Indices,
    costs: Floats,
    channel_costs: Floats,
) -> None:
    """Write the best of the candidates.

    Args:
        features: `(F, D)` of the library, normalised.
        channel_of: `(D,)` channel of each number.
        bias: `(F,)` cost that rows carry.
        clip_of: `(F,)`.
        neighbourhood: Rows nearer than this to an excluded one of their clip are left out.
        queries: `(N, D)`.
        weights: `(N, C)`.
        candidates: `(N, K)` rows; negative for none.
        excluded: `(N, E)` rows; negative for none.
        rows: `(N, 1)` out; -1 where nothing is allowed.
        costs: `(N, 1)` out; infinite there.
        channel_costs: `(N, 1, C)` out.
    """
    for i in range(len(queries)):
        best, at = math.inf, -1
        for j in range(candidates.shape[1]):
            row = candidates[i, j]
            if row < 0 or _is_excluded(clip_of, neighbourhood, row, excluded, i):
                continue
            cost = _cost(features, channel_of, queries, weights, i, row) + bias[row]
            if cost < best or (cost == best and row < at):
                best, at = cost, row
        rows[i, 0], costs[i, 0] = at, best
        for channel in range(weights.shape[1]):
            channel_costs[i, 0, channel] = 0.0
        if at >= 0:
            for d in range(queries.shape[1]):
                off = features[at, d] - queries[i, d]
                channel_costs[i, 0, channel_of[d]] += off * off
            for channel in range(weights.shape[1]):
                channel_costs[i, 0, channel] *= weights[i, channel]


@kernel
def _is_excluded(
    clip_of: Indices, neighbourhood: int, row: int, excluded: Indices, query: int
) -> bool:
    for e in range(excluded.shape[1]):
        other = excluded[query, e]
        if other >= 0 and abs(row - other) < neighbourhood and clip_of[row] == clip_of[other]:
            return True
    return False


@kernel
def _cost(
    features: Floats, channel_of: Indices, queries: Floats, weights: Floats, query: int, row: int
) -> float:
    """Return the weighted sum of squares, channel after channel as numpy adds it."""
    total, part, channel = 0.0, 0.0, channel_of[0]
    for d in range(queries.shape[1]):
        if channel_of[d] != channel:
            total += part * weights[query, channel]
            part, channel = 0.0, channel_of[d]
        off = features[row, d] - queries[query, d]
        part += off * off
    return float(total + part * weights[query, channel])
