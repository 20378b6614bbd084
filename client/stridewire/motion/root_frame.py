"""Frames of roots: turned about +Y by a yaw, from +Z towards +X."""

import numpy as np

from stridewire.motion.array_types import Floats, Vectors


def turn_to_world(vectors: Vectors, yaw: Floats) -> Vectors:
    """Turn vectors `(N, ..., 3)` of the roots' frames by their yaws `(N,)`, radians."""
    shape = (-1, *(1,) * (vectors.ndim - 2))
    sine, cosine = np.sin(yaw).reshape(shape), np.cos(yaw).reshape(shape)
    x, z = vectors[..., 0], vectors[..., 2]
    out = np.empty(vectors.shape, np.result_type(vectors, yaw))
    out[..., 0] = x * cosine + z * sine
    out[..., 1] = vectors[..., 1]
    out[..., 2] = z * cosine - x * sine
    return out


def turn_to_root(vectors: Vectors, yaw: Floats) -> Vectors:
    """Turn vectors `(N, ..., 3)` of the world into the frames of roots of yaws `(N,)`, radians."""
    return turn_to_world(vectors, -yaw)
