"""Feet of a retargeted motion: flat where the source's stand flat, planted where the source's are.

Feet differ in length and in the pitch that their joints have on flat ground, so carried-over
rotations alone make a planted toe slide while the heel rises. The legs give by a degree instead.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.clip import differences
from stridewire.motion.skeleton import REFERENCE
from stridewire.motion.two_bone_ik import two_bone_ik
from stridewire_engine.building.figure import Figure

_STILL = 0.15
_SLOW = 0.3
_LOW = 0.05
_FLAT = 0.025
_FADE_S = 0.12
_SLOWLY_S = 0.5
_FREE = np.array([0.03, 0.005, 0.03])
_ENOUGH_S = 0.3
_TIPTOE = np.cos(np.deg2rad(35.0))
_UP = np.array([0.0, 1.0, 0.0])
_FORWARD = np.array([0.0, 0.0, 1.0])


def standing(feet: Vectors, frame_rate: float) -> Flags:
    """Return `(T,)` whether a foot stands flat: ankle and toe slower than 0.15 m/s, both low.

    Args:
        feet: `(T, 2, 3)` ankle and toe, metres; the ground at any height.
        frame_rate: Frames per second.
    """
    speed = np.linalg.norm(differences(feet, 1.0 / frame_rate), axis=-1).max(axis=-1)
    still: Flags = np.asarray((speed < _STILL) & _low(feet[:, 1]))
    if not still.any():
        return still
    # a heel that is up stands, too, but not flat
    ankle = feet[:, 0, 1]
    return np.asarray(still & (ankle < np.percentile(ankle[still], 10.0) + _FLAT))


def toe_path(figure: Figure, turned: Quaternions, side: str, scale: float) -> Vectors:
    """Return where a side's toe is `(T, 3)`, file units; made up ahead of the foot where absent."""
    if side in figure.toes:
        return figure.toes[side]
    foot = turned[:, REFERENCE.index(f"{side}Foot")]
    reach = np.broadcast_to(REFERENCE.offsets[REFERENCE.index(f"{side}Toe")], (len(foot), 3))
    return figure.at(f"{side}Foot") + quaternion.rotate(foot, reach) / scale


def level_soles(
    turned: Quaternions, side: str, feet: Vectors, stands: Flags, frame_rate: float
) -> Quaternions:
    """Return `turned` with foot and toe level while standing and the foot headed along its bone.

    What the joints' axes say about the sole differs from rig to rig and by how markers were placed;
    the median over standing frames decides, unless it is more than 35 degrees off (tiptoes).

    Args:
        turned: `(T, 22, 4)` rotations in the world.
        side: `Left` or `Right`.
        feet: `(T, 2, 3)` ankle and toe, metres.
        stands: `(T,)`.
        frame_rate: Frames per second.
    """
    foot, toe = REFERENCE.indices([f"{side}Foot", f"{side}Toe"])
    out = turned.copy()
    enough = stands.sum() >= _ENOUGH_S * frame_rate
    along = quaternion.rotate(quaternion.conjugate(turned[:, foot]), feet[:, 1] - feet[:, 0])
    up = _sole(turned[stands, foot]) if enough else _UP
    turn = _frame(up, np.median(along, axis=0))
    out[:, foot] = quaternion.multiply(turned[:, foot], turn)
    up = _sole(turned[stands, toe]) if enough else _UP
    ahead = _FORWARD
    if enough:
        world = quaternion.rotate(out[stands, foot], _rows(_FORWARD, stands.sum()))
        local = quaternion.rotate(quaternion.conjugate(turned[stands, toe]), world)
        ahead = np.median(local, axis=0)
    out[:, toe] = quaternion.multiply(turned[:, toe], _frame(up, ahead))
    return out


def _sole(rotation: Quaternions) -> Vectors:
    """Return the direction `(3,)` in a joint's axes that points up, at the median over `(T, 4)`."""
    up = np.median(
        quaternion.rotate(quaternion.conjugate(rotation), _rows(_UP, len(rotation))), axis=0
    )
    up = up / np.linalg.norm(up)
    return up if up[1] > _TIPTOE else _UP


def _frame(up: Vectors, ahead: Vectors) -> Quaternions:
    """Return the turn `(4,)` that takes +Y to `up` and +Z to `ahead`, as far as that is across."""
    level = quaternion.between(_UP, up)
    flat = quaternion.rotate(quaternion.conjugate(level), ahead)
    yaw = np.arctan2(flat[0], flat[2]) if np.hypot(flat[0], flat[2]) > 1e-9 else np.array(0.0)
    return quaternion.multiply(level, quaternion.from_yaw(np.asarray(yaw)))


def _rows(v: Vectors, count: int) -> Vectors:
    return np.broadcast_to(v, (count, 3))


@dataclass(frozen=True)
class Misplaced:
    """How a side's toe would have to move to stay where the source's does."""

    error: Vectors
    """`(T, 3)` metres."""
    near: Floats
    """`(T,)` 1 while the toe is planted, 0 away from the ground."""


def misplaced(
    hips: Vectors,
    turned: Quaternions,
    side: str,
    feet: Vectors,
    stands: Flags,
    frame_rate: float,
) -> Misplaced:
    """Compare a toe with the source's.

    The toe keeps an offset from the source's that is the same throughout a step, since feet pivot
    on planted toes: the one that leaves the leg as it is, but within 3 cm along the ground and half
    a centimetre in height of the median while the foot stands, in the foot's heading.

    Args:
        hips: `(T, 3)` in the world, metres.
        turned: `(T, 22, 4)` rotations in the world.
        side: `Left` or `Right`.
        feet: `(T, 2, 3)` ankle and toe of the source, metres.
        stands: `(T,)` whether the whole foot stands.
        frame_rate: Frames per second.
    """
    positions, _ = kinematics.forward(REFERENCE, hips, kinematics.to_local(REFERENCE, turned))
    heading = _heading(turned[:, REFERENCE.index(f"{side}Foot")])
    off = positions[:, REFERENCE.index(f"{side}Toe")] - feet[:, 1]
    local = quaternion.rotate(quaternion.conjugate(heading), off)
    sure = stands if stands.any() else _low(feet[:, 1])
    kept = quaternion.rotate(heading, _rows(np.median(local[sure], axis=0), len(off)))
    planted = _planted(feet[:, 1], frame_rate)
    usual, own = (_held(offset, planted, frame_rate) for offset in (kept, off))
    kept = usual + np.clip(own - usual, -_FREE, _FREE)
    return Misplaced(kept - off, _near(planted, frame_rate))


def moved(hips: Vectors, sides: Sequence[Misplaced], frame_rate: float) -> Vectors:
    """Return the hips moved by what both legs ask for over half a second while toes are planted.

    Thighs and shins in other proportions put the feet of bent legs elsewhere; in a crouch, moving
    the hips serves both legs better than bending each. Steps are too quick for it to show.
    """
    weight = np.sum([side.near for side in sides], axis=0)[:, None]
    asked = np.sum([side.near[:, None] * side.error for side in sides], axis=0)
    return hips + _smoothed(asked / np.maximum(weight, 1.0), frame_rate, _SLOWLY_S)


def plant(hips: Vectors, turned: Quaternions, side: str, toe: Misplaced) -> Quaternions:
    """Bend a leg so that its toe stays where the source's does; return `turned` with a new leg.

    Away from the ground the leg's own directions hold.

    Args:
        hips: `(T, 3)` in the world, metres.
        turned: `(T, 22, 4)` rotations in the world.
        side: `Left` or `Right`.
        toe: How far it is off with these hips.
    """
    thigh, shin, foot = REFERENCE.indices([side + part for part in ("UpLeg", "Leg", "Foot")])
    positions, _ = kinematics.forward(REFERENCE, hips, kinematics.to_local(REFERENCE, turned))
    target = positions[:, foot] + toe.error * toe.near[:, None]
    limb = two_bone_ik(
        positions[:, thigh],
        positions[:, shin],
        positions[:, foot],
        turned[:, thigh],
        turned[:, shin],
        target,
        quaternion.rotate(turned[:, thigh], _rows(_FORWARD, len(target))),
        buffer=0.001,
    )
    out = turned.copy()
    out[:, thigh], out[:, shin] = limb.upper, limb.lower
    return out


def _low(toe: Vectors) -> Flags:
    return np.asarray(toe[:, 1] < np.percentile(toe[:, 1], 10.0) + _LOW)


def _planted(toe: Vectors, frame_rate: float) -> Flags:
    speed = np.linalg.norm(differences(toe, 1.0 / frame_rate), axis=-1)
    return np.asarray(_low(toe) & (speed < _SLOW))


def _held(values: Vectors, planted: Flags, frame_rate: float) -> Vectors:
    """Replace values `(T, 3)` by their mean over the nearest planted span, smoothly in between."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], planted, [False]]).astype(np.int8)))
    begins, ends = edges[::2], edges[1::2]
    if not len(begins):
        return values
    means = np.array([values[a:b].mean(axis=0) for a, b in zip(begins, ends, strict=True)])
    borders = 0.5 * (ends[:-1] + begins[1:])
    nearest = means[np.searchsorted(borders, np.arange(len(values)))]
    return _smoothed(nearest, frame_rate)


def _near(planted: Flags, frame_rate: float) -> Floats:
    """Return `(T,)` 1 while the toe is planted, fading to 0 over 0.12 s before and after."""
    fade = max(1, round(_FADE_S * frame_rate))
    held = np.convolve(planted, np.ones(2 * fade + 1))[fade:-fade] > 0.5
    return _smoothed(held[:, None].astype(np.float64), frame_rate)[:, 0]


def _smoothed(values: Floats, frame_rate: float, seconds: float = _FADE_S) -> Floats:
    """Average `(T, C)` over some seconds to both sides, the ends held."""
    fade = max(1, round(seconds * frame_rate))
    window = np.hanning(2 * fade + 3)[1:-1]
    padded = np.pad(values, ((fade, fade), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * fade + 1, axis=0)
    return np.asarray(windows @ (window / window.sum()))


def _heading(foot: Quaternions) -> Quaternions:
    """Return the foot's turn about the vertical; of its upper side where it points down."""
    forward = quaternion.rotate(foot, np.broadcast_to(_FORWARD, (len(foot), 3)))
    up = quaternion.rotate(foot, np.broadcast_to(_UP, (len(foot), 3)))
    # a foot on tiptoes points down while its upper side comes to point forward
    flat: Floats = forward - up * np.minimum(forward[:, 1:2], 0.0)
    return quaternion.from_yaw(np.arctan2(flat[:, 0], flat[:, 2]))
