"""Springs do not depend on how time is cut into steps."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from stridewire.motion import springs

number = st.floats(-50.0, 50.0)
halflives = st.floats(0.02, 2.0)
steps = st.lists(st.floats(0.0, 0.25), min_size=1, max_size=6)


@given(number, number, number, halflives, steps)
def test_a_spring_forgets_how_time_was_cut(
    x: float, v: float, goal: float, halflife: float, dts: list[float]
) -> None:
    """Any steps with the same sum end alike."""
    at = (np.array(x), np.array(v))
    for dt in dts:
        at = springs.spring_damper_exact(*at, np.array(goal), halflife, dt)
    once = springs.spring_damper_exact(np.array(x), np.array(v), np.array(goal), halflife, sum(dts))
    np.testing.assert_allclose(at, once, atol=1e-8)


@given(number, number, number, number, halflives, steps)
def test_a_velocity_spring_forgets_how_time_was_cut(
    x: float, v: float, a: float, goal: float, halflife: float, dts: list[float]
) -> None:
    """Position, velocity and acceleration end alike."""
    at = (np.array(x), np.array(v), np.array(a))
    for dt in dts:
        at = springs.velocity_spring_exact(*at, np.array(goal), halflife, dt)
    once = springs.velocity_spring_exact(
        np.array(x), np.array(v), np.array(a), np.array(goal), halflife, sum(dts)
    )
    np.testing.assert_allclose(at, once, atol=1e-7)


@given(number, number, halflives, st.floats(0.0, 10.0))
def test_a_spring_at_rest_never_overshoots(
    x: float, goal: float, halflife: float, dt: float
) -> None:
    """Critical damping: from rest the goal is approached from one side only."""
    after, _ = springs.spring_damper_exact(np.array(x), np.array(0.0), np.array(goal), halflife, dt)
    assert min(x, goal) - 1e-9 <= after <= max(x, goal) + 1e-9


@given(st.floats(-1e4, 1e4))
def test_a_wrapped_angle_is_the_same_direction_within_half_a_turn(angle: float) -> None:
    """Sine and cosine stay; the size is at most pi."""
    wrapped = springs.wrap_angle(np.array(angle))
    assert abs(wrapped) <= np.pi + 1e-9
    np.testing.assert_allclose(
        (np.sin(wrapped), np.cos(wrapped)), (np.sin(angle), np.cos(angle)), atol=1e-8
    )
