"""Quaternions `(..., 4)` in the order w, x, y, z, over arrays of any shape.

Rotations are active and right-handed; `multiply(a, b)` turns by `b` first. The dtype of the inputs
is kept, so the tick stays in float32 and building in float64. Scaled axes are rotation vectors
`(..., 3)` in radians, so `from_scaled_axis` is the exponential of a rotation and `to_scaled_axis`
its logarithm.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.springs import wrap_angle

IDENTITY = (1.0, 0.0, 0.0, 0.0)
"""The quaternion that turns nothing."""

_SMALL_ANGLE = 1e-5
"""Below this the sine over its angle is 1 to double precision's square root."""


def identity(*shape: int, dtype: type = np.float32) -> Quaternions:
    """Return identity quaternions `(*shape, 4)`."""
    out: Quaternions = np.zeros((*shape, 4), dtype)
    out[..., 0] = 1.0
    return out


def multiply(a: Quaternions, b: Quaternions) -> Quaternions:
    """Return the Hamilton product: turn by `b`, then by `a`.

    Args:
        a: `(..., 4)`.
        b: `(..., 4)`, broadcast against `a`.
    """
    # q = c + d j with complex c = w + xi, d = y + zi: 4 complex products are a third of the passes
    first, second = _complex(a), _complex(b)
    c, d, e, f = first[..., 0], first[..., 1], second[..., 0], second[..., 1]
    head = c * e - d * f.conj()
    out = np.empty((*head.shape, 2), head.dtype)
    out[..., 0] = head
    np.add(c * f, d * e.conj(), out=out[..., 1])
    return np.asarray(out.view(head.real.dtype))


def _complex(q: Quaternions) -> Any:
    """View quaternions as pairs of complex numbers `(..., 2)`; copies only where it has to."""
    kind = np.complex128 if q.dtype == np.float64 else np.complex64
    return np.ascontiguousarray(q).view(kind)


def conjugate(q: Quaternions) -> Quaternions:
    """Return the inverse of unit quaternions `(..., 4)`."""
    out = -q
    out[..., 0] = q[..., 0]
    return out


def rotate(q: Quaternions, v: Vectors) -> Vectors:
    """Turn vectors `(..., 3)` by unit quaternions `(..., 4)`."""
    u = q[..., 1:]
    t = 2.0 * cross(u, v)
    return v + q[..., :1] * t + cross(u, t)


def cross(a: Vectors, b: Vectors) -> Vectors:
    """Return the cross product of `(..., 3)` vectors, without the bookkeeping of `numpy.cross`."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    x = ay * bz - az * by
    out = np.empty((*x.shape, 3), x.dtype)
    out[..., 0] = x
    out[..., 1] = az * bx - ax * bz
    out[..., 2] = ax * by - ay * bx
    return out


def dot(a: Floats, b: Floats) -> Floats:
    """Return the inner product over the last axis; faster than numpy's sum for 3 or 4 numbers."""
    total = a[..., 0] * b[..., 0]
    for i in range(1, a.shape[-1]):
        total += a[..., i] * b[..., i]
    return np.asarray(total)


def normalize(q: Quaternions) -> Quaternions:
    """Scale `(..., 4)` to unit length.

    Raises:
        ValueError: If one has no length.
    """
    length = np.sqrt(np.sum(q * q, axis=-1, keepdims=True))
    if not np.all(length > 0.0):
        raise ValueError(
            "a quaternion has zero length or is NaN; expected unit quaternions w, x, y, z"
        )
    return np.asarray(q / length)


def absolute(q: Quaternions) -> Quaternions:
    """Choose of `q` and `-q` the one with w >= 0: the short way round."""
    return np.where(q[..., :1] < 0.0, -q, q)


def unroll(q: Quaternions) -> Quaternions:
    """Flip signs along the first axis so that neighbours lie in one hemisphere.

    Args:
        q: `(T, ..., 4)`.
    """
    dots = np.sum(q[1:] * q[:-1], axis=-1, keepdims=True)
    signs = np.cumprod(np.where(dots < 0.0, -1.0, 1.0), axis=0).astype(q.dtype)
    return np.concatenate([q[:1], q[1:] * signs], axis=0)


def from_scaled_axis(v: Vectors) -> Quaternions:
    """Return the exponential of rotation vectors `(..., 3)` in radians."""
    angle = np.sqrt(dot(v, v))[..., None]
    half = 0.5 * angle
    safe = np.where(angle < _SMALL_ANGLE, 1.0, angle)
    scale = np.where(angle < _SMALL_ANGLE, 0.5, np.sin(half) / safe)
    return np.concatenate([np.cos(half), v * scale], axis=-1).astype(v.dtype)


def to_scaled_axis(q: Quaternions) -> Vectors:
    """Return the logarithm: rotation vectors `(..., 3)` of at most pi radians."""
    q = absolute(q)
    v = q[..., 1:]
    sine = np.sqrt(dot(v, v))[..., None]
    angle = 2.0 * np.arctan2(sine, q[..., :1])
    safe = np.where(sine < _SMALL_ANGLE, 1.0, sine)
    return (v * np.where(sine < _SMALL_ANGLE, 2.0, angle / safe)).astype(q.dtype)


def scaled_axis_to_velocity(v: Vectors, rate: Vectors) -> Vectors:
    """Return the angular velocity of `from_scaled_axis(v)` while `v` changes at `rate`.

    The left Jacobian of SO(3): `rate + (1 - cos a)/a^2 v x rate + (a - sin a)/a^3 v x (v x rate)`.

    Args:
        v: `(..., 3)` rotation vectors of angle a, radians.
        rate: `(..., 3)` their rates of change, rad/s.
    """
    angle = np.sqrt(dot(v, v))[..., None]
    safe = np.maximum(angle, 1e-2)
    first = np.where(angle < 1e-2, 0.5, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(angle < 1e-2, 1.0 / 6.0, (safe - np.sin(safe)) / safe**3)
    once = cross(v, rate)
    return (rate + first * once + second * cross(v, once)).astype(rate.dtype)


def scaled_axis_from_velocity(v: Vectors, velocity: Vectors) -> Vectors:
    """Return the rate of change of `v` that gives an angular velocity: the inverse of the above.

    `velocity - v x velocity / 2 + (1/a^2 - cot(a/2)/(2a)) v x (v x velocity)`.

    Args:
        v: `(..., 3)` rotation vectors of angle a below a full turn, radians.
        velocity: `(..., 3)` angular velocities, rad/s.
    """
    angle = np.sqrt(dot(v, v))[..., None]
    safe = np.maximum(angle, 1e-1)
    exact = 1.0 / safe**2 - 1.0 / (2.0 * safe * np.tan(0.5 * safe))
    once = cross(v, velocity)
    second = np.where(angle < 1e-1, 1.0 / 12.0, exact)
    return (velocity - 0.5 * once + second * cross(v, once)).astype(velocity.dtype)


def from_axis_angle(axis: Vectors | Sequence[float], angle: Floats | float) -> Quaternions:
    """Turn by `angle` radians about a unit `axis`.

    Args:
        axis: `(..., 3)`.
        angle: `(...)`, broadcast against `axis`.
    """
    arrays = [a for a in (axis, angle) if isinstance(a, np.ndarray)]
    dtype = np.result_type(*arrays, np.float32) if arrays else np.float64
    half = 0.5 * np.asarray(angle, dtype)[..., None]
    v = np.asarray(axis, dtype) * np.sin(half)
    return np.concatenate([np.broadcast_to(np.cos(half), (*v.shape[:-1], 1)), v], axis=-1)


def from_yaw(yaw: Floats) -> Quaternions:
    """Turn by `yaw` radians `(...)` about +Y: from +Z towards +X."""
    out = np.zeros((*yaw.shape, 4), yaw.dtype)
    out[..., 0] = np.cos(0.5 * yaw)
    out[..., 2] = np.sin(0.5 * yaw)
    return out


def to_yaw(q: Quaternions) -> Floats:
    """Return the heading `(...)` in radians of the turned +Z axis, projected to the ground."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.asarray(np.arctan2(2.0 * (x * z + w * y), 1.0 - 2.0 * (x * x + y * y)))


def between(a: Vectors, b: Vectors) -> Quaternions:
    """Return the shortest turn that takes direction `a` to direction `b`.

    Args:
        a: `(..., 3)`, any length but zero.
        b: `(..., 3)`, any length but zero; for opposite directions the axis is arbitrary.
    """
    a = a / np.sqrt(dot(a, a))[..., None]
    b = b / np.sqrt(dot(b, b))[..., None]
    w = 1.0 + dot(a, b)[..., None]
    other = np.where(np.abs(a[..., :1]) < 0.9, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    opposite = w < 1e-7
    axis = np.where(opposite, cross(a, other.astype(a.dtype)), cross(a, b))
    return normalize(np.concatenate([np.where(opposite, 0.0, w), axis], axis=-1).astype(a.dtype))


def nlerp(a: Quaternions, b: Quaternions, weight: Floats) -> Quaternions:
    """Blend on the short side and normalise; a weight `(...)` of 0 gives `a`, 1 gives `b`."""
    other = np.copysign(weight, weight * dot(a, b))
    mix = a * (1.0 - weight)[..., None]
    mix += b * other[..., None]
    mix /= np.sqrt(dot(mix, mix))[..., None]
    return mix


def slerp(a: Quaternions, b: Quaternions, weight: Floats) -> Quaternions:
    """Turn from `a` to `b` at constant speed on the short side; weight `(...)` broadcasts."""
    step = to_scaled_axis(multiply(b, conjugate(a)))
    return multiply(from_scaled_axis(step * weight[..., None]), a)


def angular_velocity(q: Quaternions, dt: float) -> Vectors:
    """Return parent-space angular velocities `(T, ..., 3)` in rad/s by central differences.

    The first and the last frame repeat their neighbour's one-sided difference.

    Args:
        q: `(T, ..., 4)` with T >= 2.
        dt: Seconds between frames.
    """
    step = to_scaled_axis(multiply(q[1:], conjugate(q[:-1]))) / dt
    out = np.empty((*q.shape[:-1], 3), q.dtype)
    out[0], out[-1] = step[0], step[-1]
    out[1:-1] = 0.5 * (step[1:] + step[:-1])
    return out


def from_euler(angles: Floats, order: str) -> Quaternions:
    """Turn about the named axes, the last letter first: BVH's intrinsic channel order.

    Args:
        angles: `(..., len(order))` radians, one for each letter.
        order: Letters of `xyz`, for instance `zyx`.
    """
    axes = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
    out = identity(*angles.shape[:-1], dtype=angles.dtype.type)
    for i, letter in enumerate(order.lower()):
        out = multiply(out, from_axis_angle(axes[letter], angles[..., i]).astype(angles.dtype))
    return out


def to_euler_zyx(q: Quaternions) -> Floats:
    """Return angles `(..., 3)` in radians, z, y, x, such that `from_euler(..., "zyx")` gives `q`.

    By sum and difference of the outer angles (Bernardes and Viollet, *Quaternion to Euler angles
    conversion*, 2022), so that a turn of 90 degrees about y, an arm held forward, loses nothing.
    """
    w, x, y, z = np.moveaxis(q, -1, 0)
    half_sum = np.arctan2(z + x, w - y)
    half_difference = np.arctan2(z - x, w + y)
    middle = 2.0 * np.arctan2(np.hypot(z - x, w + y), np.hypot(z + x, w - y)) - 0.5 * np.pi
    return np.stack(
        [wrap_angle(half_sum + half_difference), middle, wrap_angle(half_sum - half_difference)],
        axis=-1,
    )
