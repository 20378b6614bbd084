"""The root: one definition for import, matching and networks.

The root's position is the ground projection of Spine2, Savitzky-Golay smoothed (half a second,
third order); its heading is the hips' forward axis on the ground, smoothed alike over a second and
normalised (Holden, *Motion-Matching*, `generate_database`).
"""

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton

_POSITION_WINDOW_S = 0.5
_HEADING_WINDOW_S = 1.0


def extract_root(
    skeleton: Skeleton, hips: Vectors, rotations: Quaternions, frame_rate: float
) -> Pose:
    """Split a motion in the world into a root on the ground and poses relative to it.

    Args:
        skeleton: Must have `Spine2`.
        hips: `(T, 3)` hips in the world, metres.
        rotations: `(T, J, 4)` local rotations, the first joint's in the world.
        frame_rate: Frames per second.

    Raises:
        SkeletonError: If the skeleton has no `Spine2`.
    """
    positions, _ = kinematics.forward(skeleton, hips, rotations)
    ground = positions[:, skeleton.index("Spine2")] * np.array([1.0, 0.0, 1.0], hips.dtype)
    root = savitzky_golay(ground, _frames(_POSITION_WINDOW_S, frame_rate))
    forward = quaternion.rotate(
        rotations[:, 0], np.broadcast_to(np.array([0.0, 0.0, 1.0], hips.dtype), hips.shape)
    )
    yaw = np.arctan2(forward[:, 0], forward[:, 2])
    heading = savitzky_golay(
        np.stack([np.sin(yaw), np.cos(yaw)], axis=-1), _frames(_HEADING_WINDOW_S, frame_rate)
    )
    turn = quaternion.from_yaw(np.arctan2(heading[:, 0], heading[:, 1]))
    back = quaternion.conjugate(turn)
    local = rotations.copy()
    local[:, 0] = quaternion.multiply(back, rotations[:, 0])
    return Pose(
        root.astype(hips.dtype),
        turn.astype(hips.dtype),
        quaternion.rotate(back, hips - root).astype(hips.dtype),
        quaternion.unroll(local),
    )


def savitzky_golay(values: Floats, window: int, order: int = 3) -> Floats:
    """Smooth along the first axis by local polynomials, the ends by the outermost window's.

    Args:
        values: `(T, C)`; a `window` longer than T is shortened to fit.
        window: Odd number of frames.
        order: Order of the polynomials.
    """
    window = min(window, len(values) - (len(values) + 1) % 2)
    if window <= order:
        return values.copy()
    half = window // 2
    x = np.arange(-half, half + 1, dtype=np.float64)
    powers = np.vander(x, order + 1)
    smooth = powers @ np.linalg.pinv(powers)
    out = np.empty(values.shape, np.float64)
    windows = np.lib.stride_tricks.sliding_window_view(values, window, axis=0)
    out[half : len(values) - half] = windows @ smooth[half]
    out[:half] = smooth[:half] @ values[:window]
    out[len(values) - half :] = smooth[half + 1 :] @ values[-window:]
    return out.astype(values.dtype)


def _frames(seconds: float, frame_rate: float) -> int:
    return 2 * round(0.5 * seconds * frame_rate) + 1
