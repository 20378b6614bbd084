"""Figures of gait: distances between motions, slide, cadence, knees and jerk."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.clip import Clip
from stridewire.motion.mirror import mirror_clip
from stridewire.motion.skeleton import REFERENCE

VELOCITY_S = 0.12
"""What a velocity counts for beside a position, seconds."""

_EDGE = 2
_WINDOW = tuple(range(0, 31, 6))


@dataclass(frozen=True)
class Features:
    """What frames are compared by."""

    rows: Floats
    """`(T, 135)` joints from the root, 0.12 s times their velocities and the root's, metres."""
    speed: Floats
    """`(T,)` of the root, m/s."""


def local_positions(clip: Clip) -> tuple[Vectors, Vectors]:
    """Return joints in the world and relative to the root, `(T, 22, 3)` each."""
    pose = clip.pose.astype(np.float64)
    world, _ = kinematics.forward_world(REFERENCE, pose)
    back = quaternion.conjugate(pose.root_rotation)[:, None]
    return world, quaternion.rotate(back, world - pose.root_position[:, None])


def features(clip: Clip) -> Features:
    """Return what a clip's frames are compared by, without its ends."""
    world, local = local_positions(clip)
    back = quaternion.conjugate(clip.pose.root_rotation.astype(np.float64))
    velocity = quaternion.rotate(back[:, None], _rate(world, clip))
    root = quaternion.rotate(back, _rate(clip.pose.root_position.astype(np.float64), clip))
    parts = [local.reshape(len(clip), -1), VELOCITY_S * velocity.reshape(len(clip), -1)]
    rows = np.concatenate([*parts, VELOCITY_S * root], axis=1)
    inner = slice(_EDGE, -_EDGE)
    return Features(rows[inner], np.linalg.norm(root, axis=-1)[inner])


def library_features(clips: Sequence[Clip]) -> Floats:
    """Return the rows of clips and of their mirrored copies."""
    return np.concatenate([features(c).rows for clip in clips for c in (clip, mirror_clip(clip))])


def distances(rows: Floats, library: Floats) -> Floats:
    """Return the distance of each row to its nearest in a library, per joint, metres."""
    nearest, _ = cKDTree(library).query(rows)
    return np.asarray(nearest / np.sqrt(len(REFERENCE)))


def nearest_windows(clips: Sequence[Clip], library: Sequence[Clip]) -> Floats:
    """Return for windows of half a second the distance per joint to the nearest in a library."""
    ours = np.concatenate([_windows(clip)[::15] for clip in clips])
    theirs = np.concatenate([_windows(c) for clip in library for c in (clip, mirror_clip(clip))])
    nearest, _ = cKDTree(theirs).query(ours)
    return np.asarray(nearest / np.sqrt(len(REFERENCE) * len(_WINDOW)))


def stance_speeds(clip: Clip) -> Floats:
    """Return the planar speeds of toes that are planted, m/s."""
    world, _ = local_positions(clip)
    toes = world[:, REFERENCE.indices(("LeftToe", "RightToe"))][..., [0, 2]]
    planted = clip.contacts[:, [1, 3]]
    speed = np.linalg.norm(np.diff(toes, axis=0), axis=-1) * clip.frame_rate
    return np.asarray(speed[planted[1:] & planted[:-1]])


def turning(clip: Clip) -> Floats:
    """Return the root's turning `(T,)`, rad/s."""
    yaw = np.unwrap(quaternion.to_yaw(clip.pose.root_rotation.astype(np.float64)))
    return np.asarray(np.gradient(yaw) * clip.frame_rate)


def ankle_separation(clip: Clip) -> Floats:
    """Return how far the left ankle is left of the right one `(T,)`, metres."""
    _, local = local_positions(clip)
    left, right = REFERENCE.indices(("LeftFoot", "RightFoot"))
    return np.asarray(local[:, left, 0] - local[:, right, 0])


def knee_angles(clip: Clip) -> Floats:
    """Return the bend of both knees `(T, 2)`, degrees; 0 straight."""
    world, _ = local_positions(clip)
    bends = []
    for side in ("Left", "Right"):
        hip, knee, ankle = REFERENCE.indices((f"{side}UpLeg", f"{side}Leg", f"{side}Foot"))
        upper, lower = world[:, knee] - world[:, hip], world[:, ankle] - world[:, knee]
        cosine = (upper * lower).sum(axis=-1)
        cosine /= np.linalg.norm(upper, axis=-1) * np.linalg.norm(lower, axis=-1)
        bends.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.stack(bends, axis=-1)


def joint_angles(clip: Clip, joint: str) -> Floats:
    """Return how far a joint of both sides turns from the T-pose `(2 T,)`, degrees."""
    columns = REFERENCE.indices((f"Left{joint}", f"Right{joint}"))
    w = np.abs(clip.pose.rotations[:, columns, 0].astype(np.float64))
    return np.degrees(2.0 * np.arccos(np.minimum(w, 1.0))).ravel()


def smooth_jerk(clip: Clip) -> Floats:
    """Return the mean jerk of the joints `(T,)` after a 0.05 s low-pass, m/s^3."""
    world, _ = local_positions(clip)
    smooth = gaussian_filter1d(world, 0.05 * clip.frame_rate, axis=0)
    jerk = np.linalg.norm(np.diff(smooth, 3, axis=0), axis=-1).mean(axis=-1) * clip.frame_rate**3
    return np.asarray(np.pad(jerk, (1, 2), mode="edge"))


def _windows(clip: Clip) -> Floats:
    _, local = local_positions(clip)
    starts = np.arange(max(len(clip) - _WINDOW[-1], 0))
    return np.concatenate([local[starts + k].reshape(len(starts), -1) for k in _WINDOW], axis=1)


def _rate(values: Floats, clip: Clip) -> Floats:
    return np.asarray(np.gradient(values, axis=0) * clip.frame_rate)
