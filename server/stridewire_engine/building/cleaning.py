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

_LEADING = 3
_JUMP = np.deg2rad(2.0)
_SPIKE = np.deg2rad(15.0)
_FROZEN = 1e-6
_GAP_FRAMES = 6
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


def leading_pose(rotations: Quaternions) -> int:
    """Return how many frames at the beginning are a rest pose, cut off from the motion by a jump.

    A jump turns all joints by more than 2 degrees on average and thrice as far as the motion does.

    Args:
        rotations: `(T, J, 4)` local.
    """
    steps = _steps(rotations).mean(axis=-1)
    if len(steps) < 2 * _LEADING:
        return 0
    usual = np.percentile(steps[_LEADING:], 95.0)
    jumps = np.flatnonzero(steps[:_LEADING] > max(3.0 * usual, _JUMP))
    return int(jumps[-1]) + 1 if len(jumps) else 0


def oddities(clip: Clip) -> list[str]:
    """Return what a person should look at: spikes and gaps, with the first time and joint."""
    found = []
    steps = _steps(clip.pose.rotations.astype(np.float64))
    around = _angle(clip.pose.rotations[2:], clip.pose.rotations[:-2])
    spikes = (np.minimum(steps[1:], steps[:-1]) > _SPIKE) & (around < 0.5 * _SPIKE)
    if spikes.any():
        frame, joint = np.argwhere(spikes)[0]
        found.append(
            f"{int(spikes.any(axis=-1).sum())} spike(s), the first at "
            f"{(frame + 1) / clip.frame_rate:.2f} s in {clip.skeleton.names[joint]}"
        )
    still = np.abs(np.diff(clip.pose.rotations, axis=0)).max(axis=(1, 2)) < _FROZEN
    frozen = np.concatenate([[False], still, [False]])
    edges = np.flatnonzero(np.diff(frozen.astype(np.int8)))
    gaps = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > _GAP_FRAMES]
    if gaps:
        found.append(
            f"{len(gaps)} gap(s) without any motion, the first at "
            f"{gaps[0][0] / clip.frame_rate:.2f} s"
        )
    return found


def _steps(rotations: Quaternions) -> Floats:
    return _angle(rotations[1:], rotations[:-1])


def _angle(a: Quaternions, b: Quaternions) -> Floats:
    dots = np.abs(np.sum(a.astype(np.float64) * b, axis=-1))
    return np.asarray(2.0 * np.arccos(np.minimum(dots, 1.0)))


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
