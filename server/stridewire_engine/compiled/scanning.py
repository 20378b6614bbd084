"""Scanning for kernels: the cheapest allowed row of each query, exactly, by bounds.

Rows are in groups, each with a box around it. A group whose box is further from the query than the
best row so far needs no look, under any weights; the nearest box is opened first. Bounds and the
rows of open boxes are costed in float32, column after column; what comes near the best is costed in
float64. So it finds what `Matcher.look_up` finds when that looks at everything.
"""

import math
from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.compiled import kernel

_SLACK, _LEAST = np.float32(1.0 - 1e-5), np.float32(1e-5)
"""By how much float32 may be wrong: a share, and an amount."""


class Boxed(NamedTuple):
    """Rows in G groups, and what is needed to cost them."""

    features: Floats
    """`(F, D)` of the library, normalised."""
    channel_of: Indices
    """`(D,)` channel of each number."""
    bias: Floats
    """`(F,)` cost that rows carry."""
    clip_of: Indices
    """`(F,)`."""
    rows: Indices
    """`(M,)` group after group."""
    starts: Indices
    """`(G + 1,)` where each group begins in `rows`."""
    columns: Floats
    """`(M D,)` float32: of each group its features, number after number."""
    biases: Floats
    """`(M,)` float32, as `rows`."""
    middle: Floats
    """`(D, G)` float32 of the boxes."""
    half: Floats
    """`(D, G)` float32: half of their sizes."""
    least_bias: Floats
    """`(G,)` float32."""
    largest: int
    """More rows no group has."""


@kernel
def scan(
    boxed: Boxed,
    neighbourhood: int,
    queries: Floats,
    weights: Floats,
    excluded: Indices,
    rows: Indices,
    costs: Floats,
    channel_costs: Floats,
) -> None:
    """Write the best row of each query; ties go to the lowest.

    Args:
        boxed: The rows.
        neighbourhood: Rows nearer than this to an excluded one of their clip are left out.
        queries: `(N, D)`.
        weights: `(N, C)`.
        excluded: `(N, E)` rows; negative for none.
        rows: `(N, 1)` out; -1 where nothing is allowed.
        costs: `(N, 1)` out; infinite there.
        channel_costs: `(N, 1, C)` out.
    """
    groups = len(boxed.least_bias)
    query = np.empty(queries.shape[1], np.float32)
    weight = np.empty(queries.shape[1], np.float32)
    bounds, near = np.empty(groups, np.float32), np.empty(boxed.largest, np.float32)
    left = np.empty(groups, np.int64)
    for i in range(len(queries)):
        for d in range(len(query)):
            query[d], weight[d] = queries[i, d], weights[i, boxed.channel_of[d]]
        _bound(boxed, query, weight, bounds)
        group = 0
        for g in range(1, groups):
            if bounds[g] < bounds[group]:
                group = g
        best, at = _open(
            boxed, neighbourhood, query, weight, queries, weights, excluded, i, group, near,
            math.inf, -1,
        )  # fmt: skip
        count = _heap(bounds, group, best, left)
        while count > 0 and bounds[left[0]] * _SLACK - _LEAST <= best:
            group = left[0]
            count -= 1
            left[0] = left[count]
            _sink(bounds, left, 0, count)
            best, at = _open(
                boxed, neighbourhood, query, weight, queries, weights, excluded, i, group, near,
                best, at,
            )  # fmt: skip
        rows[i, 0], costs[i, 0] = at, best
        _tell(boxed, queries, weights, i, at, channel_costs)


@kernel
def _bound(boxed: Boxed, query: Floats, weight: Floats, bounds: Floats) -> None:
    """Write the least that a row of each group may cost."""
    for g in range(len(bounds)):
        bounds[g] = boxed.least_bias[g]
    for d in range(len(query)):
        x, w = query[d], weight[d]
        for g in range(len(bounds)):
            off = abs(boxed.middle[d, g] - x) - boxed.half[d, g]
            off = off if off > np.float32(0.0) else np.float32(0.0)
            bounds[g] += w * off * off


@kernel
def _heap(bounds: Floats, opened: int, best: float, left: Indices) -> int:
    """Make a heap of the other groups that may hold something better, the nearest on top.

    Returns how many there are.
    """
    count = 0
    for g in range(len(bounds)):
        if g != opened and bounds[g] * _SLACK - _LEAST <= best:
            left[count] = g
            count += 1
    for k in range(count // 2 - 1, -1, -1):
        _sink(bounds, left, k, count)
    return count


@kernel
def _sink(bounds: Floats, left: Indices, at: int, count: int) -> None:
    """Let a group sink in the heap until both below it are no nearer."""
    group = left[at]
    while 2 * at + 1 < count:
        below = 2 * at + 1
        if below + 1 < count and bounds[left[below + 1]] < bounds[left[below]]:
            below += 1
        if bounds[left[below]] >= bounds[group]:
            break
        left[at] = left[below]
        at = below
    if at < count:
        left[at] = group


@kernel
def _open(
    boxed: Boxed,
    neighbourhood: int,
    query: Floats,
    weight: Floats,
    queries: Floats,
    weights: Floats,
    excluded: Indices,
    i: int,
    group: int,
    near: Floats,
    best: float,
    at: int,
) -> tuple[float, int]:
    """Return the best cost and row after a look at a group."""
    first = boxed.starts[group]
    count = boxed.starts[group + 1] - first
    for j in range(count):
        near[j] = boxed.biases[first + j]
    for d in range(len(query)):
        x, w, column = query[d], weight[d], first * len(query) + d * count
        for j in range(count):
            off = boxed.columns[column + j] - x
            near[j] += w * off * off
    for j in range(count):
        if near[j] * _SLACK - _LEAST <= best:
            row = boxed.rows[first + j]
            if not _is_excluded(boxed.clip_of, neighbourhood, row, excluded, i):
                cost = _cost(boxed, queries, weights, i, row) + boxed.bias[row]
                if cost < best or (cost == best and row < at):
                    best, at = cost, row
    return best, at


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
def _cost(boxed: Boxed, queries: Floats, weights: Floats, i: int, row: int) -> float:
    """Return the weighted sum of squares, channel after channel as numpy adds it."""
    total, part, channel = 0.0, 0.0, boxed.channel_of[0]
    for d in range(queries.shape[1]):
        if boxed.channel_of[d] != channel:
            total += part * weights[i, channel]
            part, channel = 0.0, boxed.channel_of[d]
        off = boxed.features[row, d] - queries[i, d]
        part += off * off
    return float(total + part * weights[i, channel])


@kernel
def _tell(
    boxed: Boxed, queries: Floats, weights: Floats, i: int, row: int, channel_costs: Floats
) -> None:
    """Write the cost of a row by channel; zeros for none."""
    for channel in range(weights.shape[1]):
        channel_costs[i, 0, channel] = 0.0
    if row < 0:
        return
    for d in range(queries.shape[1]):
        off = boxed.features[row, d] - queries[i, d]
        channel_costs[i, 0, boxed.channel_of[d]] += off * off
    for channel in range(weights.shape[1]):
        channel_costs[i, 0, channel] *= weights[i, channel]
