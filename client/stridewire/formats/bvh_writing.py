"""Writing BVH: joints turn in the order Z, Y, X; joints that move have positions too."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.array_types import Vectors
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import HEAD_TOP, Skeleton

CENTIMETRES = 100.0
"""Per metre; most animation tools take BVH for centimetres."""

_POSITIONS = "Xposition Yposition Zposition"
_ROTATIONS = "Zrotation Yrotation Xrotation"


def write_bvh(path: Path | str, clip: Clip) -> None:
    """Write a clip as BVH in centimetres, Y up.

    The root's channels hold the hips in the world; the root on the ground and the contacts are
    found again when the file is imported.

    Raises:
        OSError: If the file cannot be written.
    """
    write_source_bvh(path, clip_in_centimetres(clip, Path(path)))


def clip_in_centimetres(clip: Clip, path: Path) -> SourceMotion:
    """Return a clip as a motion file holds it: hips in the world, lengths in centimetres."""
    hips, turn = clip.pose.world_hips
    rotations = clip.pose.rotations.astype(np.float64)
    rotations[:, 0] = turn
    skeleton = clip.skeleton.scaled(CENTIMETRES)
    return SourceMotion(
        path=path,
        skeleton=skeleton,
        tips={j: CENTIMETRES * tip for j, tip in leaf_tips(clip.skeleton).items()},
        frame_rate=clip.frame_rate,
        root_positions=hips.astype(np.float64) * CENTIMETRES,
        rotations=rotations,
        metres_per_unit=1.0 / CENTIMETRES,
    )


def write_source_bvh(path: Path | str, motion: SourceMotion) -> None:
    """Write a motion on its own skeleton, units and axes.

    Raises:
        ValueError: If it has no frame rate.
        OSError: If the file cannot be written.
    """
    if motion.frame_rate is None:
        raise ValueError(f"{motion.path} says no frame rate; give one")
    order = list(_depth_first(motion.skeleton, 0))
    angles = np.rad2deg(quaternion.to_euler_zyx(motion.rotations))
    columns = []
    for joint in order:
        if joint == 0:
            columns.append(motion.root_positions)
        elif motion.translations is not None:
            columns.append(motion.translations[:, joint])
        columns.append(angles[:, joint])
    with Path(path).open("w", encoding="utf-8", newline="\n") as file:
        file.write("HIERARCHY\n")
        file.write("\n".join(_joint(motion, 0, "")))
        file.write(f"\nMOTION\nFrames: {len(motion)}\nFrame Time: {1.0 / motion.frame_rate:.9f}\n")
        np.savetxt(file, np.concatenate(columns, axis=1), fmt="%.6f")


def _depth_first(skeleton: Skeleton, joint: int) -> Iterator[int]:
    yield joint
    for child in _children(skeleton, joint):
        yield from _depth_first(skeleton, child)


def _children(skeleton: Skeleton, joint: int) -> list[int]:
    return [child for child, parent in enumerate(skeleton.parents) if parent == joint]


def _joint(motion: SourceMotion, joint: int, indent: str) -> list[str]:
    skeleton = motion.skeleton
    moves = joint == 0 or motion.translations is not None
    channels = f"6 {_POSITIONS} {_ROTATIONS}" if moves else f"3 {_ROTATIONS}"
    lines = [
        f"{indent}{'JOINT' if joint else 'ROOT'} {skeleton.names[joint]}",
        f"{indent}{{",
        f"{indent}\tOFFSET {_numbers(skeleton.offsets[joint])}",
        f"{indent}\tCHANNELS {channels}",
    ]
    children = _children(skeleton, joint)
    for child in children:
        lines += _joint(motion, child, f"{indent}\t")
    if joint in motion.tips or not children:
        tip = _numbers(motion.tips.get(joint, np.zeros(3)))
        lines += [f"{indent}\tEnd Site", f"{indent}\t{{", f"{indent}\t\tOFFSET {tip}"]
        lines.append(f"{indent}\t}}")
    return [*lines, f"{indent}}}"]


def leaf_tips(skeleton: Skeleton) -> dict[int, Vectors]:
    """Return where last bones end, by their joint; metres: tools that draw bones need lengths."""
    leaves = set(range(len(skeleton))) - set(skeleton.parents)
    return {joint: _tip(skeleton, joint) for joint in sorted(leaves)}


def _tip(skeleton: Skeleton, joint: int) -> Vectors:
    """Return a last bone by its name and its offset."""
    if skeleton.names[joint] == "Head":
        return np.array([0.0, HEAD_TOP, 0.0])
    offset = skeleton.offsets[joint]
    flat = offset * [1.0, 0.0, 1.0] if skeleton.names[joint].endswith("Toe") else offset
    return np.asarray(0.5 * flat)


def _numbers(values: Vectors) -> str:
    return " ".join(f"{value:.6f}" for value in values)
