"""Retargeting: any human's motion onto the reference skeleton.

Each joint's rotation in the world is carried over through a constant turn between the T-pose of
the reference and the joint's own axes, so limbs keep their directions; the hips move by the ratio
of the legs' lengths.
"""

from dataclasses import dataclass

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.figure import NEXT, SIDES, Figure, direction, leg_length, see
from stridewire_engine.building.profiles import Profile
from stridewire_engine.building.rest_pose import joint_axes
from stridewire_engine.building.retarget_feet import (
    Misplaced,
    level_soles,
    misplaced,
    moved,
    plant,
    standing,
    toe_path,
)

_SAME = 1e-3
_SHORTEST_BONE = 0.02
_ALONG = np.cos(np.deg2rad(35.0))
_TRUNK = ("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head")
_INSTEAD = {
    side + part: side + of for side in SIDES for part, of in (("Toe", "Foot"), ("Hand", "ForeArm"))
} | {f"{side}Shoulder": "Spine2" for side in SIDES}
"""Whose rotation a part takes that the source lacks."""


class NotHumanError(ValueError):
    """A figure's proportions are no human's; the message says which."""


@dataclass(frozen=True)
class Retargeted:
    """A motion on the reference skeleton, at the source's frame rate."""

    hips: Vectors
    """`(T, 3)` in the world, metres; the ground is wherever the source had it."""
    rotations: Quaternions
    """`(T, 22, 4)` local, the hips' in the world."""
    scale: float
    """Metres on the reference skeleton per file unit."""
    notes: tuple[str, ...] = ()
    unchanged: bool = False
    """Whether the file is on the reference skeleton itself, its ground at 0."""


def retarget(source: SourceMotion, profile: Profile, frame_rate: float) -> Retargeted:
    """Carry a motion over to the reference skeleton.

    Args:
        source: Any unit, Y or Z up.
        profile: How its joints map; parts that it lacks follow their neighbours.
        frame_rate: Frames per second of `source`.

    Raises:
        SkeletonError: If the source lacks a joint that the profile names.
        NotHumanError: If the proportions are no human's.
    """
    figure = see(source, profile.source_joints(source.skeleton), profile.up)
    if not figure.turned_up and (scale := _reference_scale(source)) is not None:
        return Retargeted(source.root_positions * scale, source.rotations, scale, unchanged=True)
    check_human(source, figure)
    scale = leg_length() / figure.length("UpLeg", "Leg", "Foot")
    axes = {**joint_axes(figure), **profile.axes}
    turned = _turned(figure, axes)
    for part in (f"{side}Shoulder" for side in SIDES):
        if part in figure.parts and part not in profile.axes:
            turned[:, REFERENCE.index(part)] = _shrug(figure, part, turned)
    feet = {}
    for side in SIDES:
        toe = toe_path(figure, turned, side, scale)
        feet[side] = scale * np.stack([figure.at(f"{side}Foot"), toe], axis=1)
    stands = {side: standing(feet[side], frame_rate) for side in SIDES}
    for side in SIDES:
        turned = level_soles(turned, side, feet[side], stands[side], frame_rate)
    hips, turned = _planted(_hips(figure, turned, scale), turned, feet, stands, frame_rate)
    local = kinematics.to_local(REFERENCE, turned)
    notes = ("Z is up",) if figure.turned_up and profile.up is None else ()
    return Retargeted(hips, quaternion.unroll(quaternion.normalize(local)), scale, notes)


def check_human(source: SourceMotion, figure: Figure) -> None:
    """Refuse four-legged and other figures whose limbs have no human's proportions.

    Raises:
        NotHumanError: If a limb has no length, or arms or trunk do not go with the legs.
    """
    leg = figure.length("UpLeg", "Leg", "Foot")
    for part, end in NEXT.items():
        if not np.linalg.norm(figure.bone(part, end)) > _SHORTEST_BONE * leg:
            raise NotHumanError(f"{source.path}: no human: from {part} to {end} there is no length")
    arm = figure.length("Arm", "ForeArm", "Hand")
    trunk = figure.length("UpLeg", "Arm")
    for what, ratio, low, high in (
        ("arms", arm / max(leg, 1e-9), 0.4, 0.85),
        ("trunk", trunk / max(leg, 1e-9), 0.35, 1.0),
    ):
        if not low <= ratio <= high:
            raise NotHumanError(
                f"{source.path}: no human: the {what} measure {ratio:.2f} of the legs, a human's "
                f"{low} to {high}; a live library holds humans, `stridewire convert` keeps others"
            )


def fits(source: SourceMotion, profile: Profile) -> bool:
    """Return whether a skeleton has the profile's joints and its limbs the profile's axes."""
    if not profile.covers(source.skeleton):
        return False
    figure = see(source, profile.source_joints(source.skeleton), profile.up)
    for part, end in NEXT.items():
        if part in profile.axes:
            at_rest = direction(REFERENCE.offsets[REFERENCE.index(end)])
            expected = quaternion.rotate(profile.axes[part], at_rest)
            if expected @ direction(figure.bone(part, end)) < _ALONG:
                return False
    return True


def _reference_scale(source: SourceMotion) -> float | None:
    """Return metres per unit where the file is on the reference skeleton, else None."""
    skeleton = source.skeleton
    if skeleton.names != REFERENCE.names or skeleton.parents != REFERENCE.parents:
        return None
    lower = REFERENCE.indices([side + part for side in SIDES for part in ("Leg", "Foot")])
    leg = np.linalg.norm(skeleton.offsets[lower], axis=-1).sum() / 2.0
    scale = leg_length() / max(float(leg), 1e-9)
    same = np.abs(skeleton.offsets[1:] * scale - REFERENCE.offsets[1:]).max() < _SAME
    return scale if same and source.translations is None else None


def _turned(figure: Figure, axes: dict[str, Quaternions]) -> Quaternions:
    """Return rotations `(T, 22, 4)` of the reference's joints in the world."""
    turned = np.empty((len(figure.positions), len(REFERENCE), 4))
    for column, part in enumerate(figure.parts):
        turned[:, REFERENCE.index(part)] = quaternion.multiply(
            figure.rotations[:, column], axes[part]
        )
        if part in NEXT:
            turned[:, REFERENCE.index(part)] = _aim(figure, part, turned)
    _fill_trunk(figure, turned)
    for part, instead in _INSTEAD.items():
        if part not in figure.parts:
            turned[:, REFERENCE.index(part)] = turned[:, REFERENCE.index(instead)]
    return turned


def _aim(figure: Figure, part: str, turned: Quaternions) -> Quaternions:
    """Point a limb along the source's, whose bones may stretch where joints have positions."""
    rotation = turned[:, REFERENCE.index(part)]
    at_rest = REFERENCE.offsets[REFERENCE.index(NEXT[part])]
    now = quaternion.rotate(rotation, np.broadcast_to(at_rest, (len(rotation), 3)))
    aim = figure.at(NEXT[part]) - figure.at(part)
    aim = np.where(np.linalg.norm(aim, axis=-1, keepdims=True) > 0.0, aim, now)
    return quaternion.multiply(quaternion.between(now, aim), rotation)


def _shrug(figure: Figure, part: str, turned: Quaternions) -> Quaternions:
    """Swing a shoulder against the chest as the source's collar bone; twists of that bone drop."""
    chest = turned[:, REFERENCE.index("Spine2")]
    along = figure.at(part.replace("Shoulder", "Arm")) - figure.at(part)
    local = quaternion.rotate(quaternion.conjugate(chest), along)
    usual = np.median(local, axis=0)
    if min(np.linalg.norm(local, axis=-1).min(), np.linalg.norm(usual)) < 1e-9:
        return chest
    return quaternion.multiply(chest, quaternion.between(usual, local))


def _fill_trunk(figure: Figure, turned: Quaternions) -> None:
    """Give parts of the trunk that the source lacks a rotation between their neighbours'."""
    had = [i for i, part in enumerate(_TRUNK) if part in figure.parts]
    columns = REFERENCE.indices(_TRUNK)
    for i, column in enumerate(columns):
        if i in had:
            continue
        below = max(h for h in had if h < i)
        above = min((h for h in had if h > i), default=below)
        weight = np.array((i - below) / max(above - below, 1))
        turned[:, column] = quaternion.slerp(
            turned[:, columns[below]], turned[:, columns[above]], weight
        )


def _planted(
    hips: Vectors,
    turned: Quaternions,
    feet: dict[str, Vectors],
    stands: dict[str, Flags],
    frame_rate: float,
) -> tuple[Vectors, Quaternions]:
    """Return hips and rotations such that planted toes stay where the source's do."""

    def toes() -> dict[str, Misplaced]:
        return {s: misplaced(hips, turned, s, feet[s], stands[s], frame_rate) for s in SIDES}

    hips = moved(hips, list(toes().values()), frame_rate)
    for side, toe in toes().items():
        turned = plant(hips, turned, side, toe)
    return hips, turned


def _hips(figure: Figure, turned: Quaternions, scale: float) -> Vectors:
    """Return the hips `(T, 3)` such that the middle between the hip joints is the source's."""
    legs = REFERENCE.indices([f"{side}UpLeg" for side in SIDES])
    middle = scale * 0.5 * (figure.at("LeftUpLeg") + figure.at("RightUpLeg"))
    below = np.broadcast_to(REFERENCE.offsets[legs].mean(axis=0), middle.shape)
    return np.asarray(middle - quaternion.rotate(turned[:, 0], below))
