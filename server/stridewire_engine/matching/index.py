"""The exact index: weighted distances under any weights a query, without building anything again.

The square of a weighted distance is `sum_c w_c |q_c|^2 - sum_c w_c (2 q_c . x_c - |x_c|^2)`. So
each row is stored as `[x, |x_1|^2 … |x_C|^2]`, each query as `[2 w_c q_c …, -w_1 … -w_C]`, and the
largest inner product is the smallest distance, exactly, whatever the weights.
"""

import faiss
import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine.matching.schema import Schema


class ExactIndex:
    """Inner-product scan of all rows that may be chosen."""

    def __init__(self, schema: Schema, features: Floats, startable: Flags) -> None:
        """Index the startable rows of normalised features `(F, D)`."""
        self._schema = schema
        self._rows: Indices = np.flatnonzero(startable)
        chosen = np.ascontiguousarray(features[self._rows], np.float32)
        squares = np.add.reduceat(chosen * chosen, schema.starts, axis=1)
        self._index = faiss.IndexFlatIP(schema.dimensions + len(schema.channels))
        self._index.add(np.concatenate([chosen, squares], axis=1))

    def __len__(self) -> int:
        return len(self._rows)

    def search(self, queries: Floats, weights: Floats, k: int) -> Indices:
        """Return the `(N, min(k, rows))` library rows nearest to each query, nearest first.

        One FAISS call on one thread; nearest up to float32's rounding, see `Matcher` for the exact
        order.

        Args:
            queries: `(N, D)` normalised features.
            weights: `(N, C)` weight of each channel.
            k: Number of rows.
        """
        # OpenMP's count is per thread, and the searching thread is not the importing one
        faiss.omp_set_num_threads(1)
        scaled = 2.0 * queries * weights[:, self._schema.channel_of]
        augmented = np.concatenate([scaled, -weights], axis=1).astype(np.float32)
        _, found = self._index.search(augmented, min(k, len(self._rows)))
        return np.asarray(self._rows[found])
