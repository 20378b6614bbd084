"""The search: candidates from the index, exact costs, what is excluded left out."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine import compiled
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.matching.candidates import Candidates, CandidateSet
from stridewire_engine.matching.features import Normalisation
from stridewire_engine.matching.index import ExactIndex, augment_queries
from stridewire_engine.matching.schema import Schema

NEIGHBOURHOOD_FRAMES = 20
"""Rows nearer than this to an excluded one are the same moment, not another."""
_CANDIDATES = 64
"""More than a whole neighbourhood, so that one call nearly always suffices."""


@dataclass(frozen=True)
class Found:
    """The nearest allowed rows of N queries, best first.

    Where there are fewer than k, the row is -1 and the cost infinite.
    """

    rows: Indices
    """`(N, k)` rows of the library."""
    costs: Floats
    """`(N, k)` float64, the rows' bias included."""
    channel_costs: Floats
    """`(N, k, C)` float64; with the bias they add up to the costs."""

    @classmethod
    def nothing(cls, queries: int, channels: int, k: int = 1) -> "Found":
        """Return room for so many queries, nothing found yet."""
        shape = (queries, k)
        return cls(np.full(shape, -1), np.full(shape, np.inf), np.zeros((*shape, channels)))

    def put(self, which: Indices, part: "Found") -> None:
        """Write what was found for some of the queries."""
        self.rows[which] = part.rows
        self.costs[which] = part.costs
        self.channel_costs[which] = part.channel_costs


class Matcher:
    """Searches one library under its own schema."""

    def __init__(self, library: Library) -> None:
        """Index a library.

        Raises:
            LibraryError: If no frame may be chosen or the schema is not understood.
        """
        data = library.manifest.schema
        self.library = library
        self.schema = Schema.from_data(data)
        self.normalisation = Normalisation(
            np.array(data["mean"], np.float64), np.array(data["deviation"], np.float64)
        )
        self.typical_cost = float(data["typical_cost"])
        """Median cost of the nearest other moment: the unit in which biases are given."""
        if not library.startable.any():
            raise LibraryError(
                f"library {library.name!r} has no frame that a search may choose: every clip is "
                f"shorter than the horizon of {self.schema.horizon:g} s; add longer clips"
            )
        self.bias = row_bias(library, data.get("bias_by_tag", {}), self.typical_cost)
        """`(F,)` float32 cost that a row carries for its tags."""
        self.candidates = Candidates(library, self.schema, self.bias)

    def search(
        self,
        queries: Floats,
        weights: Floats,
        excluded: Indices,
        k: int = 1,
        candidates: CandidateSet | None = None,
    ) -> Found:
        """Find the nearest rows outside the neighbourhoods of excluded ones.

        Costs are exact, row by row in float64; ties go to the lowest row. A single row is the best
        there is, where it is found by bounds; see `look_up` otherwise.

        Args:
            queries: `(N, D)` normalised features.
            weights: `(N, C)` of the channels.
            excluded: `(N, E)` rows whose neighbourhood is left out; negative for none.
            k: Number of rows wanted.
            candidates: Rows that may be chosen; None for all.
        """
        among = candidates or self.candidates.everything
        if k == 1 and compiled.ENABLED and among.boxes is not None:
            return Found(*among.boxes.best(queries, weights, excluded, NEIGHBOURHOOD_FRAMES))
        return self.look_up(queries, weights, excluded, k, among)

    def look_up(
        self, queries: Floats, weights: Floats, excluded: Indices, k: int, among: CandidateSet
    ) -> Found:
        """Find the nearest rows among those that the index gives.

        If exclusions hide too many candidates, it is asked again for more, in the end for all.

        Args:
            queries: As for `search`.
            weights: As for `search`.
            excluded: As for `search`.
            k: Number of rows wanted.
            among: Rows that may be chosen.
        """
        ask = k - 1 + _CANDIDATES
        found = self._look_up(queries, weights, excluded, k, among, ask)
        for more, exhaustive in ((4 * ask, False), (16 * ask, True), (len(among), True)):
            lacking = np.flatnonzero(~np.isfinite(found.costs[:, -1]))
            if not len(lacking):
                break
            rest = queries[lacking], weights[lacking], excluded[lacking]
            found.put(lacking, self._look_up(*rest, k, among, more, exhaustive=exhaustive))
        return found

    def costs(self, queries: Floats, weights: Floats, rows: Indices) -> Floats:
        """Return exact costs by channel `(N, K, C)`, float64, of `rows` `(N, K)`."""
        difference = self.library.features[rows].astype(np.float64) - queries[:, None]
        squares = np.add.reduceat(difference * difference, self.schema.starts, axis=-1)
        return np.asarray(squares * weights[:, None])

    def near(self, rows: Indices, others: Indices) -> Flags:
        """Tell which rows are in the neighbourhood of others `(…)`, negative ones of nothing."""
        clip_of = self.library.clip_of
        close = np.abs(rows - others) < NEIGHBOURHOOD_FRAMES
        same = clip_of[rows] == clip_of[np.maximum(others, 0)]
        return np.asarray(close & same & (others >= 0))

    def _look_up(
        self,
        queries: Floats,
        weights: Floats,
        excluded: Indices,
        k: int,
        among: CandidateSet,
        ask: int,
        *,
        exhaustive: bool = False,
    ) -> Found:
        augmented = augment_queries(self.schema, queries, weights)
        rows = among.nearest(augmented, ask, exhaustive=exhaustive)
        allowed = rows >= 0
        for column in excluded.T:
            allowed &= ~self.near(rows, column[:, None])
        return self._rank(queries, weights, rows, allowed, k)

    def _rank(
        self, queries: Floats, weights: Floats, rows: Indices, allowed: Flags, k: int
    ) -> Found:
        by_channel = self.costs(queries, weights, rows)
        costs = np.where(allowed, by_channel.sum(axis=-1) + self.bias[rows], np.inf)
        order = np.lexsort((rows, costs), axis=-1)[:, :k]
        count = order.shape[1]
        found = Found.nothing(len(rows), len(self.schema.channels), k)
        best = np.take_along_axis(costs, order, axis=1)
        found.rows[:, :count] = np.where(
            np.isfinite(best), np.take_along_axis(rows, order, axis=1), -1
        )
        found.costs[:, :count] = best
        found.channel_costs[:, :count] = np.take_along_axis(by_channel, order[..., None], axis=1)
        return found


def row_bias(library: Library, bias_by_tag: Mapping[str, float], unit: float) -> Floats:
    """Return the cost `(F,)` that rows carry for their tags: positive avoids, negative favours.

    Args:
        library: With the tags.
        bias_by_tag: In units of `unit`; negative ones are made up for by a constant on all others,
            so that no cost is negative.
        unit: The library's typical cost.
    """
    bias = np.zeros(len(library.root_yaw), np.float32)
    for tag, amount in bias_by_tag.items():
        bit = np.uint64(1 << library.tag_names.index(tag))
        bias[library.tag_bits & bit != 0] += np.float32(amount * unit)
    return np.asarray(bias - min(bias.min(), np.float32(0.0)))


def typical_cost(schema: Schema, features: Floats, startable: Flags, clip_of: Indices) -> float:
    """Return the median cost of the nearest other moment, over up to 1,000 evenly spread rows.

    Args:
        schema: Its weights are used.
        features: `(F, D)` normalised.
        startable: `(F,)` rows that may be chosen.
        clip_of: `(F,)` clip of each row.
    """
    rows = np.flatnonzero(startable)
    index = ExactIndex(schema, features, np.zeros(len(features), np.float32), rows)
    sample = rows[np.linspace(0, len(rows) - 1, min(1000, len(rows))).astype(int)]
    weights = np.broadcast_to(schema.weights, (len(sample), len(schema.channels)))
    found = index.search(augment_queries(schema, features[sample], weights), 2 * _CANDIDATES)
    other = (np.abs(found - sample[:, None]) >= NEIGHBOURHOOD_FRAMES) | (
        clip_of[found] != clip_of[sample][:, None]
    )
    difference = features[found].astype(np.float64) - features[sample].astype(np.float64)[:, None]
    costs = (difference * difference * schema.weights[schema.channel_of]).sum(axis=-1)
    nearest = np.where(other, costs, np.inf).min(axis=1)
    nearest = nearest[np.isfinite(nearest)]
    return float(np.median(nearest)) if len(nearest) else 1.0
