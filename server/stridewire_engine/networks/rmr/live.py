"""Live plans: the last frames that were sent, then the coming ones of a clip that was jumped to.

The root goes on from where it was, along the clip's own path; what velocities differ by fades out.
Nobody knows where feet ought to be, so the clip itself is the aim, the more the longer it plays.
"""

import faiss
import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire_engine.networks.rmr.assembly import Assembled, Legs, placed_before, spring
from stridewire_engine.networks.rmr.plans import FRAME_RATE, WINDOW, Plans
from stridewire_engine.networks.rmr.takes import LOWER, TOES, Takes

HEAD = 8
"""Frames of a live plan that were sent already."""
_COMING = WINDOW - HEAD
_PAST = 60
_SHORTEST, _LONGEST = 15, 50
"""Frames from one jump to the next."""
_STRIDE = 2
_AHEAD = (20, 40, 60)
_HITS = 64
_NEAREST = 10
_BAD = 0.15
_ROOT_HALFLIFE = 0.12
_WEIGHTS = (0.75, 1.0, 1.0, 1.0, 1.5)
_PULL_FROM, _PULL_FRAMES, _LEAST_PULL = 5.0, 30.0, 0.1


class LiveMaker:
    """Makes live plans of takes."""

    def __init__(self, takes: Takes) -> None:
        """Index the moments that can be jumped to."""
        self.takes = takes
        frame, room = takes.frame, takes.lengths[takes.clip]
        fits = (frame >= 2) & (frame + _PAST + _COMING + 2 < room) & takes.locomotion
        self._rows = np.flatnonzero(fits & (frame % _STRIDE == 0))
        told = self._told(self._rows)
        self._spread = [np.sqrt(np.mean(np.sum((b - b.mean(0)) ** 2, axis=1))) for b in told]
        features = self._scaled(told)
        self._index = faiss.IndexFlatL2(features.shape[1])
        self._index.add(features)

    def make(self, count: int, rng: np.random.Generator) -> tuple[Assembled, Flags]:
        """Return live plans of chains of two jumps, and whether a clip begins `(N, T)`."""
        first = rng.choice(self._rows, count)
        lasts = rng.integers(_SHORTEST, _LONGEST + 1, count)
        second = self._other(first, rng)
        third = self._other(second + lasts, rng)
        good = (second >= 0) & (third >= 0)
        return self._assemble(first[good], second[good], third[good], lasts[good])

    def _assemble(
        self, first: Indices, second: Indices, third: Indices, lasts: Indices
    ) -> tuple[Assembled, Flags]:
        takes, frames = self.takes, np.arange(_PAST + _COMING)
        jump = _PAST - lasts[:, None]
        rows = np.where(frames < jump, first[:, None], second[:, None]) + frames - jump
        # before the first jump any frames of its clip will do, as long as they are two
        rows = np.maximum(rows, takes.starts[takes.clip[first]][:, None])
        rows[:, _PAST:] = third[:, None] + np.arange(_COMING)
        starts = (frames == jump) | (frames == _PAST)
        hips = takes.hips[rows].astype(np.float64)
        turns = takes.rotations[rows][:, :, : len(LOWER)].astype(np.float64)
        shown_hips, shown_turns = spring(takes, rows, starts, hips, turns)
        kept = slice(_PAST - HEAD, None)
        rows, starts = rows[:, kept], starts[:, kept].copy()
        starts[:, :HEAD] = False
        root, yaw = self._path(rows)
        sprung = Legs.of(root, yaw, shown_hips[:, kept], shown_turns[:, kept])
        clip = Legs.of(root, yaw, hips[:, kept], turns[:, kept])
        plans = Plans(
            root,
            yaw,
            sprung.hips,
            sprung.toes,
            sprung.ankles,
            clip.toes,
            takes.contacts[rows],
            np.full(rows.shape, HEAD),
            np.zeros(len(rows), bool),
        )
        before = placed_before(takes, clip.toes, rows, starts, root, yaw)
        return Assembled(plans, sprung, clip, before, clip), starts

    def _path(self, rows: Indices) -> tuple[Vectors, Floats]:
        """Return the root's path over the jump."""
        takes = self.takes
        root, yaw = np.zeros((*rows.shape, 3)), np.zeros(rows.shape)
        root[:, :HEAD], yaw[:, :HEAD] = takes.root_path(rows[:, :HEAD])
        last = rows[:, HEAD - 1]
        speed, turn = self._step(last)
        own, own_turn = self._step(rows[:, HEAD] - 1)
        left = 2.0 ** (-np.arange(1, _COMING + 1) / FRAME_RATE / _ROOT_HALFLIFE)
        for i in range(_COMING):
            at = HEAD + i
            way, turned_by = self._step(rows[:, at] - 1)
            way = way + (speed - own) * left[i]
            root[:, at] = root[:, at - 1] + turn_to_world(way[:, None], yaw[:, at - 1])[:, 0]
            yaw[:, at] = yaw[:, at - 1] + turned_by + (turn - own_turn) * left[i]
        return root, yaw

    def _step(self, rows: Indices) -> tuple[Vectors, Floats]:
        """Return the root's way `(N, 3)` in its own frame, and turn `(N,)`, to the next frame."""
        takes = self.takes
        way = takes.root[rows + 1] - takes.root[rows]
        local = turn_to_root(way[:, None], takes.yaw[rows])[:, 0]
        return local, takes.yaw[rows + 1] - takes.yaw[rows]

    def _other(self, query: Indices, rng: np.random.Generator) -> Indices:
        """Return a row `(N,)` of another take like each query; -1 where there is none."""
        takes = self.takes
        known = np.maximum(query, 0)
        _, hits = self._index.search(self._scaled(self._told(known)), _HITS)
        rows = np.where(hits >= 0, self._rows[hits], 0)
        own = takes.clip[rows] % takes.originals == (takes.clip[known] % takes.originals)[:, None]
        left = (hits >= 0) & ~own
        bad = rng.random(len(query)) < _BAD
        wanted = np.where(
            bad, rng.integers(20, _HITS + 1, len(query)), rng.integers(1, _NEAREST + 1, len(query))
        )
        rank = np.cumsum(left, axis=1)
        chosen = left & (rank == np.minimum(wanted, rank[:, -1])[:, None])
        found = rows[np.arange(len(query)), chosen.argmax(axis=1)]
        return np.where(left.any(axis=1) & (query >= 0), found, -1)

    def _told(self, rows: Indices) -> list[Floats]:
        """Return toes, their velocity, the root's velocity, and where it goes."""
        takes = self.takes
        last = (takes.starts + takes.lengths)[takes.clip[rows]] - 1
        toes = takes.joints[rows][:, TOES].astype(np.float64)
        then = takes.joints[np.minimum(rows + 1, last)][:, TOES]
        way, turn = self._step(np.minimum(rows, last - 1))
        at = np.minimum(rows[:, None] + np.array([0, *_AHEAD]), last[:, None])
        path, yaw = takes.root_path(at)
        moved = np.concatenate([way, turn[:, None]], axis=1) * FRAME_RATE
        return [
            toes.reshape(len(rows), -1),
            FRAME_RATE * (then - toes).reshape(len(rows), -1),
            moved,
            path[:, 1:, [0, 2]].reshape(len(rows), -1),
            np.stack([np.sin(yaw[:, 1:]), np.cos(yaw[:, 1:])], axis=-1).reshape(len(rows), -1),
        ]

    def _scaled(self, told: list[Floats]) -> Floats:
        parts = [w * b / s for w, b, s in zip(_WEIGHTS, told, self._spread, strict=True)]
        return np.concatenate(parts, axis=1).astype(np.float32)


def pull(since_first: Indices) -> Floats:
    """Return how much it matters `(N, T)` to be where the clip is."""
    x = np.clip((since_first - _PULL_FROM) / _PULL_FRAMES, 0.0, 1.0)
    return np.asarray(_LEAST_PULL + (1.0 - _LEAST_PULL) * x * x * (3.0 - 2.0 * x))
