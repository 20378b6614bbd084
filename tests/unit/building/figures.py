"""Small human figures with rest poses of many kinds, for tests of the importer."""

from pathlib import Path

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Quaternions
from stridewire.motion.skeleton import REFERENCE, Skeleton


def walking(frames: int = 240, frame_rate: float = 60.0) -> tuple[np.ndarray, Quaternions]:
    """Return hips `(T, 3)` and local rotations `(T, 22, 4)` of a plain walk that turns, metres."""
    t = np.arange(frames) / frame_rate
    phase = 2.0 * np.pi * 0.9 * t
    bends = {
        "LeftUpLeg": (-0.4 * np.sin(phase) - 0.15, 0, 0),
        "RightUpLeg": (0.4 * np.sin(phase) - 0.15, 0, 0),
        "LeftLeg": (0.4 - 0.35 * np.cos(phase), 0, 0),
        "RightLeg": (0.4 + 0.35 * np.cos(phase), 0, 0),
        "Spine": (0.05 + 0 * t, 0.05 * np.sin(phase), 0),
        "LeftArm": (0.3 * np.sin(phase), 0, -1.2 + 0 * t),
        "RightArm": (-0.3 * np.sin(phase), 0, 1.2 + 0 * t),
        "LeftForeArm": (0, -0.5 - 0.3 * np.sin(phase), 0),
        "RightForeArm": (0, 0.5 - 0.3 * np.sin(phase), 0),
    }
    rotations = quaternion.identity(frames, len(REFERENCE), dtype=np.float64)
    for name, axis in bends.items():
        vector = np.stack([np.broadcast_to(np.asarray(a, float), t.shape) for a in axis], axis=-1)
        rotations[:, REFERENCE.index(name)] = quaternion.from_scaled_axis(vector)
    yaw = 0.5 * t
    rotations[:, 0] = quaternion.from_yaw(yaw)
    hips = np.stack(
        [1.2 * (1 - np.cos(yaw)), 0.93 + 0.01 * np.cos(2 * phase), 1.2 * np.sin(yaw)], -1
    )
    return hips, rotations


def source(
    axes: Quaternions | None = None,
    scale: float = 100.0,
    rename: dict[str, str] | None = None,
    z_up: bool = False,
    **how: int | float,
) -> SourceMotion:
    """Return the walk on a rig whose joints are turned and renamed, as a file would hold it.

    Args:
        axes: `(22, 4)` turn of each joint's axes against the reference's.
        scale: File units per metre.
        rename: New names by reference joint.
        z_up: Whether the world has Z up.
        how: Passed on to `walking`.
    """
    hips, local = walking(**how)  # type: ignore[arg-type]
    _, turned = kinematics.forward(REFERENCE, hips, local)
    offsets = REFERENCE.offsets * scale
    if axes is not None:
        turned = quaternion.multiply(turned, axes)
        parents = np.array(REFERENCE.parents[1:])
        offsets = offsets.copy()
        offsets[1:] = quaternion.rotate(quaternion.conjugate(axes[parents]), offsets[1:])
    if z_up:
        up = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(0.5 * np.pi))
        turned = quaternion.multiply(up, turned)
        hips = quaternion.rotate(np.broadcast_to(up, (len(hips), 4)), hips)
    names = tuple((rename or {}).get(name, name) for name in REFERENCE.names)
    skeleton = Skeleton(names, REFERENCE.parents, offsets)
    return SourceMotion(
        path=Path("walk.bvh"),
        skeleton=skeleton,
        tips={},
        frame_rate=float(how.get("frame_rate", 60.0)),
        root_positions=hips * scale,
        rotations=kinematics.to_local(skeleton, turned),
    )
