"""Corrections: nothing at the ends, bounded, smooth; linear blends underneath."""

from collections.abc import Callable

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.clip import Pose
from stridewire_engine.networks.blend.correction import (
    CHANNELS,
    ORDER,
    correct,
    curve,
    linear,
    settle_ends,
)
from stridewire_engine.networks.blend.network import joint_weights
from stridewire_engine.networks.blend.postures import Postures

MakePose = Callable[..., Pose]


def test_ends_are_the_very_numbers(random_pose: MakePose, rng: np.random.Generator) -> None:
    """Whatever the network says, weights 0 and 1 give start and end bit by bit."""
    start, end = Postures.of(random_pose(6)), Postures.of(random_pose(6))
    weights = joint_weights(np.tile([0.0, 1.0], (6, 1)))
    said = rng.normal(size=(6, 1, ORDER, CHANNELS))
    blended = correct(
        linear(start[:, None], end[:, None], weights), said, np.full(CHANNELS, 0.5), weights
    )
    for at, side in enumerate((start, end)):
        np.testing.assert_array_equal(blended.hips[:, at], side.hips)
        np.testing.assert_array_equal(blended.rotations[:, at], side.rotations)


def test_corrections_stay_within_the_bounds(
    random_pose: MakePose, rng: np.random.Generator
) -> None:
    """Hips move at most by the bound, joints turn at most by it about each axis."""
    pose = Postures.of(random_pose(4))
    weights = joint_weights(np.linspace(0.0, 1.0, 21)[None].repeat(4, 0))
    between = linear(pose[:, None], pose[:, None], weights)
    said = 1e3 * rng.normal(size=(4, 1, ORDER, CHANNELS))
    bounds = rng.uniform(0.05, 0.4, CHANNELS)
    blended = correct(between, said, bounds, weights)
    assert np.all(np.abs(blended.hips - between.hips) <= bounds[:3] + 1e-6)
    turn = quaternion.multiply(quaternion.conjugate(between.rotations), blended.rotations)
    axes = quaternion.to_scaled_axis(turn).reshape(4, 21, -1)
    assert np.all(np.abs(axes) <= bounds[3:] + 1e-5)


def test_the_linear_blend_turns_at_constant_speed(random_pose: MakePose) -> None:
    """At the middle weight a joint is half its turn from both ends; hips are half-way."""
    start, end = Postures.of(random_pose(5)), Postures.of(random_pose(5))
    middle = linear(start, end, joint_weights(np.full(5, 0.5)))
    to_start = _angle(middle.rotations, start.rotations)
    np.testing.assert_allclose(to_start, _angle(middle.rotations, end.rotations), atol=1e-6)
    np.testing.assert_allclose(to_start * 2.0, _angle(start.rotations, end.rotations), atol=1e-6)
    np.testing.assert_allclose(middle.hips, 0.5 * (start.hips + end.hips), atol=1e-9)


def test_a_share_of_the_weight_moves_a_joint_less(random_pose: MakePose) -> None:
    """A joint of share 0 stays at the start, one of share a half is half-way at weight 1."""
    start, end = Postures.of(random_pose(1)), Postures.of(random_pose(1))
    weights = joint_weights(np.array([1.0]), {"Head": 0.0, "LeftHand": 0.5})
    blended = linear(start, end, weights)
    half = linear(start, end, joint_weights(np.array([0.5])))
    np.testing.assert_array_equal(blended.rotations[0, 13], start.rotations[0, 13])
    np.testing.assert_allclose(blended.rotations[0, 17], half.rotations[0, 17], atol=1e-9)
    np.testing.assert_array_equal(blended.rotations[0, 5], end.rotations[0, 5])


def test_polynomials_are_orthogonal() -> None:
    """Legendre's: no one of them can stand in for another."""
    x, weights = np.polynomial.legendre.leggauss(8)
    values = curve(0.5 * (x + 1.0))
    gram = np.einsum("n,nj,nk->jk", weights, values, values)
    np.testing.assert_allclose(gram, np.diag(2.0 / (2.0 * np.arange(ORDER) + 1.0)), atol=1e-9)


def test_the_paper_settles_to_the_linear_ends(random_pose: MakePose) -> None:
    """The network's own posture at weight a half, the linear blend at the ends."""
    own, other = Postures.of(random_pose(1)), Postures.of(random_pose(1))
    weights = joint_weights(np.array([[0.0, 0.5, 1.0]]))
    between = linear(own[:, None], other[:, None], weights)
    generated = Postures(between.hips + 0.1, between.rotations[:, ::-1].copy())
    settled = settle_ends(between, generated, weights)
    np.testing.assert_array_equal(settled.rotations[:, [0, 2]], between.rotations[:, [0, 2]])
    np.testing.assert_array_equal(settled.hips[:, [0, 2]], between.hips[:, [0, 2]])
    np.testing.assert_allclose(settled.hips[:, 1], generated.hips[:, 1])
    np.testing.assert_allclose(
        _angle(settled.rotations[:, 1], generated.rotations[:, 1]), 0.0, atol=1e-6
    )


def _angle(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    turn = quaternion.multiply(a, quaternion.conjugate(b))
    return np.linalg.norm(quaternion.to_scaled_axis(turn), axis=-1)
