"""Boxes: rows in groups with bounds around them, for the search of a tick.

One exact answer a query, under any weights, after a look at a hundredth of the rows; see
`compiled.scanning`. Groups are the inverted lists' where there are some, else runs of frames.
"""

from itertools import pairwise

import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.compiled.scanning import Boxed, scan
from stridewire_engine.matching.schema import Schema

RUN = 16
"""Frames of a group where rows are grouped by their order alone."""
_MOST = 64
"""Rows of a box; larger groups have several, of frames that follow each other."""


class Boxes:
    """Some rows of a library, ready to be scanned."""

    def __init__(
        self,
        schema: Schema,
        features: Floats,
        bias: Floats,
        clip_of: Indices,
        rows: Indices,
        groups: Indices,
    ) -> None:
        """Copy the features of rows, group by group.

        Args:
            schema: Of the features.
            features: `(F, D)` float32, normalised, of the whole library.
            bias: `(F,)` of the whole library.
            clip_of: `(F,)`.
            rows: `(M,)` that may be found, ascending.
            groups: `(M,)` number of the group of each; groups without rows may be left out.
        """
        order = np.argsort(groups, kind="stable")
        first = np.flatnonzero(np.diff(groups[order], prepend=-1))
        within = np.arange(len(rows)) - np.repeat(first, np.diff(first, append=len(rows)))
        starts = np.append(np.flatnonzero(within % _MOST == 0), len(rows))
        grouped = rows[order]
        stored = np.ascontiguousarray(features[grouped], np.float32)
        low = np.minimum.reduceat(stored, starts[:-1])
        high = np.maximum.reduceat(stored, starts[:-1])
        middle = low + 0.5 * (high - low)
        biases = bias[grouped].astype(np.float32)
        self._boxed = Boxed(
            features=features,
            channel_of=schema.channel_of,
            bias=bias,
            clip_of=clip_of,
            rows=grouped,
            starts=starts,
            columns=_by_number(stored, starts),
            biases=biases,
            middle=np.ascontiguousarray(middle.T),
            half=np.ascontiguousarray(np.maximum(high - middle, middle - low).T),
            least_bias=np.minimum.reduceat(biases, starts[:-1]),
            largest=_MOST,
        )

    @property
    def nbytes(self) -> int:
        """Bytes beside the library's own."""
        own = ("rows", "starts", "columns", "biases", "middle", "half", "least_bias")
        return sum(getattr(self._boxed, name).nbytes for name in own)

    def best(
        self, queries: Floats, weights: Floats, excluded: Indices, neighbourhood: int
    ) -> tuple[Indices, Floats, Floats]:
        """Return the best row `(N, 1)`, its cost `(N, 1)` and that by channel `(N, 1, C)`.

        Where nothing is allowed, the row is -1 and the cost infinite.

        Args:
            queries: `(N, D)` normalised.
            weights: `(N, C)`.
            excluded: `(N, E)` rows; negative for none.
            neighbourhood: Rows nearer than this to an excluded one of their clip are left out.
        """
        count, channels = weights.shape
        found = np.empty((count, 1), np.int64), np.empty((count, 1))
        by_channel = np.empty((count, 1, channels))
        scan(self._boxed, neighbourhood, queries, weights, excluded, *found, by_channel)
        return *found, by_channel


def _by_number(stored: Floats, starts: Indices) -> Floats:
    """Return rows `(M, D)` of groups as `(M D,)`: of each group number after number."""
    out = np.empty(stored.size, np.float32)
    width = stored.shape[1]
    for first, end in pairwise(starts.tolist()):
        out[first * width : end * width] = stored[first:end].T.reshape(-1)
    return out
