"""Corrections: how much of what a stitcher made is shown, by frame and by joint."""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire_engine.stitching.chains import CLEAN_UP_FRAMES


def mix(
    planned: tuple[Vectors, Quaternions],
    made: tuple[Vectors, Quaternions],
    frame_shares: Floats,
    joint_shares: Floats,
) -> tuple[Vectors, Quaternions]:
    """Return poses between planned and made ones: at share 0 the very planned, at 1 the made.

    Args:
        planned: Hips `(L, 3)` and rotations `(L, J, 4)`.
        made: Alike.
        frame_shares: `(L,)`.
        joint_shares: `(J,)`; the first one also holds for the hips' place.
    """
    share = (frame_shares[:, None] * joint_shares).astype(np.float32)
    between = quaternion.slerp(planned[1], made[1], share)
    same = np.all(planned[1] == made[1], axis=-1)
    rotations = _chosen(np.where(same, 0.0, share)[..., None], planned[1], made[1], between)
    share = share[:, :1]
    hips = _chosen(share, planned[0], made[0], planned[0] + share * (made[0] - planned[0]))
    return hips, rotations


def within(frames: int, first: int, last: int) -> Floats:
    """Return shares `(frames,)`: 1 from frame `first` to `last`, 0 outside, smooth inside."""
    index = np.arange(frames)
    into = np.clip((index - first + 1) / (CLEAN_UP_FRAMES + 1), 0.0, 1.0) if first > 0 else 1.0
    until = last < frames - 1
    out = np.clip((last - index + 1) / (CLEAN_UP_FRAMES + 1), 0.0, 1.0) if until else 1.0
    x = np.minimum(into, out) * np.ones(frames)
    return np.asarray(x * x * (3.0 - 2.0 * x))


def _chosen(share: Floats, planned: Floats, made: Floats, between: Floats) -> Floats:
    return np.where(share <= 0.0, planned, np.where(share >= 1.0, made, between))
