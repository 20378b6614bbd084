"""Springs: exactness, the meaning of a halflife, and agreement with integration."""

import numpy as np
import pytest

from stridewire.motion import springs

TIGHT = 1e-12
"""Rounding of the exact exponentials in float64."""


def test_halflife_and_damping_are_inverse() -> None:
    """Both conversions undo each other."""
    assert springs.damping_to_halflife(springs.halflife_to_damping(0.27)) == pytest.approx(0.27)


def test_a_damper_leaves_half_after_its_halflife() -> None:
    """For a damper alone the halflife is one."""
    assert springs.damper_exact(np.array([4.0]), np.array([2.0]), 0.3, 0.3) == pytest.approx(3.0)


def test_a_spring_at_rest_leaves_59_7_percent_after_its_halflife() -> None:
    """What a spring's halflife h means: 59.7 % left at h, half at 1.21 h, 1 % at 4.79 h."""
    for time, left in ((1.0, 0.597), (1.21, 0.5), (2.81, 0.1), (4.79, 0.01)):
        x, _ = springs.decay_spring_damper_exact(np.array(1.0), np.array(0.0), 0.2, 0.2 * time)
        assert x == pytest.approx(left, abs=2e-3)


def test_one_long_step_equals_five_short_ones() -> None:
    """50 ms at once and five times 10 ms end alike, position, velocity and acceleration."""
    x, v, a = np.array([0.3, -1.0]), np.array([2.0, 0.1]), np.array([-1.0, 4.0])
    goal = np.array([1.4, 0.0])
    once = springs.velocity_spring_exact(x, v, a, goal, 0.27, 0.05)
    parts = (x, v, a)
    for _ in range(5):
        parts = springs.velocity_spring_exact(*parts, goal, 0.27, 0.01)
    np.testing.assert_allclose(parts, once, atol=TIGHT)

    once_at = springs.spring_damper_exact(x, v, goal, 0.2, 0.05)
    at = (x, v)
    for _ in range(5):
        at = springs.spring_damper_exact(*at, goal, 0.2, 0.01)
    np.testing.assert_allclose(at, once_at, atol=TIGHT)

    damped = x
    for _ in range(5):
        damped = springs.damper_exact(damped, goal, 0.2, 0.01)
    np.testing.assert_allclose(damped, springs.damper_exact(x, goal, 0.2, 0.05), atol=TIGHT)


def test_a_spring_solves_its_differential_equation() -> None:
    """The closed form is what small Euler steps of a critically damped spring approach."""
    halflife, goal, dt = 0.2, 1.0, 1e-5
    d = springs.halflife_to_damping(halflife)
    x, v = 0.0, 3.0
    for _ in range(20_000):
        acceleration = d * d / 4.0 * (goal - x) - d * v
        x, v = x + dt * v, v + dt * acceleration
    exact = springs.spring_damper_exact(
        np.array(0.0), np.array(3.0), np.array(goal), halflife, 20_000 * dt
    )
    np.testing.assert_allclose((x, v), exact, atol=1e-3)


def test_velocity_spring_differentiates_into_itself() -> None:
    """Velocity is the rate of the position, acceleration that of the velocity."""
    args = (np.array(0.5), np.array(2.0), np.array(-3.0), np.array(-1.0), 0.3)
    small = 1e-6
    before = springs.velocity_spring_exact(*args, 0.2 - small)
    at = springs.velocity_spring_exact(*args, 0.2)
    after = springs.velocity_spring_exact(*args, 0.2 + small)
    np.testing.assert_allclose((after[0] - before[0]) / (2 * small), at[1], atol=1e-6)
    np.testing.assert_allclose((after[1] - before[1]) / (2 * small), at[2], atol=1e-6)


def test_stopping_distance_is_speed_times_halflife_over_ln2() -> None:
    """From v0 to rest the velocity spring covers v0 h / ln2."""
    zero = np.array(0.0)
    x, v, a = springs.velocity_spring_exact(zero, np.array(4.0), zero, zero, 0.27, 60.0)
    assert x == pytest.approx(4.0 * 0.27 / np.log(2.0))
    assert (v, a) == (pytest.approx(0.0, abs=TIGHT), pytest.approx(0.0, abs=TIGHT))


def test_rows_may_have_their_own_step() -> None:
    """A row of 0 stands still while others move: a paused character beside running ones."""
    x, v = np.array([1.0, 1.0]), np.array([5.0, 5.0])
    moved, speed = springs.decay_spring_damper_exact(x, v, 0.2, np.array([0.0, 0.1]))
    assert (moved[0], speed[0]) == (1.0, 5.0)
    assert (moved[1], speed[1]) == springs.decay_spring_damper_exact(x[1], v[1], 0.2, 0.1)


def test_no_halflife_arrives_at_once() -> None:
    """A halflife of 0 is a jump, not a division by zero."""
    assert springs.damper_exact(np.array(1.0), np.array(3.0), 0.0, 1.0 / 60.0) == pytest.approx(3.0)


@pytest.mark.parametrize(("angle", "wrapped"), [(7.0, 7.0 - 2 * np.pi), (-4.0, 2 * np.pi - 4.0)])
def test_wrap_angle_takes_whole_turns_off(angle: float, wrapped: float) -> None:
    """The same heading comes back between -pi and pi."""
    assert springs.wrap_angle(np.array(angle)) == pytest.approx(wrapped)
