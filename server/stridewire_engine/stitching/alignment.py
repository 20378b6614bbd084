"""Alignment: each clip begins where the one before ends, and as fast.

After Kim et al. 2023, figure 3: the root path of the next clip is moved and turned as a whole so
that it goes on from the end of the path before. What the clips' root velocities differ by fades
out over a third of a second; from then on a clip's path is its own.
"""

from collections.abc import Sequence

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.clip import Clip
from stridewire_engine.stitching.plan import Plan

_FADE_S = 0.35
_TOES = [1, 3]


def lay(clips: Sequence[Clip]) -> Plan:
    """Lay clips of one skeleton and frame rate end to end, the first where it is.

    Args:
        clips: Each of at least 2 frames.
    """
    first = clips[0]
    steps = _steps(clips)
    yaw = float(_yaw(first)[0]) + np.concatenate([[0.0], np.cumsum(steps[:, 2])])
    sine, cosine = np.sin(yaw[:-1]), np.cos(yaw[:-1])
    x = steps[:, 0] * cosine + steps[:, 1] * sine
    z = steps[:, 1] * cosine - steps[:, 0] * sine
    position = np.concatenate([c.pose.root_position for c in clips]).astype(np.float64)
    position[1:, 0] = position[0, 0] + np.cumsum(x)
    position[1:, 2] = position[0, 2] + np.cumsum(z)
    return Plan(
        first.skeleton,
        first.frame_rate,
        position,
        yaw,
        np.concatenate([c.pose.hips for c in clips]).astype(np.float32, copy=False),
        np.concatenate([c.pose.rotations for c in clips]).astype(np.float32, copy=False),
        np.concatenate([c.contacts[:, _TOES] for c in clips]),
        np.cumsum([len(c) for c in clips])[:-1],
    )


def root_steps(position: Vectors, yaw: Floats) -> Floats:
    """Return root motion `(T - 1, 3)` from frame to frame: x, z in the root's frame, yaw.

    Args:
        position: `(T, 3)`.
        yaw: `(T,)`.
    """
    way = np.diff(position, axis=0)
    sine, cosine = np.sin(yaw[:-1]), np.cos(yaw[:-1])
    return np.stack(
        [
            way[:, 0] * cosine - way[:, 2] * sine,
            way[:, 0] * sine + way[:, 2] * cosine,
            np.diff(yaw),
        ],
        axis=-1,
    )


def _steps(clips: Sequence[Clip]) -> Floats:
    """Return the root motion `(T - 1, 3)` of all clips, over their seams."""
    fade_frames = round(_FADE_S * clips[0].frame_rate)
    parts: list[Floats] = []
    for clip in clips:
        own = root_steps(clip.pose.root_position.astype(np.float64), _yaw(clip))
        if parts:
            over = np.concatenate([own[:1], own])
            fading = over[: fade_frames + 1]
            fading += (parts[-1][-1] - own[0]) * _fade(len(over), fade_frames)[:, None]
            own = over
        parts.append(own)
    return np.concatenate(parts)


def _fade(frames: int, whole: int) -> Floats:
    """Return shares that fall smoothly from 1 to 0 within `whole` frames or sooner."""
    count = min(frames, whole + 1)
    x = np.arange(count) / max(count - 1, 1)
    return np.asarray(1.0 - x * x * (3.0 - 2.0 * x))


def _yaw(clip: Clip) -> Floats:
    turn = clip.pose.root_rotation.astype(np.float64)
    return np.asarray(np.unwrap(quaternion.to_yaw(turn)))
