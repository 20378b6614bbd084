"""Rigs whose zero pose does not stand."""

import numpy as np
import pytest

from rigs import mixamo
from stridewire.motion import kinematics, quaternion
from stridewire.motion.skeleton import Skeleton
from stridewire.rest_pose import RestPose
from stridewire_engine.rigs.rig import RigError, rig_of


def crumpled() -> tuple[Skeleton, np.ndarray]:
    """Return a rig with axes of its own in each joint, and the rotations in which it stands."""
    stands = mixamo()
    rng = np.random.default_rng(4)
    turned = quaternion.normalize(rng.normal(size=(len(stands), 4)))
    parents = np.array(stands.parents)
    above = turned[parents].copy()
    above[0] = (1.0, 0.0, 0.0, 0.0)
    offsets = quaternion.rotate(quaternion.conjugate(above), stands.offsets)
    local = quaternion.multiply(quaternion.conjugate(above), turned)
    return Skeleton(stands.names, stands.parents, offsets), local


def test_a_rig_stands_with_zero_rotations() -> None:
    """What was refused for its zero pose is the standing rig, joint for joint."""
    skeleton, standing = crumpled()
    with pytest.raises(RigError, match="does not stand"):
        rig_of(skeleton)
    rest = RestPose(skeleton, standing)
    np.testing.assert_allclose(rest.skeleton.offsets, mixamo().offsets, atol=1e-6)
    assert rig_of(rest.skeleton).scale == pytest.approx(rig_of(mixamo()).scale)


def test_streamed_rotations_come_back_as_the_rigs_own() -> None:
    """Joints lie in the same places, by streamed rotations or by the rig's own."""
    skeleton, standing = crumpled()
    rest = RestPose(skeleton, standing)
    rng = np.random.default_rng(5)
    streamed = quaternion.normalize(rng.normal(size=(3, 2, len(skeleton), 4))).astype(np.float32)
    hips = rng.normal(size=(3, 2, 3)).astype(np.float32)
    there, _ = kinematics.forward(rest.skeleton, hips, streamed)
    own, _ = kinematics.forward(skeleton, hips, rest.rotations(streamed))
    np.testing.assert_allclose(own, there, atol=1e-5)


@pytest.mark.parametrize(("shape", "says"), [((3, 4), "expected"), ((25, 4), "unit")])
def test_rotations_that_are_none_are_refused(shape: tuple[int, int], says: str) -> None:
    """One unit quaternion a joint."""
    rotations = np.full((len(mixamo()), 4) if shape[0] == 25 else shape, 0.9)
    with pytest.raises(ValueError, match=says):
        RestPose(mixamo(), rotations)
