"""Identities of rotations that hold for any input."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions

TOLERANCE = 1e-9
"""Float64 rounding, enlarged where an angle comes near half a turn."""


def vectors(limit: float) -> st.SearchStrategy[Floats]:
    """Return a strategy of vectors `(3,)` whose components stay within a limit."""
    return arrays(np.float64, 3, elements=st.floats(-limit, limit))


rotations: st.SearchStrategy[Quaternions] = vectors(3.0).map(quaternion.from_scaled_axis)


@given(rotations, rotations, vectors(100.0))
def test_turning_twice_is_turning_by_the_product(a: Quaternions, b: Quaternions, v: Floats) -> None:
    """`multiply(a, b)` turns by b, then by a."""
    twice = quaternion.rotate(a, quaternion.rotate(b, v))
    np.testing.assert_allclose(quaternion.rotate(quaternion.multiply(a, b), v), twice, atol=1e-7)


@given(rotations, vectors(100.0))
def test_turning_keeps_lengths(q: Quaternions, v: Floats) -> None:
    """No rotation stretches a vector."""
    np.testing.assert_allclose(
        np.linalg.norm(quaternion.rotate(q, v)), np.linalg.norm(v), atol=1e-7
    )


@given(vectors(1.8))
def test_logarithm_undoes_the_exponential_below_half_a_turn(v: Floats) -> None:
    """Rotation vectors shorter than pi come back; tiny ones to second order."""
    back = quaternion.to_scaled_axis(quaternion.from_scaled_axis(v))
    np.testing.assert_allclose(back, v, atol=TOLERANCE)


@given(rotations)
def test_exponential_undoes_the_logarithm(q: Quaternions) -> None:
    """Any rotation comes back as itself or its negative."""
    back = quaternion.from_scaled_axis(quaternion.to_scaled_axis(q))
    np.testing.assert_allclose(abs(back @ q), 1.0, atol=TOLERANCE)


@given(rotations)
def test_euler_angles_give_the_rotation(q: Quaternions) -> None:
    """Angles z, y, x of any rotation give it again, gimbal lock included."""
    back = quaternion.from_euler(quaternion.to_euler_zyx(q), "zyx")
    np.testing.assert_allclose(abs(back @ q), 1.0, atol=TOLERANCE)


@given(rotations, rotations, st.floats(0.0, 1.0))
def test_blends_are_unit_and_no_longer_than_the_short_way(
    a: Quaternions, b: Quaternions, weight: float
) -> None:
    """Both ways to blend stay on the short arc between their ends."""
    arc = np.linalg.norm(quaternion.to_scaled_axis(quaternion.multiply(b, quaternion.conjugate(a))))
    for blend in (quaternion.nlerp, quaternion.slerp):
        q = blend(a, b, np.array(weight))
        np.testing.assert_allclose(np.linalg.norm(q), 1.0, atol=TOLERANCE)
        turn = quaternion.to_scaled_axis(quaternion.multiply(q, quaternion.conjugate(a)))
        assert np.linalg.norm(turn) <= arc + 1e-6


@given(vectors(5.0), vectors(5.0))
def test_between_aligns_any_two_directions(a: Floats, b: Floats) -> None:
    """Nearly parallel and nearly opposite directions included."""
    a, b = a + np.array([1e-3, 0.0, 6.0]), b + np.array([0.0, 6.0, 1e-3])
    turned = quaternion.rotate(quaternion.between(a, b), a / np.linalg.norm(a))
    np.testing.assert_allclose(turned, b / np.linalg.norm(b), atol=1e-6)
