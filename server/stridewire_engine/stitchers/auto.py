"""`auto`: for each transition the stitcher that hides it best.

Where planted toes lie close to where the new clip has them, or land so late that a spring has
closed the gap by then, a spring is back with the clip soonest and slides no foot. Anywhere else
feet have to be planted, which `refine` does, or `stance` where the network does not fit.
"""

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Vectors
from stridewire_engine.stitchers.footing import decay

_SPRING_HALFLIFE = 0.1
_MOST_SLIDING = 0.015
"""Metres that a planted toe may be dragged."""


def spring_will_do(gap: Vectors, gap_velocity: Vectors, planted: Flags, times: Floats) -> Flags:
    """Tell for which of N transitions a spring drags no planted toe far.

    Args:
        gap: `(N, 2, 3)` from the new clip's toes to the shown ones, in the world.
        gap_velocity: `(N, 2, 3)` its rate of change.
        planted: `(N, K, 2)` the new clip's labels at K times ahead.
        times: `(K,)` seconds, from 0.
    """
    halflife, passed = np.full(1, _SPRING_HALFLIFE), times[None, :, None, None]
    left, _ = decay(gap[:, None], gap_velocity[:, None], halflife, passed)
    far = np.hypot(left[..., 0], left[..., 2])
    return np.asarray((np.where(planted, far, 0.0) <= _MOST_SLIDING).all(axis=(1, 2)))
