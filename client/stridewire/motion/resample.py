"""Resampling with continuous velocities: for import; the tick uses nlerp between 60 fps frames."""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors


def resample_values(values: Floats, rate: float, new_rate: float) -> Floats:
    """Resample `(T, ...)` values by cubic Hermite curves with Catmull-Rom tangents."""
    first, x = _knots(len(values), rate, new_rate)
    a, b = values[first], values[first + 1]
    tangent = np.gradient(values, axis=0)
    x = x.reshape(-1, *(1,) * (values.ndim - 1))
    h1, h2, h3 = _hermite(x)
    curve = a + h1 * (b - a) + h2 * tangent[first] + h3 * tangent[first + 1]
    return np.asarray(curve, values.dtype)


def resample_rotations(q: Quaternions, rate: float, new_rate: float) -> Quaternions:
    """Resample `(T, ..., 4)` rotations with continuous angular velocity.

    Catmull-Rom on scaled axes relative to the frame before (Holden, *Cubic Interpolation of
    Quaternions*), the tangent at the far end turned into the rate of the scaled axis that gives it
    by the inverse left Jacobian of the rotation group; slerp would make the angular velocity jump
    at every frame.
    """
    first, x = _knots(len(q), rate, new_rate)
    step = quaternion.to_scaled_axis(quaternion.multiply(q[1:], quaternion.conjugate(q[:-1])))
    tangent = np.empty((*q.shape[:-1], 3), q.dtype)
    tangent[0], tangent[-1] = step[0], step[-1]
    tangent[1:-1] = 0.5 * (step[1:] + step[:-1])
    h1, h2, h3 = _hermite(x.reshape(-1, *(1,) * (q.ndim - 1)))
    far = _scaled_axis_rate(step[first], tangent[first + 1])
    turn = h1 * step[first] + h2 * tangent[first] + h3 * far
    return quaternion.unroll(
        quaternion.multiply(quaternion.from_scaled_axis(turn), q[first]).astype(q.dtype)
    )


def _scaled_axis_rate(v: Vectors, angular_velocity: Vectors) -> Vectors:
    """Return how fast a scaled axis `v` changes while its rotation turns, to fourth order."""
    once = quaternion.cross(v, angular_velocity)
    return np.asarray(angular_velocity - 0.5 * once + quaternion.cross(v, once) / 12.0)


def _knots(frames: int, rate: float, new_rate: float) -> tuple[np.ndarray, Floats]:
    if frames < 2:
        raise ValueError(f"{frames} frame(s) cannot be resampled; expected at least 2")
    # a little slack, or rounding drops the last frame
    count = int(np.floor((frames - 1) / rate * new_rate + 1e-6)) + 1
    at = np.arange(count) * (rate / new_rate)
    first = np.minimum(at.astype(np.intp), frames - 2)
    return first, at - first


def _hermite(x: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the weights of the difference and of both tangents at `x` from 0 to 1."""
    return 3 * x**2 - 2 * x**3, x**3 - 2 * x**2 + x, x**3 - x**2
