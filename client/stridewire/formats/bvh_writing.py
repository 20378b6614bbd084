"""Writing BVH: centimetres, Y up, joints turn in the order Z, Y, X."""

from pathlib import Path

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import HEAD_TOP, Skeleton

CENTIMETRES = 100.0
"""Per metre; most animation tools take BVH for centimetres."""


def write_bvh(path: Path | str, clip: Clip) -> None:
    """Write a clip as BVH in centimetres: root `Xp Yp Zp Zr Yr Xr`, other joints `Zr Yr Xr`.

    The root's channels hold the hips in the world; the root on the ground and the contacts are
    found again when the file is imported.

    Raises:
        OSError: If the file cannot be written.
    """
    hips, turn = clip.pose.world_hips
    rotations = clip.pose.rotations.astype(np.float64)
    rotations[:, 0] = turn
    angles = np.rad2deg(quaternion.to_euler_zyx(rotations)).reshape(len(clip), -1)
    values = np.concatenate([hips.astype(np.float64) * CENTIMETRES, angles], axis=1)
    with Path(path).open("w", encoding="utf-8", newline="\n") as file:
        file.write("HIERARCHY\n")
        file.write("\n".join(_joint(clip.skeleton, 0, "")))
        file.write(f"\nMOTION\nFrames: {len(clip)}\nFrame Time: {1.0 / clip.frame_rate:.9f}\n")
        np.savetxt(file, values, fmt="%.5f")


def _joint(skeleton: Skeleton, joint: int, indent: str) -> list[str]:
    offset = skeleton.offsets[joint] * CENTIMETRES
    position = "6 Xposition Yposition Zposition" if joint == 0 else "3"
    lines = [
        f"{indent}{'JOINT' if joint else 'ROOT'} {skeleton.names[joint]}",
        f"{indent}{{",
        f"{indent}\tOFFSET {_numbers(offset)}",
        f"{indent}\tCHANNELS {position} Zrotation Yrotation Xrotation",
    ]
    children = [child for child, parent in enumerate(skeleton.parents) if parent == joint]
    for child in children:
        lines += _joint(skeleton, child, f"{indent}\t")
    if not children:
        tip = _tip(skeleton, joint) * CENTIMETRES
        end = (f"{indent}\tEnd Site", f"{indent}\t{{", f"{indent}\t\tOFFSET {_numbers(tip)}")
        lines += [*end, f"{indent}\t}}"]
    return [*lines, f"{indent}}}"]


def _tip(skeleton: Skeleton, joint: int) -> np.ndarray:
    """Return where a last bone ends; tools that draw bones need a length."""
    if skeleton.names[joint] == "Head":
        return np.array([0.0, HEAD_TOP, 0.0])
    offset = skeleton.offsets[joint]
    flat = offset * [1.0, 0.0, 1.0] if skeleton.names[joint].endswith("Toe") else offset
    return np.asarray(0.5 * flat)


def _numbers(values: np.ndarray) -> str:
    return " ".join(f"{value:.6f}" for value in values)
