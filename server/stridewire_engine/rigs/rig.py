"""A rig: a caller's skeleton seen as a human who stands.

A skeleton has no rotations of its own at rest: with every local rotation zero it stands, arms where
they may be, in whatever direction it looks. From that pose follows for each joint the constant turn
between the reference's T-pose and the joint's own axes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Indices, Quaternions, Vectors
from stridewire.motion.skeleton import HEAD_TOP, REFERENCE, Skeleton
from stridewire_engine.rigs.joint_mapping import MappingError, map_joints

SIDES = ("Left", "Right")
_LIMBS = {"UpLeg": "Leg", "Leg": "Foot", "Arm": "ForeArm", "ForeArm": "Hand"}
_LEG_LENGTHS = (0.2, 3.0)
_STRAIGHT = np.cos(np.deg2rad(40.0))
_NEAR_AXIS = np.cos(np.deg2rad(20.0))
_MAX_JOINTS = 256
_HIGHEST_TOE = 0.15
"""Of the legs' length; a toe that lies higher at rest says nothing about the ground."""
_STATURE = 1.75 / 1.44
"""Standing height in heights of the shoulders, for a skeleton without a head."""


class RigError(ValueError):
    """A skeleton cannot be posed as a human; the message says why and what to do."""


@dataclass(frozen=True)
class Rig:
    """A skeleton, its parts and how they are turned."""

    skeleton: Skeleton
    parts: tuple[str, ...]
    """Reference joints that the skeleton has, in the reference's order."""
    joints: Indices
    """`(P,)` which joints they are."""
    rest: Vectors
    """`(J, 3)` positions with every local rotation zero, axes as in the skeleton."""
    turns: Quaternions
    """`(P, 4)`: a part turned by r in the reference's T-pose is turned by r * turn here."""

    @cached_property
    def sources(self) -> Indices:
        """`(J,)` for each joint the part that it turns with: its own, else the one above."""
        own = {int(joint): part for part, joint in enumerate(self.joints)}
        found: list[int] = []
        for joint, parent in enumerate(self.skeleton.parents):
            found.append(own[joint] if joint in own else found[parent])
        return np.array(found, np.intp)

    def part(self, name: str) -> int:
        """Return the place of a part among the parts."""
        return self.parts.index(name)

    def bone(self, part: str, end: str) -> Vectors:
        """Return the way `(3,)` from a part to one below it, in the part's own axes."""
        at = dict(zip(self.parts, self.joints, strict=True))
        return np.asarray(self.rest[at[end]] - self.rest[at[part]])

    @cached_property
    def leg_length(self) -> float:
        """Thigh and shin, both sides' mean; metres."""
        pairs = (("UpLeg", "Leg"), ("Leg", "Foot"))
        bones = [self.bone(side + a, side + b) for side in SIDES for a, b in pairs]
        return float(np.linalg.norm(bones, axis=-1).sum() / 2.0)

    @cached_property
    def scale(self) -> float:
        """Size of the legs in those of the reference, with the feet that strides roll over."""
        legs, feet = self.leg_length, 0.0
        reference_legs, reference_feet = _reference_leg_length(), 0.0
        if {"LeftToe", "RightToe"} <= set(self.parts):
            bones = [self.bone(f"{side}Foot", f"{side}Toe") for side in SIDES]
            feet = float(np.linalg.norm(bones, axis=-1).mean())
            reference_feet = float(np.linalg.norm(REFERENCE.offsets[REFERENCE.index("LeftToe")]))
        return (legs + feet) / (reference_legs + reference_feet)

    @cached_property
    def up(self) -> Vectors:
        """`(3,)` the direction up in the skeleton's axes."""
        back = quaternion.conjugate(self.turns[self.part("Hips")])
        return quaternion.rotate(back, np.array([0.0, 1.0, 0.0]))

    @cached_property
    def toe_height(self) -> float | None:
        """Height of the toes at rest, both sides' mean; None where the skeleton does not tell."""
        if not {"LeftToe", "RightToe"} <= set(self.parts):
            return None
        toes = [self.rest[self.joints[self.part(f"{side}Toe")]] @ self.up for side in SIDES]
        height = float(np.mean(toes))
        return height if 0.0 < height < _HIGHEST_TOE * self.leg_length else None

    @cached_property
    def height(self) -> float:
        """Standing height, the head's top included; metres."""
        head = self.rest[self.joints[self.part("Head" if "Head" in self.parts else "LeftArm")]]
        feet = [self.rest[self.joints[self.part(f"{side}Foot")]] for side in SIDES]
        ankle = float(REFERENCE.offsets[:4, 1].sum()) * self.scale
        above = float((head - np.mean(feet, axis=0)) @ self.up)
        if "Head" in self.parts:
            return above + ankle + HEAD_TOP * self.scale
        return (above + ankle) * _STATURE


@lru_cache(maxsize=64)
def rig_of(skeleton: Skeleton) -> Rig:
    """See a skeleton as a human who stands.

    Raises:
        RigError: If it has no human's joints, does not stand at rest or is not measured in metres.
    """
    if not 1 <= len(skeleton) <= _MAX_JOINTS:
        raise RigError(f"{len(skeleton)} joints; allowed are 1 to {_MAX_JOINTS}")
    try:
        joints = map_joints(skeleton).joints
    except MappingError as error:
        raise RigError(f"no human: {error}; give joints names such as LeftUpLeg") from error
    if joints["Hips"] != skeleton.names[0]:
        raise RigError(
            f"the first joint is {skeleton.names[0]!r}, but the hips are {joints['Hips']!r}; begin "
            "with the hips and leave bones above them out"
        )
    parts = tuple(part for part in REFERENCE.names if part in joints)
    columns = skeleton.indices([joints[part] for part in parts])
    identity = quaternion.identity(len(skeleton), dtype=np.float64)
    rest, _ = kinematics.forward(skeleton, skeleton.offsets[0], identity)
    upright = _upright({part: rest[joint] for part, joint in zip(parts, columns, strict=True)})
    standing = quaternion.rotate(upright, rest)
    swings = _swings({part: standing[j] for part, j in zip(parts, columns, strict=True)})
    turns = quaternion.multiply(
        quaternion.conjugate(np.array([swings[part] for part in parts])), upright
    )
    rig = Rig(skeleton, parts, columns, rest, turns)
    low, high = _LEG_LENGTHS
    if not low <= rig.leg_length <= high:
        raise RigError(
            f"legs of {rig.leg_length:.3g} m; allowed are {low} to {high}: offsets are metres"
        )
    return rig


def _upright(rest: Mapping[str, Vectors]) -> Quaternions:
    """Return the turn that stands the rest pose up, looking along +Z."""
    legs = [
        _direction(rest[side + b] - rest[side + a])
        for side in SIDES
        for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))
    ]
    up = _snap(-_direction(np.mean(legs, axis=0)))
    across = rest["LeftUpLeg"] - rest["RightUpLeg"]
    left = _snap(_direction(across - up * (across @ up)))
    trunk = _direction(0.5 * (rest["LeftArm"] + rest["RightArm"]) - rest["Hips"])
    arms = [_direction(rest[f"{side}ForeArm"] - rest[f"{side}Arm"]) for side in SIDES]
    forward = np.cross(left, up)
    stands = (
        min(-(bone @ up) for bone in legs) > _STRAIGHT
        and trunk @ up > _STRAIGHT
        and abs(left @ up) < 0.01
        and max(abs(arm @ forward) for arm in arms) < 0.7
        and arms[0] @ left > -0.3
        and arms[1] @ left < 0.3
    )
    if not stands:
        raise RigError(
            "with every local rotation zero the skeleton does not stand with its arms at its sides "
            "or outstretched; give offsets of such a pose, in Python by stridewire.rest_pose"
        )
    return np.asarray(
        Rotation.from_matrix(np.stack([left, up, forward])).as_quat(scalar_first=True)
    )


def _swings(standing: Mapping[str, Vectors]) -> dict[str, Quaternions]:
    """Return by part the turn from the reference's T-pose to the rest pose.

    Limbs are swung, feet splayed; the trunk is as it is.
    """
    swings = {part: quaternion.identity(dtype=np.float64) for part in standing}
    for side in SIDES:
        for part, end in _LIMBS.items():
            before = {"Leg": "UpLeg", "ForeArm": "Arm"}.get(part)
            swing = swings[side + before] if before else quaternion.identity(dtype=np.float64)
            now = quaternion.rotate(swing, _reference_bone(side + part, side + end))
            aim = _direction(standing[side + end] - standing[side + part])
            swings[side + part] = quaternion.multiply(quaternion.between(now, aim), swing)
        swings[f"{side}Hand"] = swings[f"{side}ForeArm"]
        if f"{side}Toe" in standing:
            toe = standing[f"{side}Toe"] - standing[f"{side}Foot"]
            splay = quaternion.from_yaw(np.array(np.arctan2(toe[0], toe[2])))
            swings[f"{side}Foot"] = swings[f"{side}Toe"] = splay
    return swings


def _reference_bone(part: str, end: str) -> Vectors:
    assert REFERENCE.parents[REFERENCE.index(end)] == REFERENCE.index(part)
    return _direction(REFERENCE.offsets[REFERENCE.index(end)])


def _reference_leg_length() -> float:
    lower = REFERENCE.indices([side + part for side in SIDES for part in ("Leg", "Foot")])
    return float(np.linalg.norm(REFERENCE.offsets[lower], axis=-1).sum() / 2.0)


def _snap(v: Vectors) -> Vectors:
    """Return the axis within 20 degrees of a direction, else the direction."""
    axis = np.zeros(3)
    axis[np.argmax(np.abs(v))] = np.sign(v[np.argmax(np.abs(v))])
    return axis if axis @ v > _NEAR_AXIS else v


def _direction(v: Vectors) -> Vectors:
    return np.asarray(v / max(float(np.linalg.norm(v)), 1e-12))
