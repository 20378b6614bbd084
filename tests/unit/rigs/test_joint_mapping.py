"""Mapping joints: sides, prefixes and words of many exporters, else the shape of the tree."""

import numpy as np
import pytest
from tests.unit.building.figures import source

from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire_engine.rigs.joint_mapping import MappingError, map_joints
from stridewire_engine.rigs.joint_names import bare_names, split_name


@pytest.mark.parametrize(
    ("name", "side", "core"),
    [
        ("LeftUpLeg", "left", "upleg"),
        ("rShin", "right", "shin"),
        ("lfemur", "left", "femur"),
        ("foot_L", "left", "foot"),
        ("R_foot_jnt", "right", "foot"),
        ("foot.R", "right", "foot"),
        ("LHipJoint", "left", "hip"),
        ("lowerback", "", "lowerback"),
        ("root", "", "root"),
        ("Hips", "", "hips"),
    ],
)
def test_names_give_side_and_word(name: str, side: str, core: str) -> None:
    """`l` of `lowerback` and `r` of `root` are no sides."""
    found = split_name(name)
    assert found[0] == side
    assert found[1] == core


@pytest.mark.parametrize(
    "prefix", ["mixamorig:", "mixamorig7:", "Model_", "Character1_", "CC_Base_"]
)
def test_prefixes_are_dropped(prefix: str) -> None:
    """What all joints begin with is no part of their names."""
    names = tuple(prefix + name for name in REFERENCE.names)
    skeleton = Skeleton(names, REFERENCE.parents, REFERENCE.offsets)
    assert bare_names(skeleton) == REFERENCE.names
    assert map_joints(skeleton).joints["LeftFoot"] == f"{prefix}LeftFoot"


def test_unknown_names_are_mapped_by_shape() -> None:
    """Joints called `Bone.001` and so on are told by the tree, and marked as uncertain."""
    rename = {name: f"Bone.{i:03}" for i, name in enumerate(REFERENCE.names)}
    motion = source(rename=rename)
    mapped = map_joints(motion.skeleton)
    assert mapped.uncertain
    for part in ("LeftUpLeg", "RightFoot", "LeftArm", "RightHand", "Hips", "Spine2", "Neck"):
        assert mapped.joints[part] == rename[part]


def test_fingers_are_no_arms() -> None:
    """Three fingers on each hand, alike and unnamed, do not pass for a pair of limbs."""
    names, parents = [f"Bone.{i}" for i in range(len(REFERENCE))], list(REFERENCE.parents)
    offsets = list(REFERENCE.offsets)
    for hand, out in ((REFERENCE.index("LeftHand"), 1.0), (REFERENCE.index("RightHand"), -1.0)):
        for finger in range(3):
            at = hand
            for _ in range(3):
                parents.append(at)
                at = len(names)
                names.append(f"Bone.{at}")
                offsets.append(np.array([0.03 * out, 0.0, 0.01 * finger]))
    mapped = map_joints(Skeleton(tuple(names), tuple(parents), np.array(offsets)))
    assert mapped.joints["LeftHand"] == f"Bone.{REFERENCE.index('LeftHand')}"
    assert mapped.joints["RightArm"] == f"Bone.{REFERENCE.index('RightArm')}"


def test_a_chain_is_no_human() -> None:
    """One chain of bones is refused."""
    chain = Skeleton(tuple(f"Bone.{i}" for i in range(6)), (-1, 0, 1, 2, 3, 4), np.ones((6, 3)))
    with pytest.raises(MappingError, match="foot or ankle"):
        map_joints(chain)
