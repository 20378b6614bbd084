"""Pairs: clips set one after another, and the take whose path they follow (Kim et al. 2023, 4).

A window of a take is cut into two or three segments. The first stays; for each other one a segment
of another moment is found that goes alike, and put under the take's root path. What a refiner is
to make of it is the take.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine.networks.rmr.plans import WINDOW, seams_of
from stridewire_engine.networks.rmr.segments import Segments
from stridewire_engine.networks.rmr.takes import Takes

_UNIT = 10
LENGTHS = tuple(range(_UNIT, WINDOW, _UNIT))
"""Frames of segments."""
NEAREST, FURTHEST = 5, 10
_HELPED = 0.5


@dataclass(frozen=True)
class Pairs:
    """N pairs of T frames, as rows of takes."""

    truth: Indices
    """`(N, T)` rows of the take."""
    rows: Indices
    """`(N, T)` rows of the clips that are set together."""
    starts: Flags
    """`(N, T)` whether a clip begins."""
    help: Floats
    """`(N, T)` share of the take's own upper body in what is set together."""

    def __len__(self) -> int:
        return len(self.truth)

    def __getitem__(self, index: Indices | slice) -> "Pairs":
        """Take some of the pairs."""
        return Pairs(*(getattr(self, field.name)[index] for field in fields(self)))

    @property
    def seam(self) -> Indices:
        """`(N, T)` frame of the last seam, as in `Plans`."""
        return seams_of(self.starts)


class PairMaker:
    """Makes pairs of takes."""

    def __init__(self, takes: Takes) -> None:
        """Index the takes' segments when they are first asked for."""
        self.takes = takes
        self._segments: Mapping[int, Segments] = {n: Segments(takes, n) for n in LENGTHS}

    def make(
        self,
        first: Indices,
        rng: np.random.Generator,
        nearest: int = NEAREST,
        furthest: int = FURTHEST,
    ) -> Pairs:
        """Return pairs for windows; fewer where no segment goes alike.

        Args:
            first: `(N,)` first rows of the windows.
            rng: Chooses seams and segments.
            nearest: Rank of the nearest segment that may be taken.
            furthest: Rank of the furthest.
        """
        cuts = _cuts(rng, len(first))
        frames = np.arange(WINDOW)
        truth = first[:, None] + frames
        rows, found = truth.copy(), np.ones(len(first), bool)
        for begin, end in ((cuts[:, 0], cuts[:, 1]), (cuts[:, 1], np.full(len(first), WINDOW))):
            for length, segments in self._segments.items():
                which = np.flatnonzero((end - begin == length) & (begin > 0))
                if not len(which):
                    continue
                at = segments.other(first[which] + begin[which], rng, nearest, furthest)
                found[which] &= at >= 0
                inside = (frames >= begin[which, None]) & (frames < end[which, None])
                rows[which] = np.where(
                    inside, at[:, None] + frames - begin[which, None], rows[which]
                )
        starts = (frames == cuts[:, :1]) | ((frames == cuts[:, 1:]) & (cuts[:, 1:] < WINDOW))
        into = (frames - cuts[:, :1]) / (WINDOW - 1 - cuts[:, :1])
        helped = rng.random((len(first), 1)) < _HELPED
        share = np.where(helped, np.clip(into, 0.0, 1.0), 0.0)
        share = share * share * (3.0 - 2.0 * share)
        return Pairs(truth, rows, starts, share)[np.flatnonzero(found)]


def _cuts(rng: np.random.Generator, count: int) -> Indices:
    """Return where the second and the third segment begin `(N, 2)`; the window's end for none."""
    units = WINDOW // _UNIT
    first = rng.integers(1, units, count)
    second = rng.integers(first + 1, units + 1)
    # even odds of two and of three segments, where there is room for three
    second = np.where(rng.random(count) < 0.5, units, second)
    return _UNIT * np.stack([first, second], axis=1)
