"""Corrections: from a linear blend to the posture in between.

`posture(t) = linear(t) + 4 t (1 - t) b tanh(sum over k of P_k(2 t - 1) c_k / b)`, rotations by the
exponential of a rotation vector, P_k the Legendre polynomials. The network gives the c_k once a
pair; the correction is a smooth curve of the weight, nothing at both ends, and never more than b.
"""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire_engine.networks.blend.features import JOINTS
from stridewire_engine.networks.blend.postures import Postures

ORDER = 4
"""Polynomials a channel."""
CHANNELS = 3 + 3 * JOINTS
"""Hips translation, then a rotation vector a joint."""


def linear(start: Postures, end: Postures, weights: Floats) -> Postures:
    """Blend hips linearly and rotations at constant speed on the short side.

    Args:
        start: Leading shape `(...)`.
        end: The same.
        weights: `(..., J)` weight of each joint, broadcast; the first joint's moves the hips.

    Returns:
        Where a weight is 0 or 1 the very numbers of the start or the end.
    """
    hips, each = weights[..., :1], weights[..., None]
    a, b = start.rotations, end.rotations
    rotations = quaternion.slerp(a, b, weights)
    rotations = np.where(each == 0.0, a, np.where(each == 1.0, b, rotations))
    return Postures(start.hips * (1.0 - hips) + end.hips * hips, rotations)


def curve(weights: Floats) -> Floats:
    """Return the polynomials `(..., ORDER)` at weights `(...)`."""
    x = 2.0 * weights - 1.0
    return np.stack([np.ones_like(x), x, 1.5 * x**2 - 0.5, 2.5 * x**3 - 1.5 * x], axis=-1)


def gate(weights: Floats) -> Floats:
    """Return `4 t (1 - t)`: 0 at both ends, 1 between them."""
    return 4.0 * weights * (1.0 - weights)


def correct(between: Postures, coefficients: Floats, bounds: Floats, weights: Floats) -> Postures:
    """Add corrections to linear blends.

    Args:
        between: Leading shape `(...)`.
        coefficients: `(..., ORDER, CHANNELS)`, broadcast; metres and radians.
        bounds: `(CHANNELS,)` largest correction.
        weights: `(..., J)`.
    """
    of_channel = np.concatenate([weights[..., :1].repeat(3, -1), weights.repeat(3, -1)], axis=-1)
    raw = np.einsum("...ck,...kc->...c", curve(of_channel), coefficients)
    bounded = gate(of_channel) * bounds * np.tanh(raw / bounds)
    turns = bounded[..., 3:].reshape(*bounded.shape[:-1], JOINTS, 3)
    turned = quaternion.multiply(between.rotations, quaternion.from_scaled_axis(turns))
    # the ends stay the very numbers
    moved = turns.any(axis=-1, keepdims=True)
    return Postures(between.hips + bounded[..., :3], np.where(moved, turned, between.rotations))


def settle_ends(between: Postures, generated: Postures, weights: Floats) -> Postures:
    """Blend generated postures into linear ones by `(2 t - 1)^4` (Gaisbauer et al. 2019, 3.5).

    Args:
        between: Linear blends of leading shape `(...)`.
        generated: The same.
        weights: `(..., J)`.
    """
    share = (2.0 * weights - 1.0) ** 4
    # the very numbers at the ends
    rotations = np.where(
        share[..., None] == 1.0,
        between.rotations,
        quaternion.slerp(generated.rotations, between.rotations, share),
    )
    hips = share[..., :1]
    return Postures(generated.hips * (1.0 - hips) + between.hips * hips, rotations)
