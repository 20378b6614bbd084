"""Joint axes: the constant turn between the reference's T-pose and each joint of a source.

Where the file's zero pose is a standing human, joints have their rest there. Elsewhere (bones along
one axis, a pose out of the middle of a run) the average pose of the motion, seen from its heading,
stands in: trunk and head look forward on average while the trunk is upright, limbs are swung from
the T-pose to their average direction the short way and twisted until elbows and knees bend right.
"""

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.figure import NEXT, SIDES, Figure, direction

_UP = np.array([0.0, 1.0, 0.0])
_STRAIGHT = np.cos(np.deg2rad(40.0))
_VERTICAL = np.cos(np.deg2rad(10.0))
_FEWEST_VERTICAL = 30

_BENT = np.sin(np.deg2rad(20.0))
_FEWEST_BENT = 20
_HINGES = (
    *((f"{side}Arm", f"{side}ForeArm", (0.0, 0.0, 1.0)) for side in SIDES),
    *((f"{side}UpLeg", f"{side}Leg", (0.0, 0.0, -1.0)) for side in SIDES),
)
_TRUNK_NEXT = {
    "Spine": "Spine1",
    "Spine1": "Spine2",
    "Spine2": "Neck",
    "Neck": "Head",
}

_BEFORE = {
    side + part: side + before
    for side in SIDES
    for part, before in (("Leg", "UpLeg"), ("Foot", "Leg"), ("ForeArm", "Arm"), ("Hand", "ForeArm"))
}


def joint_axes(figure: Figure) -> dict[str, Quaternions]:
    """Return by part the turn `(4,)` from the reference's T-pose to the joint's own axes."""
    rest = rest_rotations(figure)
    if rest is not None:
        return _swung(figure, rest, NEXT)
    average = average_rotations(figure)
    axes = _swung(figure, average, {**NEXT, **_TRUNK_NEXT})
    for upper, lower, bend in _HINGES:
        for part in (upper, lower):
            axes[part] = _hinged(figure, part, (upper, lower), axes[part], np.array(bend))
    for side in SIDES:
        hand, arm = f"{side}Hand", f"{side}ForeArm"
        straight = quaternion.multiply(average[figure.index(arm)], axes[arm])
        back = quaternion.conjugate(average[figure.index(hand)])
        axes[hand] = quaternion.multiply(back, straight)
    return axes


def _swung(
    figure: Figure, neutral: Quaternions, following: Mapping[str, str]
) -> dict[str, Quaternions]:
    """Swing bones the short way from the T-pose to where they point in the neutral pose."""
    swings: dict[str, Quaternions] = {}
    axes = {}
    for part, turn in zip(figure.parts, neutral, strict=True):
        swing = swings.get(_BEFORE.get(part, ""), quaternion.identity(dtype=np.float64))
        if part in following and following[part] in figure.parts:
            bone = figure.bone(part, following[part])
            at_rest = REFERENCE.offsets[REFERENCE.index(following[part])]
            aim = quaternion.rotate(turn, direction(bone))
            now = quaternion.rotate(swing, direction(at_rest))
            swing = quaternion.multiply(quaternion.between(now, aim), swing)
            swings[part] = swing
        axes[part] = quaternion.multiply(quaternion.conjugate(turn), swing)
    return axes


def _hinged(
    figure: Figure, part: str, pair: tuple[str, str], axes: Quaternions, bend: Vectors
) -> Quaternions:
    """Twist a limb's axes about its bone so that elbow or knee bends as the reference's does.

    Args:
        figure: The source.
        part: Whose axes; one of `pair`.
        pair: Upper and lower part of the limb.
        axes: `(4,)` to be twisted.
        bend: `(3,)` which way the lower bone bends in the reference's T-pose.
    """
    upper, lower = (direction(figure.at(NEXT[p]) - figure.at(p)) for p in pair)
    hinge = np.cross(upper, lower)
    bent = np.linalg.norm(hinge, axis=-1) > _BENT
    if bent.sum() < _FEWEST_BENT:
        return axes
    back = quaternion.conjugate(figure.rotations[bent, figure.index(part)])
    measured = np.median(quaternion.rotate(back, direction(hinge[bent])), axis=0)
    at_rest = direction(REFERENCE.offsets[REFERENCE.index(NEXT[part])])
    bone = quaternion.rotate(axes, at_rest)
    is_now = quaternion.rotate(axes, np.cross(at_rest, bend))
    wanted = measured - bone * (measured @ bone)
    if np.linalg.norm(wanted) < 0.5:
        return axes
    return quaternion.multiply(quaternion.between(is_now, direction(wanted)), axes)


def rest_rotations(figure: Figure) -> Quaternions | None:
    """Return zero-pose rotations `(P, 4)` seen from the heading; None if it does not stand."""
    rest = dict(zip(figure.parts, figure.rest_positions, strict=True))
    legs = [
        direction(rest[side + b] - rest[side + a])
        for side in SIDES
        for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))
    ]
    down = direction(np.mean(legs, axis=0))
    across = rest["LeftUpLeg"] - rest["RightUpLeg"]
    left = direction(across - down * (across @ down))
    forward = np.cross(left, -down)
    trunk = direction(0.5 * (rest["LeftArm"] + rest["RightArm"]) - rest["Hips"])
    arms = [direction(rest[f"{side}ForeArm"] - rest[f"{side}Arm"]) for side in SIDES]
    standing = (
        min(bone @ down for bone in legs) > _STRAIGHT
        and trunk @ -down > _STRAIGHT
        and abs(direction(across) @ down) < 0.3
        and max(arm @ forward for arm in arms) < 0.7
        and max(arm @ -down for arm in arms) < 0.7
        and arms[0] @ left > -0.3
    )
    if not standing:
        return None
    columns = np.stack([_snap(left), _snap(-down), np.cross(_snap(left), _snap(-down))])
    heading = quaternion.conjugate(_from_columns(columns.T))
    return np.broadcast_to(heading, (len(figure.parts), 4))


def average_rotations(figure: Figure) -> Quaternions:
    """Return mean rotations `(P, 4)`, seen from the heading, while the trunk is upright."""
    across = figure.at("LeftUpLeg") - figure.at("RightUpLeg")
    # a figure that looks along +Z has its left along +X
    heading = quaternion.from_yaw(np.arctan2(-across[:, 2], across[:, 0]))
    trunk = 0.5 * (figure.at("LeftArm") + figure.at("RightArm")) - 0.5 * (
        figure.at("LeftUpLeg") + figure.at("RightUpLeg")
    )
    upright = direction(trunk)[:, 1] > _VERTICAL
    if upright.sum() < _FEWEST_VERTICAL:
        upright = np.ones(len(upright), bool)
    seen = quaternion.multiply(
        quaternion.conjugate(heading[upright, None]), figure.rotations[upright]
    )
    return np.array([mean_rotation(seen[:, part]) for part in range(len(figure.parts))])


def mean_rotation(q: Quaternions) -> Quaternions:
    """Return the mean `(4,)` of unit quaternions `(T, 4)` (Markley et al. 2007); signs are free."""
    _, vectors = np.linalg.eigh(q.T @ q)
    return np.asarray(vectors[:, -1])


def _snap(v: Vectors) -> Vectors:
    """Return the file's axis within 20 degrees of a direction, else the direction."""
    axis = np.zeros(3)
    axis[np.argmax(np.abs(v))] = np.sign(v[np.argmax(np.abs(v))])
    return axis if axis @ v > np.cos(np.deg2rad(20.0)) else v


def _from_columns(columns: Vectors) -> Quaternions:
    return np.asarray(Rotation.from_matrix(columns).as_quat(scalar_first=True))
