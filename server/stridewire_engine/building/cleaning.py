"""Cleaning: from a retargeted motion to a clip on the ground, with a root and contacts."""

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.clip import Clip, differences
from stridewire.motion.contacts import detect_contacts, rest_heights
from stridewire.motion.resample import resample_rotations, resample_values
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import REFERENCE

FRAME_RATE = 60.0
"""Frames per second of all clips of a library."""

_STILL = 0.15
_FLOOR_PERCENTILE = 25.0
_TOES = ("LeftToe", "RightToe")


def clean(
    name: str,
    hips: Vectors,
    rotations: Quaternions,
    frame_rate: float,
    source: str,
    floor: float | None = None,
) -> Clip:
    """Resample to 60 frames/s, set on the ground, split off the root and find contacts.

    Args:
        name: Of the clip.
        hips: `(T, 3)` in the world, metres.
        rotations: `(T, 22, 4)` local on the reference skeleton, the hips' in the world.
        frame_rate: Frames per second of the arrays.
        source: File that the motion came from.
        floor: Height of the ground in metres; found where None.
    """
    if frame_rate != FRAME_RATE:
        hips = resample_values(hips, frame_rate, FRAME_RATE)
        rotations = resample_rotations(rotations, frame_rate, FRAME_RATE)
    positions, _ = kinematics.forward(REFERENCE, hips, rotations)
    drop = np.array([0.0, floor_height(positions) if floor is None else floor, 0.0])
    hips, positions = hips - drop, positions - drop
    pose = extract_root(REFERENCE, hips, rotations, FRAME_RATE).astype(np.float32)
    contacts = detect_contacts(REFERENCE, positions, FRAME_RATE)
    return Clip(name, REFERENCE, FRAME_RATE, pose, contacts, source=source)


def floor_height(positions: Vectors) -> float:
    """Return the height of the ground, metres, as planted toes show it.

    A low percentile of the toes' heights while they stand still: the minimum would follow noise and
    toes pressed into the ground, the median steps onto boxes.

    Args:
        positions: `(T, 22, 3)` at 60 frames/s on the reference skeleton.
    """
    toes = REFERENCE.indices(_TOES)
    height: Floats = positions[:, toes, 1] - rest_heights(REFERENCE, toes)
    still = np.linalg.norm(differences(positions[:, toes], 1.0 / FRAME_RATE), axis=-1) < _STILL
    if still.sum() < FRAME_RATE * 0.5:
        return float(np.percentile(height, 5.0))
    return float(np.percentile(height[still], _FLOOR_PERCENTILE))
