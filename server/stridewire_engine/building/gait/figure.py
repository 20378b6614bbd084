"""The figure: bend the legs to planted feet and make a clip of it."""

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.clip import Clip, differences
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import REFERENCE
from stridewire.motion.two_bone_ik import two_bone_ik
from stridewire_engine.building.gait.planting import Feet
from stridewire_engine.building.gait.script import FRAME_RATE

_LEGS = tuple(
    REFERENCE.indices((f"{side}UpLeg", f"{side}Leg", f"{side}Foot", f"{side}Toe"))
    for side in ("Left", "Right")
)
_LEG_LENGTH = float(-REFERENCE.offsets[_LEGS[0][1], 1] - REFERENCE.offsets[_LEGS[0][2], 1])
_REACH = 0.997 * _LEG_LENGTH
_FOOT = REFERENCE.offsets[_LEGS[0][3]]
_MAX_HEEL_LIFT = np.radians(65.0)
_STILL = 0.1


def make_clip(name: str, hips: Vectors, rotations: Quaternions, feet: Feet, source: str) -> Clip:
    """Bend the legs and split off the root.

    Args:
        name: Of the clip.
        hips: `(T, 3)` in the world; lowered where a foot is out of reach.
        rotations: `(T, J, 4)` local, the hips' in the world; the legs are overwritten.
        feet: Planted feet.
        source: Of the clip.
    """
    pitch = _raise_heels(hips, rotations[:, 0], feet)
    ankles = _ankles(feet.toe, feet.yaw, pitch)
    hips = hips - _drop(hips, rotations[:, 0], ankles)[:, None] * np.array([0.0, 1.0, 0.0])
    rotations = rotations.copy()
    for side in range(2):
        _bend_leg(rotations, hips, ankles[:, side], feet, pitch, side)
    pose = extract_root(REFERENCE, hips, quaternion.unroll(rotations), FRAME_RATE)
    flat = feet.planted & (np.linalg.norm(differences(ankles, 1.0 / FRAME_RATE), axis=-1) < _STILL)
    contacts = np.stack([flat, feet.planted], axis=-1).reshape(len(hips), 4)
    return Clip(name, REFERENCE, FRAME_RATE, pose, contacts, source=source)


def _hip_joints(hips: Vectors, rotation: Quaternions) -> Vectors:
    """Return `(T, 2, 3)` where the legs begin."""
    offsets = REFERENCE.offsets[[leg[0] for leg in _LEGS]]
    offsets = np.broadcast_to(offsets, (len(hips), 2, 3))
    return hips[:, None] + quaternion.rotate(rotation[:, None], offsets)


def _foot_rotation(yaw: Floats, pitch: Floats) -> Quaternions:
    return quaternion.from_euler(np.stack([yaw, pitch], axis=-1), "yx")


def _ankles(toe: Vectors, yaw: Floats, pitch: Floats) -> Vectors:
    foot = np.broadcast_to(_FOOT, toe.shape)
    return toe - quaternion.rotate(_foot_rotation(yaw, pitch), foot)


def _raise_heels(hips: Vectors, rotation: Quaternions, feet: Feet) -> Floats:
    """Return pitches `(T, 2)`: heels as much higher as a leg needs to reach its planted toe."""
    start = _hip_joints(hips, rotation)
    pitch = feet.pitch.copy()
    for _ in range(40):
        far = np.linalg.norm(_ankles(feet.toe, feet.yaw, pitch) - start, axis=-1) > _REACH
        far &= pitch < _MAX_HEEL_LIFT
        if not far.any():
            break
        pitch += np.radians(1.5) * far
    lift = gaussian_filter1d(pitch - feet.pitch, 2.0, axis=0, mode="nearest")
    return np.asarray(feet.pitch + lift)


def _drop(hips: Vectors, rotation: Quaternions, ankles: Vectors) -> Floats:
    """Return by how much `(T,)` to lower the hips so that both legs reach."""
    reach = _hip_joints(hips, rotation) - ankles
    planar = np.hypot(reach[..., 0], reach[..., 2])
    highest = np.sqrt(np.maximum(_REACH**2 - planar**2, 0.0))
    need = np.maximum(reach[..., 1] - highest, 0.0).max(axis=1)
    return np.asarray(gaussian_filter1d(maximum_filter1d(need, 9), 2.5, mode="nearest"))


def _bend_leg(
    rotations: Quaternions, hips: Vectors, ankle: Vectors, feet: Feet, pitch: Floats, side: int
) -> None:
    upper, lower, foot, toe = _LEGS[side]
    rotations[:, [upper, lower, foot, toe]] = quaternion.IDENTITY
    positions, turned = kinematics.forward(REFERENCE, hips, rotations)
    planted_turn = _foot_rotation(feet.yaw[:, side], pitch[:, side])
    limb = two_bone_ik(
        positions[:, upper],
        positions[:, lower],
        positions[:, foot],
        turned[:, upper],
        turned[:, lower],
        ankle,
        _knee_direction(rotations[:, 0], feet.yaw[:, side]),
        buffer=0.004,
    )
    back = quaternion.conjugate
    rotations[:, upper] = quaternion.multiply(back(rotations[:, 0]), limb.upper)
    rotations[:, lower] = quaternion.multiply(back(limb.upper), limb.lower)
    rotations[:, foot] = quaternion.multiply(back(limb.lower), planted_turn)
    rotations[:, toe] = _toe_bend(feet, pitch, side)


def _knee_direction(hips: Quaternions, yaw: Floats) -> Vectors:
    """Return the unit direction halfway between the pelvis' forward and the foot's."""
    ahead = np.broadcast_to([0.0, 0.0, 1.0], (len(yaw), 3))
    both = quaternion.rotate(hips, ahead) + quaternion.rotate(quaternion.from_yaw(yaw), ahead)
    return np.asarray(both / np.linalg.norm(both, axis=-1, keepdims=True))


def _toe_bend(feet: Feet, pitch: Floats, side: int) -> Quaternions:
    """Keep the toes flat on the ground under a raised heel, straight in the air."""
    near = np.clip(1.0 - (feet.toe[:, side, 1] - 0.02) / 0.05, 0.0, 1.0)
    bend = np.clip(pitch[:, side], 0.0, np.radians(60.0)) * near
    return quaternion.from_axis_angle((1.0, 0.0, 0.0), -bend)
