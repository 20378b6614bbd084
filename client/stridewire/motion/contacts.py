"""Contacts: which of the four foot joints are planted."""

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.clip import differences
from stridewire.motion.skeleton import CONTACT_JOINTS, Skeleton

_PLANT_SPEED = 0.15
_LIFT_SPEED = 0.25
_PLANT_SHARE = 0.1
_LIFT_SHARE = 0.2
_PACE_S = 0.5
_HEIGHT_ABOVE_REST = 0.06
_MEDIAN_S = 0.1


def detect_contacts(skeleton: Skeleton, positions: Vectors, frame_rate: float) -> Flags:
    """Return `(T, 4)` flags: left foot, left toe, right foot, right toe planted.

    A joint is planted below 0.15 m/s within 6 cm of its height at rest, and stays so up to 0.25
    m/s; faster than 1.5 m/s, below a tenth and up to a fifth of the body's pace, since feet that
    run roll and creep. A median over 0.1 s removes flicker.

    Args:
        skeleton: Must have the four joints; its rest pose stands on the ground y = 0.
        positions: `(T, J, 3)` joints in the world, metres, the ground at y = 0.
        frame_rate: Frames per second.
    """
    joints = skeleton.indices(CONTACT_JOINTS)
    speed = np.linalg.norm(differences(positions[:, joints], 1.0 / frame_rate), axis=-1)
    pace = _pace(positions[:, 0], frame_rate)[:, None]
    plants = speed < np.maximum(_PLANT_SPEED, _PLANT_SHARE * pace)
    lasts = speed < np.maximum(_LIFT_SPEED, _LIFT_SHARE * pace)
    low = positions[:, joints, 1] < rest_heights(skeleton, joints) + _HEIGHT_ABOVE_REST
    planted = _hysteresis(low & plants, low & lasts)
    return _median(planted, 2 * round(0.5 * _MEDIAN_S * frame_rate) + 1)


def rest_heights(skeleton: Skeleton, joints: Indices) -> Floats:
    """Return the heights above the ground `(len(joints),)` of joints at rest; metres."""
    heights = np.zeros(len(skeleton))
    for joint, parent in enumerate(skeleton.parents):
        heights[joint] = skeleton.offsets[joint, 1] + (heights[parent] if parent >= 0 else 0.0)
    return heights[joints]


def to_mask(contacts: Flags) -> Indices:
    """Pack flags `(..., 4)` into masks: 1 left foot, 2 left toe, 4 right foot, 8 right toe."""
    return np.asarray((contacts * np.array([1, 2, 4, 8], np.uint32)).sum(-1, dtype=np.uint32))


def _pace(hips: Vectors, frame_rate: float) -> Floats:
    """Return the speed over the ground `(T,)`, averaged over half a second."""
    velocity = differences(hips, 1.0 / frame_rate)[:, [0, 2]]
    half = round(0.5 * _PACE_S * frame_rate)
    padded = np.pad(velocity, ((half, half), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    return np.asarray(np.linalg.norm(windows.mean(axis=-1), axis=-1))


def _hysteresis(on: Flags, hold: Flags) -> Flags:
    """Switch on at `on`, stay on while `hold`."""
    frames = np.arange(len(on))[:, None]
    last_on = np.maximum.accumulate(np.where(on, frames, -1), axis=0)
    last_off = np.maximum.accumulate(np.where(~hold, frames, -1), axis=0)
    return last_on > last_off


def _median(flags: Flags, window: int) -> Flags:
    half = window // 2
    padded = np.pad(flags, ((half, half), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, window, axis=0)
    return np.asarray(windows.sum(axis=-1) > half)
