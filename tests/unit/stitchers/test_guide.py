"""Guided feet: told to stay they stay, told to go elsewhere they go there, turned as told."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.stitchers import Guide, Motion, Sample, StitchState
from stridewire_engine.stitchers.legs import leg_pose
from stridewire_engine.stitchers.stance import Stance
from unit.stitchers.motions import ROOTS, J, N, empty, sample_of

DT = np.full(N, 1 / 60, np.float32)
BENT = {"LeftUpLeg": -0.3, "LeftLeg": 0.6, "LeftFoot": -0.3}


def standing() -> Motion:
    """Return bodies that stand with knees bent."""
    rotations = quaternion.identity(N, J)
    for side in ("Left", "Right"):
        for joint, angle in BENT.items():
            axis = np.array([1.0, 0.0, 0.0])
            turn = quaternion.from_axis_angle(axis, np.array(angle, np.float32))
            rotations[:, REFERENCE.index(joint.replace("Left", side))] = turn
    still = np.zeros((N, 3), np.float32)
    hips = still + np.array([0.0, 0.9, 0.0], np.float32)
    toes = np.zeros((N, 2, 3), np.float32)
    return Motion(hips, rotations, still, np.zeros((N, J, 3), np.float32), toes, toes)


def begun(sample: Sample) -> StitchState:
    """Return the state of characters whose toes are where the sample has them."""
    state = empty()
    toes = leg_pose(sample.legs, sample.hips, sample.rotations).toe
    state.toe_shown[...] = ROOTS.to_world(toes)
    return state


def guided(planted: float, offset: tuple[float, float, float], turn: float, frames: int) -> Sample:
    """Return the legs after so many frames under one guide."""
    sample = sample_of(standing())
    guide = Guide(
        np.full((N, 2), planted), np.tile(offset, (N, 2, 1)), np.tile([turn, 0.0, 0.0], (N, 2, 1))
    )
    sample = sample._replace(guide=guide, contacts=guide.planted > 0.5)
    state = begun(sample)
    for _ in range(frames):
        hips, rotations = Stance().apply(state, sample, DT)
    return sample._replace(hips=hips, rotations=rotations)


@pytest.mark.parametrize(("planted", "expected"), [(1.0, 0.0), (0.0, 0.08)])
def test_feet_go_where_they_are_led_when_they_swing(planted: float, expected: float) -> None:
    """A planted toe ignores where its swing would lead; a swinging one arrives there."""
    before = guided(1.0, (0.0, 0.0, 0.0), 0.0, 1)
    after = guided(planted, (0.08, 0.0, 0.0), 0.0, 60)
    toes = [leg_pose(s.legs, s.hips, s.rotations).toe for s in (before, after)]
    np.testing.assert_allclose((toes[1] - toes[0])[..., 0], expected, atol=5e-3)


def test_feet_turn_as_told() -> None:
    """A turn about the root's x axis pitches the foot by so much, and the toe stays in place."""
    plain, turned = guided(1.0, (0.0, 0.0, 0.0), 0.0, 5), guided(1.0, (0.0, 0.0, 0.0), 0.2, 5)
    legs = [leg_pose(s.legs, s.hips, s.rotations) for s in (plain, turned)]
    turn = quaternion.multiply(legs[1].foot, quaternion.conjugate(legs[0].foot))
    expected = np.tile([0.2, 0.0, 0.0], (N, 2, 1))
    np.testing.assert_allclose(quaternion.to_scaled_axis(turn), expected, atol=2e-3)
    np.testing.assert_allclose(legs[1].toe, legs[0].toe, atol=2e-3)
