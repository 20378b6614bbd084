"""A source motion seen as a human: parts by name, Y up, bones measured from the motion."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE

SIDES = ("Left", "Right")

NEXT = {
    side + part: side + after
    for side in SIDES
    for part, after in (("UpLeg", "Leg"), ("Leg", "Foot"), ("Arm", "ForeArm"), ("ForeArm", "Hand"))
}
"""The joint at the far end of each limb's bone."""

_UPRIGHT = 0.5


@dataclass(frozen=True)
class Figure:
    """Parts of a human over time, in file units but Y up."""

    parts: tuple[str, ...]
    """Reference joints that the source has, in the reference's order."""
    positions: Vectors
    """`(T, P, 3)`."""
    rotations: Quaternions
    """`(T, P, 4)` in the world."""
    rest_positions: Vectors
    """`(P, 3)` at zero rotations, axes as in the file."""
    toes: dict[str, Vectors]
    """By side `(T, 3)`: the toe joint, else a point on the way to the foot's end; absent where the
    file has neither."""
    turned_up: bool
    """Whether the file has Z up."""

    def index(self, part: str) -> int:
        """Return the column of a part that the source has."""
        return self.parts.index(part)

    def at(self, part: str) -> Vectors:
        """Return the positions `(T, 3)` of a part that the source has."""
        return self.positions[:, self.parts.index(part)]

    def bone(self, part: str, end: str) -> Vectors:
        """Return a bone `(3,)` in its joint's own axes: the median over time, file units."""
        along = self.at(end) - self.at(part)
        back = quaternion.conjugate(self.rotations[:, self.index(part)])
        return np.asarray(np.median(quaternion.rotate(back, along), axis=0))

    def length(self, *parts: str) -> float:
        """Return the summed lengths of bones from part to part, both sides' mean; file units."""
        total = 0.0
        for side in SIDES:
            for a, b in pairwise(parts):
                step = self.at(side + b) - self.at(side + a)
                total += 0.5 * float(np.median(np.linalg.norm(step, axis=-1)))
        return total


def see(source: SourceMotion, joints: dict[str, str], up: str | None = None) -> Figure:
    """Take the mapped joints out of a motion and turn Z-up files to Y up.

    Args:
        source: As read.
        joints: Source joint by reference joint.
        up: `Y` or `Z`; None to tell from the motion.
    """
    parts = tuple(part for part in REFERENCE.names if part in joints)
    columns = source.skeleton.indices([joints[part] for part in parts])
    positions, rotations = source.global_poses()
    figure = Figure(
        parts, positions[:, columns], rotations[:, columns], _rest(source)[columns], {}, False
    )
    figure = replace(figure, toes=_toes(source, joints, positions, figure))
    if up == "Y" or (up is None and not _is_z_up(figure)):
        return figure
    turn = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(-0.5 * np.pi))
    return Figure(
        parts,
        _turn(turn, figure.positions),
        quaternion.multiply(turn, figure.rotations),
        figure.rest_positions,
        {side: _turn(turn, toe) for side, toe in figure.toes.items()},
        turned_up=True,
    )


def _toes(
    source: SourceMotion, joints: dict[str, str], positions: Vectors, figure: Figure
) -> dict[str, Vectors]:
    """Return toe joints, or points as far along the feet as the reference's toes, by side."""
    found = {}
    unit = leg_length() / max(figure.length("UpLeg", "Leg", "Foot"), 1e-9)
    reference = float(np.linalg.norm(REFERENCE.offsets[REFERENCE.index("LeftToe")])) / unit
    for side in SIDES:
        foot = f"{side}Foot"
        tip = source.tips.get(source.skeleton.index(joints[foot]), np.zeros(3))
        length = float(np.linalg.norm(tip))
        if f"{side}Toe" in joints:
            found[side] = positions[:, source.skeleton.index(joints[f"{side}Toe"])]
        elif length > 0.0:
            along = tip * min(1.0, reference / length)
            turned = figure.rotations[:, figure.index(foot)]
            reach = quaternion.rotate(turned, np.broadcast_to(along, (len(turned), 3)))
            found[side] = figure.at(foot) + reach
    return found


def leg_length() -> float:
    """Return thigh and shin of the reference skeleton; metres."""
    lower = REFERENCE.indices([side + part for side in SIDES for part in ("Leg", "Foot")])
    return float(np.linalg.norm(REFERENCE.offsets[lower], axis=-1).sum() / 2.0)


def hip_height() -> float:
    """Return the height of the reference skeleton's hip joints over the ground; metres."""
    hips, leg = REFERENCE.indices(("Hips", "LeftUpLeg"))
    return float(REFERENCE.offsets[hips, 1] + REFERENCE.offsets[leg, 1])


def _rest(source: SourceMotion) -> Vectors:
    positions = np.zeros((len(source.skeleton), 3))
    for joint, parent in enumerate(source.skeleton.parents):
        if parent >= 0:
            positions[joint] = positions[parent] + source.skeleton.offsets[joint]
    return positions


def _is_z_up(figure: Figure) -> bool:
    """Return whether heads lie above feet along Z rather than Y, most of the time."""
    feet = 0.5 * (figure.at("LeftFoot") + figure.at("RightFoot"))
    rise = 0.5 * (figure.at("LeftArm") + figure.at("RightArm")) - feet
    rise = rise / np.maximum(np.linalg.norm(rise, axis=-1, keepdims=True), 1e-9)
    _, y, z = rise.mean(axis=0)
    return bool(z > 0.7 and abs(y) < _UPRIGHT)


def _turn(turn: Quaternions, values: Vectors) -> Vectors:
    return quaternion.rotate(np.broadcast_to(turn, (*values.shape[:-1], 4)), values)


def direction(v: Vectors) -> Vectors:
    """Return `(..., 3)` vectors at unit length; zero ones stay zero."""
    length: Floats = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.maximum(length, 1e-12))
