"""Posing: poses of the reference skeleton on another rig, live.

Each part keeps its rotation in the world through the rig's constant turns, so limbs keep their
directions; the middle between the hip joints moves by the ratio of the legs' lengths. Feet of other
proportions would slide that way while they pivot. So a planted toe stays where it came down: the
hips give way, which leaves all directions as they are. Where both feet are planted and disagree,
they turn about their ankles, and two-bone IK turns the legs by less than a degree.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire.motion.two_bone_ik import two_bone_ik
from stridewire_engine.rigs.planting import Feet, Legs, Planting, nearby, plant
from stridewire_engine.rigs.rig import SIDES, Rig

_BUFFER = 0.002
"""Metres that a leg stays short of full length; the reference's have kept off it before."""
_LIMB_TURN = np.float32(np.deg2rad(0.9))
"""Furthest turn of a limb for its foot's sake; a foot that needs more slides."""
_TOES = REFERENCE.indices([f"{side}Toe" for side in SIDES])


class Posed(NamedTuple):
    """Poses on a rig, relative to the root."""

    hips: Vectors
    """`(N, 3)` metres."""
    rotations: Quaternions
    """`(N, J, 4)` local."""
    aside: Vectors
    """`(N, 2, 3)` from the reference's planted toes, in the rig's size, to the rig's; world."""


class Posing:
    """Poses one rig.

    Args:
        rig: To be posed.
    """

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self._toe = "Toe" if {"LeftToe", "RightToe"} <= set(rig.parts) else "Foot"
        self._parts: Indices = REFERENCE.indices(rig.parts)
        self._turns = rig.turns.astype(np.float32)
        self._hips = rig.part("Hips")
        self._thigh, self._shin, self._foot = (
            np.array([rig.part(side + part) for side in SIDES], np.intp)
            for part in ("UpLeg", "Leg", "Foot")
        )
        self._to_hip = self._bones("Hips", "UpLeg")
        self._to_knee = self._bones("UpLeg", "Leg")
        self._to_ankle = self._bones("Leg", "Foot")
        self._to_toe = self._bones("Foot", self._toe)
        self._reference_hips = REFERENCE.indices([f"{side}UpLeg" for side in SIDES])
        self._reference_shins = REFERENCE.indices([f"{side}Leg" for side in SIDES])
        self._reference_toes = REFERENCE.indices([f"{side}{self._toe}" for side in SIDES])
        self._lift = np.zeros(3, np.float32)
        self._height = 0.0
        self._calibrate()

    def pose(
        self,
        hips: Vectors,
        rotations: Quaternions,
        root: Quaternions,
        planted: Flags,
        targets: Vectors,
        dt: Floats,
        planting: Planting,
    ) -> Posed:
        """Pose the rig.

        Args:
            hips: `(N, 3)` of the reference, relative to the root.
            rotations: `(N, 22, 4)` local, of the reference.
            root: `(N, 7)` place and rotation of the root in the world.
            planted: `(N, 2)` whether the left and the right toe are.
            targets: `(N, 2, 3)` where the reference's toes are locked, world; NaN if free.
            dt: `(N,)` seconds since the frame before.
            planting: N rows; updated.
        """
        positions, turned = kinematics.forward(REFERENCE, hips, rotations)
        world = quaternion.multiply(turned[:, self._parts], self._turns)
        own_hips = self._hips_of(positions, world)
        legs = self._legs(own_hips, world)
        scale = np.float32(self.rig.scale)
        scaled = scale * positions[:, self._reference_toes]
        to_world = np.broadcast_to(root[:, None, 3:], (*scaled.shape[:-1], 4))
        toes = root[:, None, :3] + quaternion.rotate(to_world, positions[:, _TOES])
        feet = Feet(planted, scale * nearby(targets - toes), scaled, to_world)
        shift = plant(planting, legs, feet, self._height, dt)
        moved = Legs(*(joint + shift[:, None] for joint in legs))
        ahead = np.broadcast_to(np.array([0.0, 0.0, 1.0], np.float32), scaled.shape)
        poles = quaternion.rotate(turned[:, self._reference_shins], ahead)
        self._bend(world, moved, planting.correction, poles)
        local = kinematics.to_local(self.rig.skeleton, world[:, self.rig.sources])
        return Posed(own_hips + shift, local, planting.aside)

    def _bend(self, world: Quaternions, legs: Legs, correction: Vectors, poles: Vectors) -> None:
        """Bring the toes aside by a correction: the feet turn, the legs take the rest."""
        foot = legs.toe - legs.ankle
        wanted = foot + correction
        length = np.linalg.norm(foot, axis=-1, keepdims=True)
        reach = np.maximum(np.linalg.norm(wanted, axis=-1, keepdims=True), 1e-6)
        rest = np.where(length > 1e-3, wanted * (1.0 - length / reach), correction)
        aims = (length > 1e-3) & (reach > 1e-3)
        down = np.broadcast_to(np.array([0.0, -1.0, 0.0], np.float32), foot.shape)
        turn = quaternion.between(np.where(aims, foot, down), np.where(aims, wanted, down))
        limb = two_bone_ik(
            legs.hip,
            legs.knee,
            legs.ankle,
            world[:, self._thigh],
            world[:, self._shin],
            legs.ankle + rest.astype(np.float32),
            poles,
            _BUFFER,
        )
        world[:, self._foot] = quaternion.multiply(turn, world[:, self._foot])
        world[:, self._thigh] = _slightly(world[:, self._thigh], limb.upper)
        world[:, self._shin] = _slightly(world[:, self._shin], limb.lower)

    def _calibrate(self) -> None:
        """Find by how much hips and toes rise, so that the T-pose stands on the ground."""
        identity = quaternion.identity(1, len(REFERENCE))
        at_rest = REFERENCE.offsets[:1].astype(np.float32)
        positions, turned = kinematics.forward(REFERENCE, at_rest, identity)
        world = quaternion.multiply(turned[:, self._parts], self._turns)
        toe = self._legs(self._hips_of(positions, world), world).toe[0]
        scaled = np.float32(self.rig.scale) * positions[0, self._reference_toes]
        height = self.rig.toe_height
        # what the skeleton does not tell is as on the reference
        self._height = 0.0 if height is None else height - float(scaled[:, 1].mean())
        self._lift[1] = self._height - float((toe - scaled)[:, 1].mean())

    def _hips_of(self, positions: Vectors, world: Quaternions) -> Vectors:
        """Return the hips `(N, 3)` such that the middle between the hip joints is in its place."""
        middle = np.float32(self.rig.scale) * positions[:, self._reference_hips].mean(axis=1)
        below = np.broadcast_to(self._to_hip.mean(axis=0), middle.shape)
        return np.asarray(middle + self._lift - quaternion.rotate(world[:, self._hips], below))

    def _legs(self, hips: Vectors, world: Quaternions) -> Legs:
        shape = (len(world), 2, 3)
        hip = hips[:, None] + _turn(world[:, self._hips, None], self._to_hip, shape)
        knee = hip + _turn(world[:, self._thigh], self._to_knee, shape)
        ankle = knee + _turn(world[:, self._shin], self._to_ankle, shape)
        return Legs(hip, knee, ankle, ankle + _turn(world[:, self._foot], self._to_toe, shape))

    def _bones(self, part: str, end: str) -> Vectors:
        """Return both sides' ways from a part to the next, `(2, 3)`."""
        names = [(part if part == "Hips" else side + part, side + end) for side in SIDES]
        ways = [self.rig.bone(a, b) if a != b else np.zeros(3) for a, b in names]
        return np.array(ways, np.float32)


def _slightly(before: Quaternions, after: Quaternions) -> Quaternions:
    """Turn limbs no further than `_LIMB_TURN`."""
    cosine = np.abs(np.sum(before * after, axis=-1))
    angle = 2.0 * np.arccos(np.minimum(cosine, 1.0))
    share = np.minimum(1.0, _LIMB_TURN / np.maximum(angle, 1e-6))
    return np.asarray(quaternion.nlerp(before, after, share), np.float32)


def _turn(rotation: Quaternions, bone: Vectors, shape: tuple[int, ...]) -> Vectors:
    rotation = np.broadcast_to(rotation, (*shape[:-1], 4))
    return quaternion.rotate(rotation, np.broadcast_to(bone, shape))
