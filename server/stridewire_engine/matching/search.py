"""The search: candidates from the index, exact costs, the own neighbourhood left out."""

from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.matching.features import Normalisation
from stridewire_engine.matching.index import ExactIndex
from stridewire_engine.matching.schema import Schema

NEIGHBOURHOOD_FRAMES = 20
"""Rows nearer than this to the one now playing are the same moment, not another."""
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
    """`(N, k)` float64."""
    channel_costs: Floats
    """`(N, k, C)` float64; they add up to the costs."""


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
        self._index = ExactIndex(self.schema, library.features, library.startable)

    def __len__(self) -> int:
        """Return the number of rows that may be chosen."""
        return len(self._index)

    def search(self, queries: Floats, weights: Floats, excluded: Indices, k: int = 1) -> Found:
        """Find the nearest rows outside the neighbourhood of excluded ones.

        Costs are exact, row by row in float64; ties go to the lowest row. If the neighbourhood
        hides too many candidates, the index is asked again for more.

        Args:
            queries: `(N, D)` normalised features.
            weights: `(N, C)`.
            excluded: `(N, E)` rows whose neighbourhood is left out; negative for none.
            k: Number of rows wanted.
        """
        ask = k - 1 + _CANDIDATES * max(1, excluded.shape[1])
        while True:
            candidates = self._index.search(queries, weights, ask)
            allowed = self._outside(candidates, excluded)
            if ask >= len(self._index) or np.all(allowed.sum(axis=1) >= k):
                return self._rank(queries, weights, candidates, allowed, k)
            ask *= 4

    def costs(self, queries: Floats, weights: Floats, rows: Indices) -> Floats:
        """Return exact costs by channel `(N, K, C)`, float64, of `rows` `(N, K)`."""
        difference = self.library.features[rows].astype(np.float64) - queries[:, None]
        squares = np.add.reduceat(difference * difference, self.schema.starts, axis=-1)
        return np.asarray(squares * weights[:, None])

    def _outside(self, candidates: Indices, excluded: Indices) -> Flags:
        allowed: Flags = np.ones(candidates.shape, np.bool_)
        clip_of = self.library.clip_of
        for column in excluded.T:
            near = np.abs(candidates - column[:, None]) < NEIGHBOURHOOD_FRAMES
            same = clip_of[candidates] == clip_of[np.maximum(column, 0)][:, None]
            allowed &= ~(near & same & (column >= 0)[:, None])
        return allowed

    def _rank(
        self, queries: Floats, weights: Floats, candidates: Indices, allowed: Flags, k: int
    ) -> Found:
        by_channel = self.costs(queries, weights, candidates)
        costs = np.where(allowed, by_channel.sum(axis=-1), np.inf)
        order = np.lexsort((candidates, costs), axis=-1)[:, :k]
        rows = np.take_along_axis(candidates, order, axis=1)
        best = np.take_along_axis(costs, order, axis=1)
        return Found(
            np.where(np.isfinite(best), rows, -1),
            best,
            np.take_along_axis(by_channel, order[..., None], axis=1),
        )


def typical_cost(schema: Schema, features: Floats, startable: Flags, clip_of: Indices) -> float:
    """Return the median cost of the nearest other moment, over up to 1,000 evenly spread rows.

    Args:
        schema: Its weights are used.
        features: `(F, D)` normalised.
        startable: `(F,)` rows that may be chosen.
        clip_of: `(F,)` clip of each row.
    """
    index = ExactIndex(schema, features, startable)
    chosen = np.flatnonzero(startable)
    sample = chosen[np.linspace(0, len(chosen) - 1, min(1000, len(chosen))).astype(int)]
    weights = np.broadcast_to(schema.weights, (len(sample), len(schema.channels)))
    found = index.search(features[sample], weights, 2 * _CANDIDATES)
    other = (np.abs(found - sample[:, None]) >= NEIGHBOURHOOD_FRAMES) | (
        clip_of[found] != clip_of[sample][:, None]
    )
    difference = features[found].astype(np.float64) - features[sample].astype(np.float64)[:, None]
    costs = (difference * difference * schema.weights[schema.channel_of]).sum(axis=-1)
    nearest = np.where(other, costs, np.inf).min(axis=1)
    nearest = nearest[np.isfinite(nearest)]
    return float(np.median(nearest)) if len(nearest) else 1.0
