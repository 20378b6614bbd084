"""Capsules: the body's boxes in a form with slopes, so that training can push them apart."""

import numpy as np
import torch
from torch import Tensor

from stridewire.motion.array_types import Floats
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.evaluation.body_boxes import BOXES, admissible_pairs
from stridewire_models.blend.rotations import rotate

_ROUNDING = 1.15
"""A capsule's radius over the half size of its box: corners stick out."""
_MARGIN = 0.01
_PAIRS = admissible_pairs()
_JOINTS = REFERENCE.indices([box.joint for box in BOXES])
_RADIUS = np.array([_ROUNDING * box.half[1:].mean() for box in BOXES])


def _ends(sign: float) -> Floats:
    """Return one end `(15, 3)` of the boxes' axes, from their joints at rest."""
    return np.stack([box.middle + sign * box.half[0] * box.axes[0] for box in BOXES])


_NEAR, _FAR = _ends(-1.0), _ends(1.0)


def penetration(joints: Tensor, turns: Tensor) -> Tensor:
    """Return by how much admissible pairs of capsules overlap `(..., P)`, with a margin; metres.

    Args:
        joints: `(..., J, 3)` positions.
        turns: `(..., J, 4)` rotations in the same space.
    """
    at, turn = joints[..., _JOINTS, :], turns[..., _JOINTS, :]
    near = at + rotate(turn, torch.tensor(_NEAR, dtype=at.dtype))
    far = at + rotate(turn, torch.tensor(_FAR, dtype=at.dtype))
    a, b = _PAIRS[:, 0], _PAIRS[:, 1]
    apart = _distance(near[..., a, :], far[..., a, :], near[..., b, :], far[..., b, :])
    reach = torch.tensor(_RADIUS[a] + _RADIUS[b] + _MARGIN, dtype=at.dtype)
    return torch.relu(reach - apart)


def _distance(p: Tensor, p_end: Tensor, q: Tensor, q_end: Tensor) -> Tensor:
    """Return the distance `(...)` of segments (Ericson, Real-Time Collision Detection, 5.1.9)."""
    u, v, w = p_end - p, q_end - q, p - q
    a, e = _dot(u, u), _dot(v, v)
    b, c, f = _dot(u, v), _dot(u, w), _dot(v, w)
    s = ((b * f - c * e) / (a * e - b * b).clamp_min(1e-9)).clamp(0.0, 1.0)
    t = ((b * s + f) / e).clamp(0.0, 1.0)
    s = ((b * t - c) / a).clamp(0.0, 1.0)
    between = w + s[..., None] * u - t[..., None] * v
    return torch.sqrt(_dot(between, between) + 1e-12)


def _dot(a: Tensor, b: Tensor) -> Tensor:
    return torch.sum(a * b, dim=-1)
