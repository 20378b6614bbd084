"""Inverted lists: a fast index for large libraries.

Rows are grouped by k-means under L2 on the normalised features; a query looks only into the lists
whose centre is nearest under *its* weights. Both levels are inner products over augmented vectors,
so that one grouping serves every weighting. (Letting the inner product assign the rows, too, would
lose a quarter of the best ones.)
"""

from dataclasses import dataclass

import faiss
import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.matching.index import augment_rows, one_thread
from stridewire_engine.matching.schema import Schema

_TRAINING_ROWS_A_LIST = 64
_SEED = 1234


@dataclass(frozen=True)
class Grouping:
    """Which list each indexed row is in."""

    centroids: Floats
    """`(L, D)` float32 in normalised features."""
    lists: Indices
    """`(M,)` int32 list of each row."""


def group_rows(features: Floats) -> Grouping:
    """Group normalised features `(M, D)` by k-means into about `4 sqrt(M)` lists, seeded."""
    one_thread()
    features = np.ascontiguousarray(features, np.float32)
    count = max(1, min(round(4.0 * np.sqrt(len(features))), len(features) // 39))
    kmeans = faiss.Kmeans(
        features.shape[1],
        count,
        niter=10,
        seed=_SEED,
        max_points_per_centroid=_TRAINING_ROWS_A_LIST,
        min_points_per_centroid=1,
    )
    kmeans.train(features)
    _, lists = kmeans.index.search(features, 1)
    return Grouping(np.asarray(kmeans.centroids), lists[:, 0].astype(np.int32))


def narrow(grouping: Grouping, features: Floats, which: Indices) -> Grouping:
    """Return the grouping of some of the rows: empty lists dropped, centres moved to what is left.

    Args:
        grouping: Of M rows.
        features: `(K, D)` normalised, of the rows that are left.
        which: `(K,)` their places among the M.
    """
    used, lists = np.unique(grouping.lists[which], return_inverse=True)
    order = np.argsort(lists, kind="stable")
    starts = np.searchsorted(lists[order], np.arange(len(used)))
    sums = np.add.reduceat(features[order].astype(np.float64), starts, axis=0)
    counts = np.diff(np.append(starts, len(lists)))
    return Grouping((sums / counts[:, None]).astype(np.float32), lists.astype(np.int32))


class InvertedLists:
    """Inner-product search in the lists nearest to the query."""

    def __init__(
        self,
        schema: Schema,
        features: Floats,
        bias: Floats,
        rows: Indices,
        grouping: Grouping,
        probes: int,
    ) -> None:
        """Store rows of normalised features `(F, D)` with biases `(F,)` in given lists.

        Args:
            schema: Of the features.
            features: Of the whole library.
            bias: Of the whole library.
            rows: Those that are indexed, ascending.
            grouping: Of those rows.
            probes: Number of lists that a query looks into.
        """
        self.probes = probes
        """Number of lists that a query looks into."""
        centroids = augment_rows(schema, grouping.centroids, np.zeros(len(grouping.centroids)))
        self._coarse = faiss.IndexFlatIP(centroids.shape[1])
        self._coarse.add(centroids)
        self._index = faiss.IndexIVFFlat(
            self._coarse, centroids.shape[1], len(centroids), faiss.METRIC_INNER_PRODUCT
        )
        self._index.is_trained = True
        stored = augment_rows(schema, features[rows], bias[rows])
        ids = np.ascontiguousarray(rows, np.int64)
        lists = np.ascontiguousarray(grouping.lists, np.int64)
        self._index.add_core(
            len(rows), faiss.swig_ptr(stored), faiss.swig_ptr(ids), faiss.swig_ptr(lists)
        )

    def search(
        self,
        augmented: Floats,
        k: int,
        selector: "faiss.IDSelector | None" = None,
        exhaustive: bool = False,
    ) -> Indices:
        """Return `(N, k)` library rows nearest to queries, nearest first; -1 where none is left.

        Args:
            augmented: `(N, D + C + 1)` from `augment_queries`.
            k: Number of rows.
            selector: Over the library's rows; None for all.
            exhaustive: Look into every list, so that nothing is missed.
        """
        probes = self._coarse.ntotal if exhaustive else self.probes
        parameters = faiss.SearchParametersIVF(nprobe=probes, sel=selector)
        one_thread()
        return np.asarray(self._index.search(augmented, k, params=parameters)[1])
