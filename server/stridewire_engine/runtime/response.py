"""Response: what a character gives up of quality for following its control, or the other way.

A responsiveness of 0.5 is the settings of the tick and the weights as they are. From there to 0 and
to 1 each number moves evenly on a log scale to a multiple of itself. The multiples point where the
front of `stridewire evaluate tune` lies; `docs/quality.md` says what they were measured to do.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats


class Multiples(NamedTuple):
    """What settings are multiplied by; scalars, or arrays `(N,)`."""

    velocity_halflife: Floats | float
    """Spring of the simulated root's velocity."""
    facing_halflife: Floats | float
    """Spring of its heading."""
    bias: Floats | float
    """Advantage of staying."""
    trajectory: Floats | float
    """Weights of trajectory channels, beside those of the pose."""


NEUTRAL = 0.5
"""Responsiveness under which nothing is multiplied."""
QUALITY = Multiples(1.32, 1.14, 1.22, 0.71)
"""At responsiveness 0."""
RESPONSE = Multiples(0.8, 0.7, 0.4, 2.5)
"""At responsiveness 1."""


def multiples(responsiveness: Floats) -> Multiples:
    """Return what the settings of N characters are multiplied by.

    Args:
        responsiveness: `(N,)` from 0 to 1.
    """
    more = np.maximum(2.0 * responsiveness - 1.0, 0.0)
    less = np.maximum(1.0 - 2.0 * responsiveness, 0.0)
    powers = (
        np.asarray(low) ** less * np.asarray(high) ** more
        for low, high in zip(QUALITY, RESPONSE, strict=True)
    )
    return Multiples(*powers)
