"""Segments: moments of other takes that go the same way (Kim et al. 2023, section 4).

One index a length. A segment is told by its joints in the first frame (weight 0.1) and the last
one (1) and by its root's path (1), relative to its first root; each block is divided by its
spread, so that weights compare.
"""

from functools import cached_property

import faiss
import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.root_frame import turn_to_world
from stridewire_engine.networks.rmr.takes import Takes

_WEIGHTS = (0.1, 1.0, 1.0)
_STRIDE = 3
_PATH_FRAMES = 5
_HITS = 64
_OWN = 60
"""Frames around the query, in its own take and in the mirrored copy, that are no other moment."""
_APART = 10
"""Hits of one take are so many frames apart."""


class Segments:
    """All segments of one length of takes."""

    def __init__(self, takes: Takes, length: int) -> None:
        """Index segments.

        Args:
            takes: To choose from.
            length: Frames.
        """
        self.length = length
        self._takes = takes
        frame, room = takes.frame, takes.lengths[takes.clip]
        fits = (frame >= 2) & (frame + length + 1 < room) & (frame % _STRIDE == 0)
        self._rows = np.flatnonzero(fits & takes.locomotion)

    def other(
        self, query: Indices, rng: np.random.Generator, nearest: int, furthest: int
    ) -> Indices:
        """Return first rows `(N,)` of segments like those that begin at rows `query` `(N,)`.

        The k-th nearest, k drawn from `nearest` to `furthest`; the last one where there are fewer,
        -1 where there is none.
        """
        _, hits = self._index.search(self._features(query), _HITS)
        rows = np.where(hits >= 0, self._rows[hits], -1)
        left = self._thinned(query, rows)
        wanted = rng.integers(nearest, furthest + 1, len(query))
        rank = np.cumsum(left, axis=1)
        chosen = left & (rank == np.minimum(wanted, rank[:, -1])[:, None])
        return np.where(left.any(axis=1), rows[np.arange(len(query)), chosen.argmax(axis=1)], -1)

    @cached_property
    def _blocks(self) -> list[Floats]:
        return [_spread(block) for block in self._told(self._rows)]

    @cached_property
    def _index(self) -> faiss.IndexFlatL2:
        features = self._features(self._rows)
        index = faiss.IndexFlatL2(features.shape[1])
        index.add(features)
        return index

    def _told(self, rows: Indices) -> list[Floats]:
        """Return first joints, last joints and paths of segments, relative to their first roots."""
        takes = self._takes
        last = rows + self.length - 1
        at = rows[:, None] + np.round(np.linspace(0, self.length - 1, _PATH_FRAMES)).astype(np.intp)
        path, yaw = takes.root_path(at)
        end = turn_to_world(takes.joints[last].astype(np.float64), yaw[:, -1]) + path[:, -1:, :]
        way = np.stack([path[..., 0], path[..., 2], np.sin(yaw), np.cos(yaw)], axis=-1)
        return [_flat(takes.joints[rows]), _flat(end), _flat(way)]

    def _features(self, rows: Indices) -> Floats:
        parts = [
            weight * block / spread
            for weight, block, spread in zip(_WEIGHTS, self._told(rows), self._blocks, strict=True)
        ]
        return np.concatenate(parts, axis=1).astype(np.float32)

    def _thinned(self, query: Indices, rows: Indices) -> Flags:
        """Tell which hits `(N, H)` stay: no own moment, not close to a nearer hit."""
        takes = self._takes
        clip, frame = takes.clip[rows], takes.frame[rows]
        own = takes.clip[query] % takes.originals, takes.frame[query]
        same = clip % takes.originals == own[0][:, None]
        near = np.abs(frame - own[1][:, None]) <= _OWN
        left = (rows >= 0) & ~(same & near)
        for rank in range(1, rows.shape[1]):
            close = (clip[:, :rank] == clip[:, rank, None]) & (
                np.abs(frame[:, :rank] - frame[:, rank, None]) < _APART
            )
            left[:, rank] &= ~(close & left[:, :rank]).any(axis=1)
        return np.asarray(left)


def _spread(block: Floats) -> Floats:
    """Return the size of a block `(N, D)`: so that its squares sum to 1 on average."""
    centred = block - block.mean(axis=0)
    return np.asarray(np.sqrt(np.mean(np.sum(centred * centred, axis=1))))


def _flat(points: Vectors) -> Floats:
    return points.reshape(len(points), -1)
