"""Sampling: what the library holds between its frames, for N characters at once."""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.library import Library
from stridewire_engine.stitchers import Motion


class Moments(NamedTuple):
    """Where N characters are in the library: between a row and the next one."""

    rows: Indices
    """`(N,)` row at or before the time."""
    weight: Floats
    """`(N,)` float32 share of the next row."""

    @property
    def nearest(self) -> Indices:
        """`(N,)` the nearer of both rows."""
        return self.rows + (self.weight >= 0.5)

    def repeated(self, count: int) -> "Moments":
        """Return each moment so many times in a row."""
        return Moments(np.repeat(self.rows, count), np.repeat(self.weight, count))


def wrap_times(library: Library, clip: Indices, time: Floats) -> Floats:
    """Return times `(N,)` within loops, from 0 to their length; other clips' times as they are."""
    length = (library.clip_frames[clip] - 1) / library.frame_rate
    return np.where(library.loops[clip], np.mod(time, np.maximum(length, 1e-6)), time)


def moments(library: Library, clip: Indices, time: Floats) -> Moments:
    """Return where clips `(N,)` are at `time` `(N,)`: loops begin anew, others stand still."""
    last = library.clip_frames[clip] - 1
    at = time * library.frame_rate
    at = np.where(library.loops[clip], np.mod(at, np.maximum(last, 1)), np.clip(at, 0.0, last))
    frame = np.minimum(at.astype(np.int64), np.maximum(last - 1, 0))
    return Moments(library.clip_starts[clip] + frame, (at - frame).astype(np.float32))


def sample_pose(
    library: Library, at: Moments, joints: int | None = None
) -> tuple[Vectors, Quaternions]:
    """Return hips `(N, 3)` relative to the root and local rotations `(N, J, 4)`.

    Args:
        library: The library.
        at: Moments.
        joints: J, if only the first ones are wanted.
    """
    weight = at.weight[:, None]
    a, b = library.hips[at.rows], library.hips[at.rows + 1]
    turns = library.rotations[:, :joints]
    rotations = quaternion.nlerp(turns[at.rows], turns[at.rows + 1], weight)
    return a + weight * (b - a), rotations


def sample_root(library: Library, at: Moments) -> tuple[Vectors, Floats]:
    """Return root positions `(N, 3)` and yaws `(N,)` in the clips' own spaces, float64."""
    weight = at.weight.astype(np.float64)
    a, b = library.root_position[at.rows], library.root_position[at.rows + 1]
    yaw_a, yaw_b = library.root_yaw[at.rows], library.root_yaw[at.rows + 1]
    position = a + weight[:, None] * (b.astype(np.float64) - a)
    return position, yaw_a + weight * (yaw_b.astype(np.float64) - yaw_a)


def sample_motion(library: Library, at: Moments, pace: Floats, toes: Vectors) -> Motion:
    """Return poses and their rates of change, those of the interpolant between both rows.

    Args:
        library: The library.
        at: Moments.
        pace: `(N,)` seconds of the clip for each second that passes.
        toes: `(F, 2, 3)` toes in every frame of the library, relative to the root.
    """
    hips, rotations = sample_pose(library, at)
    rate = (library.frame_rate * pace[:, None]).astype(np.float32)
    toe, toe_after = toes[at.rows], toes[at.rows + 1]
    step = quaternion.multiply(
        library.rotations[at.rows + 1], quaternion.conjugate(library.rotations[at.rows])
    )
    return Motion(
        hips,
        rotations,
        (library.hips[at.rows + 1] - library.hips[at.rows]) * rate,
        quaternion.to_scaled_axis(step) * rate[:, None],
        toe + at.weight[:, None, None] * (toe_after - toe),
        (toe_after - toe) * rate[:, None],
    )


def root_delta(library: Library, before: Moments, after: Moments) -> Floats:
    """Return root motion `(N, 3)`: x, z in the root's frame before, yaw; float64.

    Where time went on to an earlier row of a loop, the way leads through its end.
    """
    position, yaw = sample_root(library, before)
    position_after, yaw_after = sample_root(library, after)
    again = after.rows + after.weight < before.rows + before.weight
    again &= library.loops[library.clip_of[after.rows]]
    if again.any():
        position_after, yaw_after = _one_lap_on(library, after, again, position_after, yaw_after)
    way = position_after - position
    sine, cosine = np.sin(yaw), np.cos(yaw)
    return np.stack(
        [
            way[:, 0] * cosine - way[:, 2] * sine,
            way[:, 0] * sine + way[:, 2] * cosine,
            yaw_after - yaw,
        ],
        axis=-1,
    )


def _one_lap_on(
    library: Library, at: Moments, which: Flags, position: Vectors, yaw: Floats
) -> tuple[Vectors, Floats]:
    clip = library.clip_of[at.rows]
    first = library.clip_starts[clip]
    x, z, turn = np.moveaxis(library.laps[clip], -1, 0)
    origin = library.root_position[first].astype(np.float64)
    heading = library.root_yaw[first].astype(np.float64)
    rest = quaternion.rotate(quaternion.from_yaw(turn), position - origin)
    lap = quaternion.rotate(quaternion.from_yaw(heading), np.stack([x, 0.0 * x, z], axis=-1))
    return (
        np.where(which[:, None], origin + lap + rest, position),
        np.where(which, yaw + turn, yaw),
    )


def root_velocity(library: Library, at: Moments) -> Floats:
    """Return `(N, 3)`: x, z in m/s in the root's frame, yaw rate in rad/s; float32."""
    start = Moments(at.rows, np.zeros_like(at.weight))
    end = Moments(at.rows, np.ones_like(at.weight))
    return (root_delta(library, start, end) * library.frame_rate).astype(np.float32)
