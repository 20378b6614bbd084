"""Pairs: moments of clips up to a second apart, and what lies between them."""

from collections.abc import Iterable
from dataclasses import dataclass, fields

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.clip import Clip
from stridewire.motion.mirror import mirror_clip
from stridewire_engine.networks.blend.features import LONGEST_S, SHORTEST_S
from stridewire_engine.networks.blend.postures import PairFrame, Postures


@dataclass(frozen=True)
class Pairs:
    """N pairs with W postures between each, in the pairs' frames."""

    start: Postures
    """`(N,)`."""
    end: Postures
    """`(N,)`."""
    duration: Floats
    """`(N,)` seconds."""
    weights: Floats
    """`(N, W)`."""
    truth: Postures
    """`(N, W)` what was captured at the weights."""
    rows: Indices
    """`(N, W)` rows of the frames of the truth."""
    clip: Indices
    """`(N,)` which clip they are of."""

    def __len__(self) -> int:
        return len(self.duration)

    def __getitem__(self, index: slice) -> "Pairs":
        """Take some of the pairs."""
        parts = (getattr(self, field.name) for field in fields(self))
        return Pairs(*(part[index] for part in parts))


@dataclass(frozen=True)
class Frames:
    """The frames of clips, one after another."""

    postures: Postures
    """`(F,)` in the world, float32."""
    starts: Indices
    """`(C,)` first frame of each clip."""
    lengths: Indices
    """`(C,)` frames of each clip."""
    contacts: Flags
    """`(F, 4)` planted foot joints, in the order of `CONTACT_JOINTS`."""
    frame_rate: float

    @staticmethod
    def of(clips: Iterable[Clip], mirror: bool = False) -> "Frames":
        """Gather clips of one frame rate that are long enough for the shortest pair.

        Args:
            clips: On the reference skeleton, standing on the ground y = 0.
            mirror: Whether to add mirrored copies.

        Raises:
            ValueError: If there is none.
        """
        kept = [clip for clip in clips if clip.seconds >= 2.0 * SHORTEST_S]
        if not kept:
            raise ValueError("no clip is long enough for pairs; expected 0.2 s at least")
        both = [*kept, *map(mirror_clip, kept)] if mirror else kept
        parts = [Postures.of(clip.pose.astype(np.float32)) for clip in both]
        lengths = np.array([len(clip) for clip in both], np.intp)
        return Frames(
            Postures(
                np.concatenate([part.hips for part in parts]),
                np.concatenate([part.rotations for part in parts]),
            ),
            np.cumsum(lengths) - lengths,
            lengths,
            np.concatenate([clip.contacts for clip in both]),
            kept[0].frame_rate,
        )

    def draw(self, rng: np.random.Generator, count: int, between: int) -> Pairs:
        """Draw pairs of any duration, clips by their length, and moments between at random."""
        shortest, longest = (round(s * self.frame_rate) for s in (SHORTEST_S, LONGEST_S))
        clip = rng.choice(len(self.lengths), count, p=self.lengths / self.lengths.sum())
        span = rng.integers(shortest, longest + 1, count)
        span = np.minimum(span, self.lengths[clip] - 1)
        first = self.starts[clip] + rng.integers(0, self.lengths[clip] - span)
        inside = rng.integers(0, span[:, None] + 1, (count, between))
        return self.pairs(clip, first, span, inside)

    def every(self, duration: float, step: float, weights: Floats) -> Pairs:
        """Return pairs of one duration all along the clips.

        Args:
            duration: Seconds.
            step: Seconds from one pair's start to the next one's.
            weights: `(W,)`; the frames nearest to them are taken.
        """
        span = round(duration * self.frame_rate)
        stride = max(1, round(step * self.frame_rate))
        of_clip = [np.arange(0, max(n - span, 0), stride) for n in self.lengths]
        clip = np.repeat(np.arange(len(self.lengths)), [len(part) for part in of_clip])
        first = self.starts[clip] + np.concatenate(of_clip)
        inside = np.broadcast_to(
            np.round(weights * span).astype(np.intp), (len(clip), len(weights))
        )
        return self.pairs(clip, first, np.full(len(clip), span), inside)

    def pairs(self, clip: Indices, first: Indices, span: Indices, inside: Indices) -> Pairs:
        """Return pairs by frames.

        Args:
            clip: `(N,)`.
            first: `(N,)` row of the start.
            span: `(N,)` frames from start to end.
            inside: `(N, W)` frames from the start.
        """
        start, rows = self.postures[first], first[:, None] + inside
        frame = PairFrame.of(start, np.zeros(len(first), np.float32))
        return Pairs(
            frame.enter(start),
            frame.enter(self.postures[first + span]),
            (span / self.frame_rate).astype(np.float32),
            (inside / span[:, None]).astype(np.float32),
            frame.enter(self.postures[rows]),
            rows,
            clip,
        )
