"""Two-bone IK: it reaches, keeps lengths, bends the right way and never breaks."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.array_types import Vectors
from stridewire.motion.two_bone_ik import Limb, two_bone_ik

HIP = np.array([0.1, 0.9, 0.0])
KNEE = np.array([0.1, 0.48, 0.1])
ANKLE = np.array([0.1, 0.08, 0.0])
FORWARD = np.array([0.0, 0.0, 1.0])
STILL = np.array(quaternion.IDENTITY)


def solve(target: Vectors, knee: Vectors = KNEE, ankle: Vectors = ANKLE) -> Limb:
    """Bend the leg of this module towards targets `(..., 3)`."""
    shape = (*target.shape[:-1], 3)
    at = [np.broadcast_to(p, shape) for p in (HIP, knee, ankle)]
    turn = np.broadcast_to(STILL, (*target.shape[:-1], 4))
    return two_bone_ik(*at, turn, turn, target, np.broadcast_to(FORWARD, shape))


def joints(limb: Limb, knee: Vectors = KNEE, ankle: Vectors = ANKLE) -> tuple[Vectors, Vectors]:
    """Return knee and ankle as the limb's rotations place the rest bones."""
    new_knee = HIP + quaternion.rotate(limb.upper, np.broadcast_to(knee - HIP, limb.end.shape))
    return new_knee, new_knee + quaternion.rotate(
        limb.lower, np.broadcast_to(ankle - knee, limb.end.shape)
    )


def test_rotations_bring_the_end_to_targets_within_reach(rng: np.random.Generator) -> None:
    """Forward kinematics with the answered rotations ends at the target."""
    direction = rng.normal(size=(200, 3))
    direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
    target = HIP + direction * rng.uniform(0.1, 0.8, (200, 1))
    limb = solve(target)
    assert limb.reached.all()
    np.testing.assert_allclose(limb.end, target, atol=1e-9)
    np.testing.assert_allclose(joints(limb)[1], target, atol=1e-6)


def test_the_end_as_target_changes_nothing() -> None:
    """A foot that is where it should be leaves the leg alone."""
    limb = solve(ANKLE)
    np.testing.assert_allclose(np.abs(limb.upper @ STILL), 1.0, atol=1e-9)
    np.testing.assert_allclose(np.abs(limb.lower @ STILL), 1.0, atol=1e-9)
    np.testing.assert_allclose(joints(limb)[0], KNEE, atol=1e-9)


def test_out_of_reach_goes_as_far_as_the_buffer_allows() -> None:
    """The limb points at the target, 1.5 cm short of its full length, and says so."""
    target = HIP + np.array([0.0, -2.0, 1.0])
    limb = solve(target)
    length = np.linalg.norm(KNEE - HIP) + np.linalg.norm(ANKLE - KNEE)
    assert not limb.reached
    reach = limb.end - HIP
    assert np.linalg.norm(reach) == pytest.approx(length - 0.015)
    np.testing.assert_allclose(
        reach / np.linalg.norm(reach), (target - HIP) / np.linalg.norm(target - HIP), atol=1e-9
    )
    np.testing.assert_allclose(joints(limb)[1], limb.end, atol=1e-6)


def test_a_limb_straighter_than_the_buffer_may_stay_so() -> None:
    """Data that is straighter than the buffer is not bent for nothing."""
    knee = np.array([0.1, 0.48, 0.001])
    limb = solve(ANKLE, knee)
    assert limb.reached
    np.testing.assert_allclose(joints(limb, knee)[0], knee, atol=1e-2)


def test_a_straight_knee_bends_forward() -> None:
    """Only the pole tells a straight leg where to bend."""
    straight = np.array([0.1, 0.48, 0.0])
    limb = solve(ANKLE + np.array([0.0, 0.2, 0.0]), straight)
    knee, ankle = joints(limb, straight)
    assert knee[2] > 0.1
    assert abs(knee[0] - HIP[0]) < 1e-6
    np.testing.assert_allclose(ankle, limb.end, atol=1e-6)


def test_a_bent_knee_stays_in_its_plane() -> None:
    """The pole does not turn a knee that already points somewhere."""
    outward = np.array([0.25, 0.48, 0.0])
    knee, _ = joints(solve(ANKLE + np.array([0.0, 0.1, 0.0]), outward), outward)
    assert knee[0] > outward[0]
    assert abs(knee[2]) < 1e-6


def test_a_knee_bent_back_by_any_little_bends_forward() -> None:
    """Hyperextended knees bend forward like straight ones, never flip, and keep the bones whole."""
    target = ANKLE + np.array([0.0, 0.1, 0.0])
    shown = []
    for amount in np.linspace(-0.05, 0.1, 151):
        knee = np.array([0.1, 0.48, -amount])
        middle, end = joints(solve(target, knee), knee)
        np.testing.assert_allclose(end, target, atol=1e-5)
        shown.append(middle)
    steps = np.linalg.norm(np.diff(shown, axis=0), axis=-1)
    assert np.min(shown, axis=0)[2] > 0.1
    assert steps.max() < 0.01


def test_a_target_at_the_start_folds_the_limb() -> None:
    """A target without a direction is no NaN."""
    limb = solve(np.stack([HIP, ANKLE]))
    assert not limb.reached[0]
    assert np.isfinite(limb.end).all()
    np.testing.assert_allclose(joints(limb)[1], limb.end, atol=1e-5)


def test_too_near_a_target_is_clamped() -> None:
    """Bones of unequal length cannot fold to nothing."""
    limb = solve(HIP + np.array([0.0, -0.001, 0.0]))
    assert not limb.reached
    np.testing.assert_allclose(joints(limb)[1], limb.end, atol=1e-5)
