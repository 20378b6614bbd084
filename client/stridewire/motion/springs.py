"""Springs and dampers with exact exponentials: the result does not depend on the size of the step.

Names and formulas are those of Daniel Holden's *Spring-It-On: The Game Developer's
Spring-Roll-Call*. `halflife` is the time `h` in the damping `d = 4 ln2 / h`. **Only for a damper is
it a true half-life**; a critically damped spring at rest has 59.7 % of its offset left after `h`,
half after 1.21 h, 10 % after 2.81 h and 1 % after 4.79 h.

Arguments are arrays of one shape or scalars that broadcast; `dt` in seconds may differ by row, in
springs `halflife`, too. A scalar `dt` keeps the dtype of the arrays, so the tick stays in float32.
"""

from typing import Any

import numpy as np

from stridewire.motion.array_types import Floats

_LN2 = float(np.log(2.0))


def halflife_to_damping(halflife: Floats | float) -> Any:
    """Return the damping `d = 4 ln2 / h` in 1/s; a halflife of at least 1e-5 s is assumed."""
    return _weak(4.0 * _LN2 / np.maximum(halflife, 1e-5))


def damping_to_halflife(damping: float) -> float:
    """Return the halflife in seconds of a damping in 1/s."""
    return 4.0 * _LN2 / max(damping, 1e-5)


def damper_fraction(halflife: float, dt: Floats | float) -> Floats:
    """Return the share of the way to the goal that a damper goes in `dt`: `1 - 2^(-dt/h)`."""
    fraction: Floats = _weak(-np.expm1(-_LN2 * dt / max(halflife, 1e-5)))
    return fraction


def damper_exact(x: Floats, goal: Floats, halflife: float, dt: Floats | float) -> Floats:
    """Move `x` towards `goal`; half of the way is left after `halflife`."""
    return x + (goal - x) * damper_fraction(halflife, dt)


def spring_damper_exact(
    x: Floats, v: Floats, goal: Floats, halflife: Floats | float, dt: Floats | float
) -> tuple[Floats, Floats]:
    """Move position `x` with velocity `v` towards `goal`, critically damped.

    With `y = d/2`, `j0 = x - g`, `j1 = v + j0 y`: `x' = e^(-y dt)(j0 + j1 dt) + g`,
    `v' = e^(-y dt)(v - j1 y dt)`.

    Returns:
        Position and velocity after `dt`.
    """
    offset, velocity = decay_spring_damper_exact(x - goal, v, halflife, dt)
    return offset + goal, velocity


def decay_spring_damper_exact(
    x: Floats, v: Floats, halflife: Floats | float, dt: Floats | float
) -> tuple[Floats, Floats]:
    """Let an offset `x` with velocity `v` decay to zero, critically damped."""
    y = 0.5 * halflife_to_damping(halflife)
    j1 = v + x * y
    dt = _weak(dt)
    e = _weak(np.exp(-y * dt))
    return e * (x + j1 * dt), e * (v - j1 * (y * dt))


def velocity_spring_exact(
    x: Floats,
    v: Floats,
    a: Floats,
    goal_velocity: Floats,
    halflife: Floats | float,
    dt: Floats | float,
) -> tuple[Floats, Floats, Floats]:
    """Move a position whose velocity springs to `goal_velocity`: the character of the Roll-Call.

    With `y = d/2`, `j0 = v - g`, `j1 = a + j0 y`, `e = e^(-y dt)`:
    `x' = e(-j1/y^2 + (-j0 - j1 dt)/y) + j1/y^2 + j0/y + g dt + x`, `v' = e(j0 + j1 dt) + g`,
    `a' = e(a - j1 y dt)`. From velocity v0 to rest it covers `v0 h / ln2`.

    Returns:
        Position, velocity and acceleration after `dt`.
    """
    y = 0.5 * halflife_to_damping(halflife)
    j0 = v - goal_velocity
    j1 = a + j0 * y
    dt = _weak(dt)
    e = _weak(np.exp(-y * dt))
    position = e * (-j1 / (y * y) + (-j0 - j1 * dt) / y) + j1 / (y * y) + j0 / y
    return (
        position + goal_velocity * dt + x,
        e * (j0 + j1 * dt) + goal_velocity,
        e * (a - j1 * (y * dt)),
    )


def _weak(value: Floats | float) -> Any:
    """Make a scalar a Python float, which unlike `numpy.float64` does not widen float32 arrays."""
    return value if np.ndim(value) else float(value)


def wrap_angle(angle: Floats) -> Floats:
    """Return the same angle within -pi and pi."""
    return angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi))
