"""Features: what the network reads of a pair, and the paper's way to write a posture.

A rotation is written as its forward (+Z) and up (+Y) axes, six numbers (Gaisbauer et al. 2019,
section 3.1; Zhou et al. 2019 take other axes).
"""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.blend.postures import Postures

JOINTS = len(REFERENCE)
POSTURE_SIZE = 3 + 6 * JOINTS
"""Numbers that the paper writes a posture as: 135."""
PAPER_INPUTS = 2 * POSTURE_SIZE + 1
_SIDE = POSTURE_SIZE + 3 * (JOINTS - 1)
INPUTS = 2 * _SIDE + 2
START_PLACES = slice(POSTURE_SIZE, _SIDE)
"""Columns of `inputs` with the places of the start's joints below the hips."""
END_PLACES = slice(_SIDE + POSTURE_SIZE, 2 * _SIDE)
LOG_TIME = 2 * _SIDE
"""Column with the logarithm of the duration; 0, as of a second, where it is unknown."""
LONGEST_S, SHORTEST_S = 1.0, 0.1
"""Durations of pairs that networks are trained on; seconds."""


def to_six(rotations: Quaternions) -> Floats:
    """Return forward and up axes `(..., 6)` of rotations `(..., 4)`."""
    w, x, y, z = np.moveaxis(rotations, -1, 0)
    return np.stack(
        [
            2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y),
            2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
        ],
        axis=-1,
    )  # fmt: skip


def from_six(axes: Floats) -> Quaternions:
    """Return the rotations `(..., 4)` nearest to forward and up axes `(..., 6)`; forward rules."""
    forward = axes[..., :3] / np.maximum(_length(axes[..., :3]), 1e-8)
    across = quaternion.cross(axes[..., 3:], forward)
    across = across / np.maximum(_length(across), 1e-8)
    up = quaternion.cross(forward, across)
    return _from_axes(across, up, forward)


def write_postures(postures: Postures) -> Floats:
    """Return postures as the paper writes them, `(..., 135)`: hips, then six numbers a joint."""
    six = to_six(postures.rotations)
    return np.concatenate([postures.hips, six.reshape(*six.shape[:-2], -1)], axis=-1)


def read_postures(written: Floats) -> Postures:
    """Return the postures that numbers `(..., 135)` stand for: `write_postures` undone."""
    six = written[..., 3:].reshape(*written.shape[:-1], JOINTS, 6)
    return Postures(written[..., :3].copy(), from_six(six))


def paper_inputs(start: Postures, end: Postures, weights: Floats) -> Floats:
    """Return the paper's inputs `(N, 271)`: start, end, weight.

    Args:
        start: `(N,)` in the pairs' frames.
        end: `(N,)`.
        weights: `(N,)`.
    """
    return np.concatenate(
        [write_postures(start), write_postures(end), weights[:, None]], axis=-1
    ).astype(np.float32)


def inputs(start: Postures, end: Postures, duration: Floats) -> Floats:
    """Return inputs `(N, 398)`: both postures, also by the places of their joints, and the time.

    Args:
        start: `(N,)` in the pairs' frames.
        end: `(N,)`.
        duration: `(N,)` seconds between them; 0 where unknown.
    """
    known = duration > 0.0
    time = np.log(np.clip(np.where(known, duration, LONGEST_S), SHORTEST_S, LONGEST_S))
    # one pass over both: of few pairs the passes are what takes the time
    both = Postures(np.stack([start.hips, end.hips]), np.stack([start.rotations, end.rotations]))
    joints = both.joints()[..., 1:, :]
    sides = np.concatenate([write_postures(both), joints.reshape(*joints.shape[:-2], -1)], axis=-1)
    told = np.stack([time, known], axis=-1)
    return np.concatenate([*sides, told], axis=-1).astype(np.float32)


def _length(v: Floats) -> Floats:
    return np.asarray(np.sqrt(np.sum(v * v, axis=-1, keepdims=True)))


def _from_axes(x: Floats, y: Floats, z: Floats) -> Quaternions:
    """Return quaternions of orthonormal axes by the largest of four squares (Shepperd 1978)."""
    (a, b, c), (d, e, f), (g, h, i) = (np.moveaxis(axis, -1, 0) for axis in (x, y, z))
    rows = np.stack(
        [
            np.stack([1.0 + a + e + i, f - h, g - c, b - d], axis=-1),
            np.stack([f - h, 1.0 + a - e - i, d + b, g + c], axis=-1),
            np.stack([g - c, d + b, 1.0 - a + e - i, h + f], axis=-1),
            np.stack([b - d, g + c, h + f, 1.0 - a - e + i], axis=-1),
        ],
        axis=-2,
    )
    best = np.argmax(np.stack([rows[..., k, k] for k in range(4)], axis=-1), axis=-1)
    return quaternion.normalize(np.take_along_axis(rows, best[..., None, None], axis=-2)[..., 0, :])
