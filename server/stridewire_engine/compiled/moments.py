"""Moments of clips for kernels: where a time is in a library, and how the root moves between two.

The counterpart of `runtime.sampling`, for one character at a time.
"""

import math
from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.compiled import kernel


class Clips(NamedTuple):
    """What kernels read of a library: C clips of F frames in all, J joints."""

    starts: Indices
    """`(C,)` first row."""
    frames: Indices
    """`(C,)`."""
    loops: Flags
    """`(C,)`."""
    laps: Floats
    """`(C, 3)` way x, z and turn from a loop's first frame to its last."""
    root_position: Vectors
    """`(F, 3)`."""
    root_yaw: Floats
    """`(F,)`."""
    hips: Vectors
    """`(F, 3)`."""
    rotations: Quaternions
    """`(F, J, 4)`."""
    contacts: Flags
    """`(F, 4)`."""
    hip_tracks: Vectors
    """`(F, 2, 3)` hip joints in the root's frame."""
    ankle_tracks: Vectors
    """`(F, 2, 3)`."""
    toe_tracks: Vectors
    """`(F, 2, 3)`."""
    frame_rate: float


@kernel
def moment(clips: Clips, clip: int, time: float) -> tuple[int, float]:
    """Return the row at or before a time of a clip and the share of the next row."""
    last = clips.frames[clip] - 1
    at = time * clips.frame_rate
    at = np.mod(at, float(max(last, 1))) if clips.loops[clip] else min(max(at, 0.0), float(last))
    frame = min(int(at), max(last - 1, 0))
    return clips.starts[clip] + frame, float(np.float32(at - frame))


@kernel
def nearest(row: int, weight: float) -> int:
    """Return the nearer of both rows."""
    return row + 1 if weight >= 0.5 else row


@kernel
def root_at(clips: Clips, row: int, weight: float) -> tuple[float, float, float]:
    """Return x, z and yaw of the root in the clip's own space."""
    ax, az = float(clips.root_position[row, 0]), float(clips.root_position[row, 2])
    bx, bz = float(clips.root_position[row + 1, 0]), float(clips.root_position[row + 1, 2])
    a, b = float(clips.root_yaw[row]), float(clips.root_yaw[row + 1])
    return ax + weight * (bx - ax), az + weight * (bz - az), a + weight * (b - a)


@kernel
def root_step(
    clips: Clips, clip: int, row: int, weight: float, row_after: int, weight_after: float
) -> tuple[float, float, float]:
    """Return root motion x, z in the root's frame before, yaw; through the end of a loop."""
    x, z, yaw = root_at(clips, row, weight)
    x_after, z_after, yaw_after = root_at(clips, row_after, weight_after)
    if clips.loops[clip] and row_after + weight_after < row + weight:
        first = clips.starts[clip]
        x0, z0 = float(clips.root_position[first, 0]), float(clips.root_position[first, 2])
        heading, turn = float(clips.root_yaw[first]), clips.laps[clip, 2]
        rest_x, rest_z = turned(x_after - x0, z_after - z0, turn)
        lap_x, lap_z = turned(clips.laps[clip, 0], clips.laps[clip, 1], heading)
        x_after, z_after = x0 + lap_x + rest_x, z0 + lap_z + rest_z
        yaw_after += turn
    way_x, way_z = turned(x_after - x, z_after - z, -yaw)
    return way_x, way_z, yaw_after - yaw


@kernel
def turned(x: float, z: float, yaw: float) -> tuple[float, float]:
    """Return a way over the ground turned by a yaw."""
    sine, cosine = math.sin(yaw), math.cos(yaw)
    return x * cosine + z * sine, z * cosine - x * sine
