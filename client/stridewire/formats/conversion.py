"""Converting motions on their own skeletons: frame rate, units, up axis."""

from dataclasses import replace

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.resample import resample_rotations, resample_values
from stridewire.motion.skeleton import Skeleton


def with_rate(motion: SourceMotion, frame_rate: float) -> SourceMotion:
    """Resample to another frame rate with continuous velocities.

    Raises:
        ValueError: If the motion says no frame rate or has fewer than two frames.
    """
    if motion.frame_rate is None:
        raise ValueError(f"{motion.path} says no frame rate; give the true one")
    if motion.frame_rate == frame_rate:
        return motion
    old = motion.frame_rate
    moving = motion.translations
    return replace(
        motion,
        frame_rate=frame_rate,
        root_positions=resample_values(motion.root_positions, old, frame_rate),
        rotations=resample_rotations(motion.rotations, old, frame_rate),
        translations=None if moving is None else resample_values(moving, old, frame_rate),
    )


def scaled(motion: SourceMotion, factor: float) -> SourceMotion:
    """Multiply all lengths, as for other units."""
    skeleton = motion.skeleton
    unit = motion.metres_per_unit
    return replace(
        motion,
        skeleton=Skeleton(skeleton.names, skeleton.parents, skeleton.offsets * factor),
        tips={joint: tip * factor for joint, tip in motion.tips.items()},
        root_positions=motion.root_positions * factor,
        translations=None if motion.translations is None else motion.translations * factor,
        metres_per_unit=None if unit is None else unit / factor,
    )


def turned_up(motion: SourceMotion, old: str, new: str) -> SourceMotion:
    """Turn the world a quarter about X so that another axis points up.

    Args:
        motion: To be turned.
        old: `Y` or `Z`, which points up now.
        new: `Y` or `Z`, which shall.
    """
    if old == new:
        return motion
    angle = 0.5 * np.pi if new == "Z" else -0.5 * np.pi
    turn = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(angle))
    rotations = motion.rotations.copy()
    rotations[:, 0] = quaternion.multiply(turn, rotations[:, 0])
    rows = np.broadcast_to(turn, (len(motion), 4))
    root = quaternion.rotate(rows, motion.root_positions)
    moving = motion.translations
    if moving is not None:
        moving = moving.copy()
        moving[:, 0] = root
    return replace(motion, root_positions=root, rotations=rotations, translations=moving)
