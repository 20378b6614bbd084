"""Quaternions: identities, inverses and agreement with SciPy's rotations."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions

EXACT = 1e-12
"""Rounding of a few float64 operations."""

Maker = Callable[..., Quaternions]


def scipy_rotation(q: Quaternions) -> Rotation:
    """Return SciPy's rotation, which puts w last."""
    return Rotation.from_quat(np.roll(q, -1, axis=-1))


def same_turn(a: Quaternions, b: Quaternions, tolerance: float = EXACT) -> None:
    """Assert that two arrays turn alike, whatever their signs."""
    dots = np.abs(np.sum(a * b, axis=-1))
    np.testing.assert_allclose(dots, 1.0, atol=tolerance)


def test_multiply_turns_by_the_second_first(random_rotations: Maker) -> None:
    """The product's order is that of active rotations."""
    a, b = random_rotations(50), random_rotations(50)
    same_turn(
        quaternion.multiply(a, b),
        np.roll((scipy_rotation(a) * scipy_rotation(b)).as_quat(), 1, axis=-1),
    )


def test_multiply_broadcasts(random_rotations: Maker) -> None:
    """One quaternion turns a whole batch."""
    one, many = random_rotations(1)[0], random_rotations(5, 3)
    assert quaternion.multiply(one, many).shape == (5, 3, 4)
    np.testing.assert_array_equal(
        quaternion.multiply(one, many)[2, 1], quaternion.multiply(one, many[2, 1])
    )


def test_conjugate_undoes(random_rotations: Maker) -> None:
    """A rotation times its conjugate turns nothing."""
    q = random_rotations(50)
    np.testing.assert_allclose(
        quaternion.multiply(q, quaternion.conjugate(q)),
        np.tile(quaternion.IDENTITY, (50, 1)),
        atol=EXACT,
    )


def test_rotate_agrees_with_scipy(random_rotations: Maker, rng: np.random.Generator) -> None:
    """Vectors turn as SciPy turns them."""
    q, v = random_rotations(50), rng.normal(size=(50, 3))
    np.testing.assert_allclose(quaternion.rotate(q, v), scipy_rotation(q).apply(v), atol=EXACT)


def test_rotate_by_a_yaw_takes_forward_to_the_left() -> None:
    """A positive yaw turns +Z towards +X, the character's left."""
    turned = quaternion.rotate(quaternion.from_yaw(np.array(np.pi / 2)), np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(turned, [1.0, 0.0, 0.0], atol=EXACT)


def test_cross_equals_numpy(rng: np.random.Generator) -> None:
    """The short form of the cross product is the cross product."""
    a, b = rng.normal(size=(2, 20, 3))
    np.testing.assert_allclose(quaternion.cross(a, b), np.cross(a, b), atol=EXACT)


@pytest.mark.parametrize("bad", [0.0, np.nan])
def test_normalize_refuses_what_has_no_direction(bad: float) -> None:
    """Zero length and NaN are errors, not silent NaN."""
    with pytest.raises(ValueError, match="unit quaternions"):
        quaternion.normalize(np.full((2, 4), bad))


def test_absolute_is_the_same_turn_with_w_not_negative(random_rotations: Maker) -> None:
    """The short way round is the same rotation."""
    q = random_rotations(50)
    short = quaternion.absolute(q)
    assert np.all(short[:, 0] >= 0.0)
    same_turn(short, q)


def test_unroll_keeps_neighbours_in_one_hemisphere(
    random_rotations: Maker, rng: np.random.Generator
) -> None:
    """Random sign flips along a smooth track are taken back."""
    step = quaternion.from_scaled_axis(rng.normal(size=(40, 3)) * 0.1)
    track = [random_rotations(1)[0]]
    for turn in step:
        track.append(quaternion.multiply(turn, track[-1]))
    smooth = np.array(track)
    flipped = smooth * rng.choice([-1.0, 1.0], (41, 1))
    flipped[0] = smooth[0]
    np.testing.assert_allclose(quaternion.unroll(flipped), smooth, atol=EXACT)


def test_exponential_agrees_with_scipy(rng: np.random.Generator) -> None:
    """Rotation vectors mean what SciPy's mean, tiny ones included."""
    v = rng.normal(size=(60, 3)) * np.logspace(-9, 0.5, 60)[:, None]
    same_turn(
        quaternion.from_scaled_axis(v), np.roll(Rotation.from_rotvec(v).as_quat(), 1, axis=-1)
    )


def test_logarithm_takes_the_short_way(random_rotations: Maker) -> None:
    """No rotation vector is longer than half a turn, whatever the quaternion's sign."""
    q = random_rotations(200)
    v = quaternion.to_scaled_axis(q)
    assert np.all(np.linalg.norm(v, axis=-1) <= np.pi + EXACT)
    np.testing.assert_allclose(v, quaternion.to_scaled_axis(-q), atol=EXACT)


def test_from_axis_angle_broadcasts_axis_and_angle() -> None:
    """One axis takes many angles, and many axes one angle."""
    angles = np.linspace(-3.0, 3.0, 7)
    about_y = quaternion.from_axis_angle((0.0, 1.0, 0.0), angles)
    np.testing.assert_allclose(about_y, quaternion.from_yaw(angles), atol=EXACT)
    assert quaternion.from_axis_angle(np.eye(3), 0.5).shape == (3, 4)


def test_yaw_comes_back() -> None:
    """Heading to quaternion to heading is the same heading."""
    yaw = np.linspace(-3.1, 3.1, 63)
    np.testing.assert_allclose(quaternion.to_yaw(quaternion.from_yaw(yaw)), yaw, atol=EXACT)


def test_yaw_of_a_leaning_body_is_its_forward_axis_on_the_ground(random_rotations: Maker) -> None:
    """The heading is that of the turned +Z axis."""
    q = random_rotations(50)
    forward = quaternion.rotate(q, np.broadcast_to([0.0, 0.0, 1.0], (50, 3)))
    np.testing.assert_allclose(
        quaternion.to_yaw(q), np.arctan2(forward[:, 0], forward[:, 2]), atol=1e-10
    )


def test_between_takes_one_direction_to_the_other(rng: np.random.Generator) -> None:
    """The turn works for vectors of any length, by the least angle."""
    a, b = rng.normal(size=(2, 50, 3)) * 3.0
    turn = quaternion.between(a, b)
    turned = quaternion.rotate(turn, a)
    np.testing.assert_allclose(
        turned / np.linalg.norm(turned, axis=-1, keepdims=True),
        b / np.linalg.norm(b, axis=-1, keepdims=True),
        atol=1e-9,
    )
    cosine = np.sum(a * b, -1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    angle = np.linalg.norm(quaternion.to_scaled_axis(turn), axis=-1)
    np.testing.assert_allclose(angle, np.arccos(cosine), atol=1e-9)


@pytest.mark.parametrize("axis", np.eye(3).tolist())
def test_between_opposite_directions_is_half_a_turn(axis: list[float]) -> None:
    """Opposite directions have no one shortest turn; any is right."""
    a = np.array(axis)
    np.testing.assert_allclose(quaternion.rotate(quaternion.between(a, -a), a), -a, atol=1e-9)


def test_nlerp_has_its_ends_and_takes_the_short_side(random_rotations: Maker) -> None:
    """Weights 0 and 1 give the ends, and a sign flip of one end changes no turn."""
    a, b = random_rotations(30), random_rotations(30)
    same_turn(quaternion.nlerp(a, b, np.zeros(30)), a)
    same_turn(quaternion.nlerp(a, b, np.ones(30)), b)
    half = np.full(30, 0.5)
    same_turn(quaternion.nlerp(a, b, half), quaternion.nlerp(a, -b, half))
    angle = np.linalg.norm(
        quaternion.to_scaled_axis(
            quaternion.multiply(quaternion.nlerp(a, b, half), quaternion.conjugate(a))
        ),
        axis=-1,
    )
    assert np.all(angle <= np.pi / 2 + 1e-9)


def test_slerp_turns_at_constant_speed(random_rotations: Maker) -> None:
    """Equal weights apart are equal turns apart."""
    a, b = random_rotations(1)[0], random_rotations(1)[0]
    track = quaternion.slerp(a, b, np.linspace(0.0, 1.0, 11))
    steps = quaternion.to_scaled_axis(
        quaternion.multiply(track[1:], quaternion.conjugate(track[:-1]))
    )
    np.testing.assert_allclose(steps, np.broadcast_to(steps[0], steps.shape), atol=1e-9)
    same_turn(track[-1], b)


def test_angular_velocity_of_a_steady_turn_is_steady() -> None:
    """A turn of 2 rad/s about a fixed axis is 2 rad/s at every frame, the ends included."""
    axis = np.array([0.6, 0.0, 0.8])
    q = quaternion.from_scaled_axis(axis * (2.0 * np.arange(20)[:, None] / 30.0))
    np.testing.assert_allclose(
        quaternion.angular_velocity(q, 1.0 / 30.0), np.broadcast_to(2.0 * axis, (20, 3)), atol=1e-9
    )


@pytest.mark.parametrize("order", ["zyx", "zxy", "xyz", "yxz"])
def test_euler_angles_turn_as_intrinsic_channels(order: str, rng: np.random.Generator) -> None:
    """BVH's channel order is SciPy's upper-case intrinsic order."""
    angles = rng.uniform(-np.pi, np.pi, (40, 3))
    same_turn(
        quaternion.from_euler(angles, order),
        np.roll(Rotation.from_euler(order.upper(), angles).as_quat(), 1, axis=-1),
    )


def test_euler_angles_come_back(random_rotations: Maker) -> None:
    """Angles of any rotation give the rotation, each within half a turn."""
    q = random_rotations(500)
    angles = quaternion.to_euler_zyx(q)
    assert np.all(np.abs(angles) <= np.pi + EXACT)
    same_turn(quaternion.from_euler(angles, "zyx"), q)


@pytest.mark.parametrize("middle", [np.pi / 2, -np.pi / 2])
def test_euler_angles_lose_nothing_in_gimbal_lock(middle: float, rng: np.random.Generator) -> None:
    """An arm held straight forward (90 degrees about y) keeps its twist."""
    angles = rng.uniform(-np.pi, np.pi, (40, 3))
    angles[:, 1] = middle
    q = quaternion.from_euler(angles, "zyx")
    same_turn(quaternion.from_euler(quaternion.to_euler_zyx(q), "zyx"), q)
    single = q.astype(np.float32)
    same_turn(quaternion.from_euler(quaternion.to_euler_zyx(single), "zyx"), q, 1e-6)
