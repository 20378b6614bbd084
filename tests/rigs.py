"""Rigs of other families for tests: names, proportions and rest poses unlike the reference's."""

import numpy as np

from stridewire.motion.skeleton import Skeleton

_SIDES = (("Left", 1.0), ("Right", -1.0))


def mixamo() -> Skeleton:
    """Return a rig like Mixamo's: a prefix, fingers, high ankles, a T-pose, 1.8 m tall."""
    joints: list[tuple[str, str, tuple[float, float, float]]] = [
        ("Hips", "", (0.0, 1.0, 0.0)),
        ("Spine", "Hips", (0.0, 0.1, -0.01)),
        ("Spine1", "Spine", (0.0, 0.117, 0.0)),
        ("Spine2", "Spine1", (0.0, 0.134, 0.0)),
        ("Neck", "Spine2", (0.0, 0.15, -0.008)),
        ("Head", "Neck", (0.0, 0.103, 0.031)),
    ]
    for side, left in _SIDES:
        joints += [
            (f"{side}Shoulder", "Spine2", (0.061 * left, 0.09, -0.007)),
            (f"{side}Arm", f"{side}Shoulder", (0.129 * left, 0.0, 0.0)),
            (f"{side}ForeArm", f"{side}Arm", (0.274 * left, 0.0, 0.0)),
            (f"{side}Hand", f"{side}ForeArm", (0.276 * left, 0.0, 0.0)),
            (f"{side}HandIndex1", f"{side}Hand", (0.12 * left, 0.0, 0.03)),
            (f"{side}UpLeg", "Hips", (0.091 * left, -0.067, 0.0)),
            (f"{side}Leg", f"{side}UpLeg", (0.0, -0.43, 0.0)),
            (f"{side}Foot", f"{side}Leg", (0.0, -0.4, -0.02)),
            (f"{side}ToeBase", f"{side}Foot", (0.0, -0.083, 0.14)),
        ]
    return _skeleton([(f"mixamorig:{n}", p and f"mixamorig:{p}", o) for n, p, o in joints])


def cmu() -> Skeleton:
    """Return a rig like CMU's: hip joints of its own, legs apart, arms hanging obliquely."""
    joints: list[tuple[str, str, tuple[float, float, float]]] = [
        ("Hips", "", (0.0, 0.92, 0.0)),
        ("LowerBack", "Hips", (0.0, 0.03, 0.0)),
        ("Spine", "LowerBack", (0.0, 0.11, -0.01)),
        ("Spine1", "Spine", (0.0, 0.11, 0.0)),
        ("Neck", "Spine1", (0.0, 0.11, 0.0)),
        ("Neck1", "Neck", (0.0, 0.09, 0.01)),
        ("Head", "Neck1", (0.0, 0.09, 0.0)),
    ]
    for side, left in _SIDES:
        joints += [
            (f"{side}Shoulder", "Spine1", (0.01 * left, 0.05, 0.0)),
            (f"{side}Arm", f"{side}Shoulder", (0.17 * left, 0.03, 0.0)),
            (f"{side}ForeArm", f"{side}Arm", (0.2 * left, -0.2, 0.0)),
            (f"{side}Hand", f"{side}ForeArm", (0.13 * left, -0.13, 0.0)),
            (f"{side[0]}HipJoint", "Hips", (0.0, 0.0, 0.0)),
            (f"{side}UpLeg", f"{side[0]}HipJoint", (0.09 * left, -0.09, 0.03)),
            (f"{side}Leg", f"{side}UpLeg", (0.13 * left, -0.36, 0.0)),
            (f"{side}Foot", f"{side}Leg", (0.13 * left, -0.36, 0.0)),
            (f"{side}ToeBase", f"{side}Foot", (0.02 * left, -0.05, 0.13)),
        ]
    return _skeleton(joints)


def _skeleton(joints: list[tuple[str, str, tuple[float, float, float]]]) -> Skeleton:
    names = [name for name, _, _ in joints]
    parents = tuple(names.index(parent) if parent else -1 for _, parent, _ in joints)
    return Skeleton(tuple(names), parents, np.array([offset for *_, offset in joints]))
