"""Indices: candidates for a query under any weights, without building anything again.

The square of a weighted distance is `sum_c w_c |q_c|^2 - sum_c w_c (2 q_c . x_c - |x_c|^2)`. So
each row is stored as `[x, |x_1|^2 … |x_C|^2, b]`, each query as `[2 w_c q_c …, -w_1 … -w_C, -1]`,
and the largest inner product is the smallest distance plus the row's bias b, exactly, whatever the
weights.
"""

import faiss
import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.matching.schema import Schema


def augment_rows(schema: Schema, features: Floats, bias: Floats) -> Floats:
    """Return what is stored for normalised features `(M, D)` and biases `(M,)`, float32."""
    features = np.asarray(features, np.float32)
    squares = np.add.reduceat(features * features, schema.starts, axis=1)
    return np.ascontiguousarray(np.column_stack([features, squares, bias]), np.float32)


def augment_queries(schema: Schema, queries: Floats, weights: Floats) -> Floats:
    """Return what is asked for normalised queries `(N, D)` under weights `(N, C)`, float32."""
    scaled = 2.0 * queries * weights[:, schema.channel_of]
    return np.ascontiguousarray(
        np.column_stack([scaled, -weights, -np.ones(len(queries))]), np.float32
    )


class ExactIndex:
    """Inner-product scan of some rows of a library."""

    def __init__(self, schema: Schema, features: Floats, bias: Floats, rows: Indices) -> None:
        """Store rows of normalised features `(F, D)` with their biases `(F,)`."""
        self._rows = rows
        stored = augment_rows(schema, features[rows], bias[rows])
        self._index = faiss.IndexFlatIP(stored.shape[1])
        self._index.add(stored)

    def search(self, augmented: Floats, k: int) -> Indices:
        """Return the `(N, min(k, rows))` library rows nearest to queries, nearest first.

        Args:
            augmented: `(N, D + C + 1)` from `augment_queries`.
            k: Number of rows.
        """
        one_thread()
        _, found = self._index.search(augmented, min(k, len(self._rows)))
        return np.asarray(self._rows[found])


def one_thread() -> None:
    """Let FAISS use one thread when called from this one."""
    # OpenMP's count belongs to the calling thread, and the searching one is not the importing one;
    # a second thread on a busy machine makes a scan slower, not faster
    faiss.omp_set_num_threads(1)
