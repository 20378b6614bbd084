"""Quaternions, vectors and springs of single characters, for kernels; tuples of floats.

The formulas are those of `stridewire.motion.quaternion` and `springs`; quaternions are w, x, y, z.
"""

import math

from stridewire_engine.compiled import kernel

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@kernel
def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the turn by `b`, then by `a`."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@kernel
def conjugate(q: Quaternion) -> Quaternion:
    """Return the turn back."""
    return q[0], -q[1], -q[2], -q[3]


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Return the cross product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def dot(a: Vector, b: Vector) -> float:
    """Return the inner product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def rotate(q: Quaternion, v: Vector) -> Vector:
    """Turn a vector."""
    u = (q[1], q[2], q[3])
    c = cross(u, v)
    t = (2.0 * c[0], 2.0 * c[1], 2.0 * c[2])
    d = cross(u, t)
    return v[0] + q[0] * t[0] + d[0], v[1] + q[0] * t[1] + d[1], v[2] + q[0] * t[2] + d[2]


@kernel
def from_scaled_axis(v: Vector) -> Quaternion:
    """Return the exponential of a rotation vector in radians."""
    square = dot(v, v)
    if square < 1e-4:
        # what follows in the series is below 1e-11, and most offsets are small
        scale = 0.5 - square / 48.0
        return (
            1.0 - square / 8.0 + square * square / 384.0,
            scale * v[0],
            scale * v[1],
            scale * v[2],
        )
    angle = math.sqrt(square)
    scale = math.sin(0.5 * angle) / angle
    return math.cos(0.5 * angle), scale * v[0], scale * v[1], scale * v[2]


@kernel
def to_scaled_axis(q: Quaternion) -> Vector:
    """Return the logarithm, the short way round."""
    sign = -1.0 if q[0] < 0.0 else 1.0
    w, v = sign * q[0], (sign * q[1], sign * q[2], sign * q[3])
    sine = math.sqrt(dot(v, v))
    scale = 2.0 if sine < 1e-5 else 2.0 * math.atan2(sine, w) / sine
    return scale * v[0], scale * v[1], scale * v[2]


@kernel
def decay(x: float, v: float, halflife: float, dt: float) -> tuple[float, float]:
    """Let an offset `x` with velocity `v` decay critically damped; see `springs`."""
    y, e = rate(halflife, dt)
    return decayed(x, v, y, e, dt)


@kernel
def rate(halflife: float, dt: float) -> tuple[float, float]:
    """Return what `decayed` needs of a half-life and a time, for many offsets that share both."""
    y = 2.0 * math.log(2.0) / halflife
    return y, math.exp(-y * dt)


@kernel
def decayed(x: float, v: float, y: float, e: float, dt: float) -> tuple[float, float]:
    """Do what `decay` does, half of the work done before."""
    j1 = v + x * y
    return e * (x + j1 * dt), e * (v - j1 * y * dt)


@kernel
def damper_fraction(halflife: float, dt: float) -> float:
    """Return the share of the way to the goal that a damper goes in `dt`."""
    return -math.expm1(-math.log(2.0) * dt / max(halflife, 1e-5))


@kernel
def wrap_angle(angle: float) -> float:
    """Return the same angle within -pi and pi."""
    return angle - 2.0 * math.pi * round(angle / (2.0 * math.pi))


@kernel
def to_world(v: Vector, sine: float, cosine: float) -> Vector:
    """Turn a vector of the root's frame by the root's yaw, given by its sine and cosine."""
    # the factor makes all three of one type, whatever that of the vector
    return v[0] * cosine + v[2] * sine, 1.0 * v[1], v[2] * cosine - v[0] * sine


@kernel
def to_root(v: Vector, sine: float, cosine: float) -> Vector:
    """Turn a vector of the world into the frame of a root of that yaw."""
    return v[0] * cosine - v[2] * sine, 1.0 * v[1], v[2] * cosine + v[0] * sine
