"""The characters of a script: lots drawn by character and seed, without a generator's state."""

from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Floats, Indices


@dataclass(frozen=True)
class Cast:
    """N characters under one seed."""

    seed: int
    characters: Indices
    """`(N,)` numbers of the characters, from 0."""

    @property
    def heading(self) -> Floats:
        """`(N,)` the way each looks at first; radians from -pi to pi."""
        return (2.0 * self.lot(0) - 1.0) * np.pi

    @property
    def phase(self) -> Floats:
        """`(N,)` where in its cycle each begins, from 0 to 1."""
        return self.lot(1)

    @property
    def side(self) -> Floats:
        """`(N,)` which side each prefers: 1 left, -1 right."""
        return np.where(self.lot(2) < 0.5, -1.0, 1.0)

    def lot(self, what: int, index: Indices | int = 0) -> Floats:
        """Return numbers `(N,)` from 0 to 1, not 1, that depend on nothing but the arguments.

        Args:
            what: Tells lots of one character apart.
            index: `(N,)` or one number; tells lots of one kind apart, for instance over time.
        """
        lots: Indices = np.full(self.characters.shape, self.seed & 0xFFFFFFFF, np.uint64)
        for part in (self.characters, np.asarray(what), np.asarray(index)):
            lots = _mix(lots ^ part.astype(np.int64).astype(np.uint64))
        return (lots >> np.uint64(11)).astype(np.float64) * 2.0**-53


def _mix(bits: Indices) -> Indices:
    """Scramble 64-bit numbers: the step of SplitMix64 (Steele, Lea, Flood 2014)."""
    bits = bits + np.uint64(0x9E3779B97F4A7C15)
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return np.asarray(bits ^ (bits >> np.uint64(31)))
