"""Feet of a retargeted motion: flat where the source's stand flat, planted where the source's are.

Feet differ in length and in the pitch that their joints have on flat ground, so carried-over
rotations alone make a planted toe slide while the heel rises. The legs give by a degree instead.
"""

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.clip import differences
from stridewire.motion.skeleton import REFERENCE
from stridewire.motion.two_bone_ik import two_bone_ik

SIDES = ("Left", "Right")

_STILL = 0.15
_LOW = 0.05
_ENOUGH_S = 0.3
_MOST_PITCH = np.deg2rad(20.0)
_UP = np.array([0.0, 1.0, 0.0])
_FORWARD = np.array([0.0, 0.0, 1.0])


def standing(feet: Vectors, frame_rate: float) -> Flags:
    """Return `(T,)` whether a foot stands: ankle and toe slower than 0.15 m/s and the toe low.

    Args:
        feet: `(T, 2, 3)` ankle and toe, metres; the ground at any height.
        frame_rate: Frames per second.
    """
    speed = np.linalg.norm(differences(feet, 1.0 / frame_rate), axis=-1).max(axis=-1)
    height = feet[:, 1, 1]
    return np.asarray((speed < _STILL) & (height < np.percentile(height, 10.0) + _LOW))


def flatten(turned: Quaternions, joint: int, stands: Flags, frame_rate: float) -> Quaternions:
    """Return a joint's rotations `(T, 4)` pitched so that a standing sole is level at the median.

    Too little standing, or a pitch beyond 20 degrees (tiptoes, an unusual rig), leaves it as it is.

    Args:
        turned: `(T, 22, 4)` rotations in the world.
        joint: Index of a foot or toe.
        stands: `(T,)`.
        frame_rate: Frames per second.
    """
    rotation = turned[:, joint]
    if stands.sum() < _ENOUGH_S * frame_rate:
        return rotation
    forward = quaternion.rotate(rotation[stands], np.broadcast_to(_FORWARD, (stands.sum(), 3)))
    pitch = float(np.median(np.arcsin(np.clip(forward[:, 1], -1.0, 1.0))))
    if abs(pitch) > _MOST_PITCH:
        return rotation
    return quaternion.multiply(
        rotation, quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(pitch))
    )


def plant(
    hips: Vectors, turned: Quaternions, side: str, source_toe: Vectors, stands: Flags
) -> Quaternions:
    """Bend a leg so that its toe moves as the source's; return `turned` with new thigh and shin.

    The toe keeps a constant offset from the source's in the foot's heading: the median of standing.

    Args:
        hips: `(T, 3)` in the world, metres.
        turned: `(T, 22, 4)` rotations in the world.
        side: `Left` or `Right`.
        source_toe: `(T, 3)` scaled to metres.
        stands: `(T,)`.
    """
    thigh, shin, foot, toe = REFERENCE.indices(
        [side + part for part in ("UpLeg", "Leg", "Foot", "Toe")]
    )
    positions, _ = kinematics.forward(REFERENCE, hips, kinematics.to_local(REFERENCE, turned))
    heading = _heading(turned[:, foot])
    offset = quaternion.rotate(quaternion.conjugate(heading), positions[:, toe] - source_toe)
    offset = np.median(offset[stands] if stands.any() else offset, axis=0)
    target_toe = source_toe + quaternion.rotate(heading, np.broadcast_to(offset, source_toe.shape))
    target = target_toe - (positions[:, toe] - positions[:, foot])
    limb = two_bone_ik(
        positions[:, thigh],
        positions[:, shin],
        positions[:, foot],
        turned[:, thigh],
        turned[:, shin],
        target,
        quaternion.rotate(turned[:, thigh], np.broadcast_to(_FORWARD, target.shape)),
        buffer=0.001,
    )
    out = turned.copy()
    out[:, thigh], out[:, shin] = limb.upper, limb.lower
    return out


def _heading(foot: Quaternions) -> Quaternions:
    """Return the foot's turn about the vertical; of its upper side where it points down."""
    forward = quaternion.rotate(foot, np.broadcast_to(_FORWARD, (len(foot), 3)))
    up = quaternion.rotate(foot, np.broadcast_to(_UP, (len(foot), 3)))
    # a foot on tiptoes points down while its upper side comes to point forward
    flat: Floats = forward - up * np.minimum(forward[:, 1:2], 0.0)
    return quaternion.from_yaw(np.arctan2(flat[:, 0], flat[:, 2]))
