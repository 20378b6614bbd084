"""A rig is seen as a standing human whatever way it looks; what cannot stand is refused."""

from dataclasses import replace

import numpy as np
import pytest

from rigs import cmu, mixamo
from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire_engine.rigs.rig import RigError, rig_of


def test_the_reference_is_its_own_rig() -> None:
    """No turns, no scale, 1.75 m."""
    rig = rig_of(REFERENCE)
    assert rig.parts == REFERENCE.names
    np.testing.assert_allclose(quaternion.absolute(rig.turns)[:, 0], 1.0, atol=1e-9)
    assert (rig.scale, rig.height) == (pytest.approx(1.0), pytest.approx(1.75))


@pytest.mark.parametrize("skeleton", [mixamo(), cmu()])
def test_parts_and_size_are_found(skeleton: Skeleton) -> None:
    """Legs and arms, toes and head; fingers and hip joints turn with what is above them."""
    rig = rig_of(skeleton)
    assert {"LeftToe", "RightHand", "Head", "Hips"} <= set(rig.parts)
    assert 1.5 < rig.height < 2.0
    for joint, parent in enumerate(skeleton.parents):
        if joint not in rig.joints:
            assert rig.sources[joint] == rig.sources[parent]


@pytest.mark.parametrize("axis", [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 1.0)])
def test_the_way_it_looks_does_not_matter(axis: tuple[float, float, float]) -> None:
    """A skeleton that faces backwards, or has Z up, has the same size; hips turn it."""
    angle = 2.0 * np.pi / 3.0 if axis == (1.0, 1.0, 1.0) else 0.5 * np.pi
    unit = np.array(axis) / np.linalg.norm(axis)
    turn = quaternion.from_axis_angle(unit, np.array(angle))
    plain, turned = mixamo(), mixamo()
    offsets = quaternion.rotate(np.broadcast_to(turn, (len(turned), 4)), turned.offsets)
    turned = replace(turned, offsets=offsets)
    rig, expected = rig_of(turned), rig_of(plain)
    assert rig.height == pytest.approx(expected.height)
    back = quaternion.multiply(expected.turns, quaternion.conjugate(turn))
    np.testing.assert_allclose(np.abs(np.sum(rig.turns * back, axis=-1)), 1.0, atol=1e-9)


@pytest.mark.parametrize(
    ("skeleton", "says"),
    [
        (mixamo().scaled(100.0), "offsets are metres"),
        (replace(REFERENCE, offsets=np.tile([0.3, 0.0, 0.0], (22, 1))), "does not stand"),
        (Skeleton(("a", "b"), (-1, 0), np.ones((2, 3))), "no human"),
    ],
)
def test_what_is_no_rig_is_refused(skeleton: Skeleton, says: str) -> None:
    """The error says what is wrong with it."""
    with pytest.raises(RigError, match=says):
        rig_of(skeleton)


def test_bones_above_the_hips_are_refused() -> None:
    """A root bone on the ground has to be left out."""
    plain = mixamo()
    names = ("mixamorig:Root", *plain.names)
    parents = (-1, *(parent + 1 for parent in plain.parents))
    offsets = np.concatenate([np.zeros((1, 3)), plain.offsets])
    with pytest.raises(RigError, match="begin with the hips"):
        rig_of(Skeleton(names, parents, offsets))
