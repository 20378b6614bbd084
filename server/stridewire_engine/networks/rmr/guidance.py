"""Guidance: what the network says about a plan, as a stance-aware stitcher takes it.

The network says, once a token of four frames, where control points of cubic B-splines lie, and for
each frame whether a toe is planted. Curves are nothing before and at the first seam.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Indices, Vectors
from stridewire_engine.networks.rmr.features import PlanFrame
from stridewire_engine.networks.rmr.plans import TOKEN, Plans

CURVES = 12
"""Offsets of both toes, then turns of both feet; three numbers each."""
PLANTED = 2 * TOKEN
"""Numbers about contacts a token: by frame, then by foot."""
OFFSET_SCALE, TURN_SCALE = 0.1, 0.3
"""Metres and radians of a 1 of the network."""
_ONSET = 8.0
LABEL_LOGIT, LOGIT_SCALE = 3.0, 2.0
"""The clips' labels hold until the network says otherwise."""


class Guidance(NamedTuple):
    """What is to be done, for N plans of T frames, in the world."""

    planted: Floats
    """`(N, T, 2)` share from 0, swinging, to 1, planted: instead of the clips' labels."""
    toe_offset: Vectors
    """`(N, T, 2, 3)` metres to add to the clip's toe: where a swing should lead, and how high."""
    foot_turn: Vectors
    """`(N, T, 2, 3)` rotation vectors to turn the feet by, after their rotation in the world."""
    distance: Floats
    """`(N,)` from the training data; about 1 for plans like those."""


def guidance(plans: Plans, curves: Floats, contacts: Floats, distance: Floats) -> Guidance:
    """Return what the network's numbers mean.

    Args:
        plans: That it was asked about.
        curves: `(N, K, CURVES)` control values of K tokens.
        contacts: `(N, K, PLANTED)` logits.
        distance: `(N,)`.
    """
    n, frames = len(plans), plans.frames
    door = onset(plans.since_first)
    smooth: Floats = basis(frames) @ curves * door[..., None]
    smooth = PlanFrame.of(plans).leave(smooth.reshape(n, frames, 4, 3))
    logits = LOGIT_SCALE * contacts.reshape(n, frames, 2)
    logits = logits + np.where(plans.contacts, LABEL_LOGIT, -LABEL_LOGIT)
    before = (plans.since_first < 0)[..., None]
    planted = np.where(before, plans.contacts, 1.0 / (1.0 + np.exp(-logits)))
    return Guidance(
        planted, OFFSET_SCALE * smooth[:, :, :2], TURN_SCALE * smooth[:, :, 2:], distance
    )


def onset(since_first: Indices) -> Floats:
    """Return how far curves count `(N, T)`, so many frames after the first seam: smoothstep."""
    x = np.clip(since_first / _ONSET, 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))


@cache
def basis(frames: int) -> Floats:
    """Return cubic B-splines `(T, K)` of K tokens at T frames; each row sums to 1."""
    middle = (np.arange(frames // TOKEN) + 0.5) * TOKEN
    away = np.abs(np.arange(frames)[:, None] + 0.5 - middle) / TOKEN
    near = 2.0 / 3.0 - away**2 + 0.5 * away**3
    far = np.maximum(2.0 - away, 0.0) ** 3 / 6.0
    weights = np.where(away < 1.0, near, far)
    spline = np.asarray(weights / weights.sum(axis=1, keepdims=True))
    spline.flags.writeable = False
    return spline
