"""Poses as the paper writes them, and back (Kim et al. 2023, section 4).

A frame is what the root did since the frame before, seen from there (x, z, yaw); the joints of the
lower body under the root; local rotations; what the joints did since the frame before, seen from
the root of then, in m/s; contacts. Read otherwise than printed: rotations are two axes each and not
quaternions, the skeleton has nine joints below and not eleven, and toes alone touch the ground, as
it has no heels.
"""

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.blend.features import from_six, to_six
from stridewire_engine.networks.rmr.features import steps
from stridewire_engine.networks.rmr.pairs import Pairs
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.networks.rmr.takes import LOWER, Takes

POINTS_COUNT, JOINTS = len(LOWER), len(REFERENCE)
ROOT = slice(0, 3)
POINTS = slice(3, 3 + 3 * POINTS_COUNT)
ROTATIONS = slice(POINTS.stop, POINTS.stop + 6 * JOINTS)
VELOCITIES = slice(ROTATIONS.stop, ROTATIONS.stop + 3 * POINTS_COUNT)
CONTACTS = slice(VELOCITIES.stop, VELOCITIES.stop + 2)
NUMBERS = CONTACTS.stop
"""Numbers a frame."""


def write(
    root: Vectors, yaw: Floats, hips: Vectors, rotations: Quaternions, contacts: Flags
) -> Floats:
    """Return poses as numbers `(N, T, 191)`, float32.

    Args:
        root: `(N, T, 3)` metres, in any space.
        yaw: `(N, T)` radians, without jumps.
        hips: `(N, T, 3)` relative to the root.
        rotations: `(N, T, J, 4)` local.
        contacts: `(N, T, 2)` whether toes are planted.
    """
    n, frames = yaw.shape
    points = kinematics.forward(LOWER, hips, rotations[:, :, :POINTS_COUNT])[0]
    world = turn_to_world(points.reshape(n * frames, -1, 3), yaw.reshape(-1)).reshape(points.shape)
    world = world + root[:, :, None]
    six = to_six(rotations.astype(np.float32))
    parts = [
        root_motion(root, yaw),
        points.reshape(n, frames, -1),
        six.reshape(n, frames, -1),
        FRAME_RATE * _seen_before(steps(world), yaw).reshape(n, frames, -1),
        contacts,
    ]
    return np.concatenate(parts, axis=-1).astype(np.float32)


def read(numbers: Floats) -> tuple[Vectors, Quaternions]:
    """Return hips `(N, T, 3)` under the root and local rotations `(N, T, J, 4)`, float32."""
    six = numbers[..., ROTATIONS].reshape(*numbers.shape[:-1], JOINTS, 6)
    hips = numbers[..., POINTS][..., :3]
    return hips.astype(np.float32), from_six(six).astype(np.float32)


def root_motion(root: Vectors, yaw: Floats) -> Floats:
    """Return `(N, T, 3)`: x, z and yaw since the frame before; the first repeats the second."""
    way = _seen_before(steps(root)[:, :, None], yaw)[:, :, 0]
    return np.stack([way[..., 0], way[..., 2], steps(yaw)], axis=-1)


def root_path(motion: Floats) -> tuple[Vectors, Floats]:
    """Return the roots `(N, T, 3)` and yaws `(N, T)` that root motion leads to, from the origin."""
    yaw = np.cumsum(motion[..., 2], axis=1)
    before = yaw - motion[..., 2]
    sine, cosine = np.sin(before), np.cos(before)
    x = motion[..., 0] * cosine + motion[..., 1] * sine
    z = motion[..., 1] * cosine - motion[..., 0] * sine
    path = np.stack([np.cumsum(x, axis=1), np.zeros_like(x), np.cumsum(z, axis=1)], axis=-1)
    return path, yaw


def clips_path(takes: Takes, pairs: Pairs) -> tuple[Vectors, Floats]:
    """Return roots `(N, T, 3)` and yaws `(N, T)` of clips that each go on where the last one ended.

    The step over a seam is half the last of the clip before and half the first of the next.
    """
    rows = np.stack([pairs.rows - 1, pairs.rows], axis=-1).reshape(-1, 2)
    motion = root_motion(*takes.root_path(rows))[:, 1].reshape(*pairs.rows.shape, 3)
    over = 0.5 * (motion[:, :-1] + motion[:, 1:])
    motion[:, 1:] = np.where(pairs.starts[:, 1:, None], over, motion[:, 1:])
    motion[:, 0] = 0.0
    return root_path(motion)


def _seen_before(ways: Vectors, yaw: Floats) -> Vectors:
    """Turn ways `(N, T, K, 3)` in the world into the frames of the roots a frame earlier."""
    n, frames = yaw.shape
    earlier = yaw - steps(yaw)
    return turn_to_root(ways.reshape(n * frames, -1, 3), earlier.reshape(-1)).reshape(ways.shape)
