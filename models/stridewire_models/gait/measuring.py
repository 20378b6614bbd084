"""Measuring: where in their steps captured people are, and how their bodies lie there."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.clip import Clip
from stridewire.motion.contacts import rest_heights
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE
from stridewire_engine.building.gait.model import ENDS

_SMOOTHING_S = 0.3
_PROMINENCE = 0.12
_STEP_S = (0.18, 0.95)
_AIR_HEIGHT = 0.03
_AIR_SHARE = 0.12
_RUN_SPEED, _SURE_RUN_SPEED = 1.4, 2.3
_SLOWEST = 0.35
_AHEAD = 0.7
_STILL_SPEED, _STILL_TURN, _STILL_S = 0.06, 0.12, 0.2


@dataclass(frozen=True)
class Path:
    """The smooth path that a body travels along: what a script will say when motion is drawn."""

    position: Vectors
    """`(T, 3)` on the ground, metres."""
    yaw: Floats
    """`(T,)` radians, not wrapped."""
    speed: Floats
    """`(T,)` m/s along the path."""
    turn: Floats
    """`(T,)` rad/s to the left."""
    acceleration: Floats
    """`(T,)` m/s^2."""
    forward: Flags
    """`(T,)` whether it leads ahead."""


@dataclass(frozen=True)
class Steps:
    """The frames of one clip that lie in whole steps."""

    subject: str
    take: str
    frames: Indices
    """`(N,)` in the clip."""
    phase: Floats
    """`(N,)` 0 where the left ankle is farthest ahead, 0.5 where the right one is."""
    speed: Floats
    """`(N,)` m/s."""
    turn: Floats
    """`(N,)` rad/s."""
    acceleration: Floats
    """`(N,)` m/s^2."""
    run: Flags
    """`(N,)` whether the step is one of running."""
    step: Indices
    """`(N,)` number of the step in the clip."""
    rotations: Quaternions
    """`(N, 22, 4)` local; the hips' relative to the path's heading."""
    positions: Vectors
    """`(N, 5, 3)` hips, left ankle, left toe, right ankle, right toe, relative to the path."""


def measure_path(positions: Vectors, frame_rate: float) -> Path:
    """Smooth the way of the hips and the heading across hips and shoulders.

    Args:
        positions: `(T, 22, 3)` joints in the world, metres.
        frame_rate: Frames per second.
    """
    joints = REFERENCE.indices(("LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm"))
    left = positions[:, joints[0]] - positions[:, joints[1]]
    left = left + positions[:, joints[2]] - positions[:, joints[3]]
    yaw = _smooth(np.unwrap(np.arctan2(-left[:, 2], left[:, 0])), frame_rate)
    ground = _smooth(positions[:, 0] * np.array([1.0, 0.0, 1.0]), frame_rate)
    velocity = np.gradient(ground, axis=0) * frame_rate
    speed = np.linalg.norm(velocity, axis=-1)
    ahead = velocity[:, 0] * np.sin(yaw) + velocity[:, 2] * np.cos(yaw)
    return Path(
        ground,
        yaw,
        speed,
        np.gradient(yaw) * frame_rate,
        np.gradient(speed) * frame_rate,
        ahead > _AHEAD * speed,
    )


@dataclass(frozen=True)
class Standing:
    """The frames of one clip that stand still."""

    subject: str
    rotations: Quaternions
    """`(N, 22, 4)` as in `Steps`."""
    positions: Vectors
    """`(N, 5, 3)` as in `Steps`."""


def measure_steps(clip: Clip, subject: str) -> Steps | None:
    """Return the steps of a clip, or None where it has none.

    Args:
        clip: On the reference skeleton.
        subject: Who moves.
    """
    path, local, rotations = _along_path(clip)
    phase, step = _phase(local, clip.frame_rate)
    frames = np.flatnonzero((step >= 0) & (path.speed > _SLOWEST) & path.forward)
    if len(frames) == 0:
        return None
    return Steps(
        subject,
        clip.name,
        frames,
        phase[frames],
        path.speed[frames],
        path.turn[frames],
        path.acceleration[frames],
        _running(step, local, path.speed)[frames],
        step[frames],
        rotations[frames],
        local[frames][:, REFERENCE.indices(ENDS)],
    )


def measure_standing(clip: Clip, subject: str) -> Standing | None:
    """Return the frames of a clip that stand on both feet, or None where it never does."""
    path, local, rotations = _along_path(clip)
    still = (path.speed < _STILL_SPEED) & (np.abs(path.turn) < _STILL_TURN)
    frames = np.flatnonzero(still & clip.contacts.all(axis=1))
    if len(frames) < _STILL_S * clip.frame_rate:
        return None
    return Standing(subject, rotations[frames], local[frames][:, REFERENCE.indices(ENDS)])


def _along_path(clip: Clip) -> tuple[Path, Vectors, Quaternions]:
    """Return a clip's path and, relative to it, joints `(T, 22, 3)` and local rotations."""
    pose = clip.pose.astype(np.float64)
    world, _ = kinematics.forward_world(REFERENCE, pose)
    path = measure_path(world, clip.frame_rate)
    back = quaternion.from_yaw(-path.yaw)
    local = quaternion.rotate(back[:, None], world - path.position[:, None])
    rotations = pose.rotations.copy()
    rotations[:, 0] = quaternion.multiply(back, pose.world_hips[1])
    return path, local, rotations


def _smooth(values: Floats, frame_rate: float) -> Floats:
    """Smooth along the first axis, point-reflected beyond the ends, which so keep their slope."""
    sigma = _SMOOTHING_S * frame_rate
    pad = min(round(3.0 * sigma), len(values) - 1)
    around = [(pad, pad), *[(0, 0)] * (values.ndim - 1)]
    longer = np.pad(values, around, mode="reflect", reflect_type="odd")
    return np.asarray(gaussian_filter1d(longer, sigma, axis=0)[pad : pad + len(values)])


def _phase(local: Vectors, frame_rate: float) -> tuple[Floats, Indices]:
    """Return phases and numbers of the steps `(T,)`, -1 outside of whole alternating steps."""
    phase = np.zeros(len(local))
    number = np.full(len(local), -1)
    for index, (start, end, first) in enumerate(_steps(local, frame_rate)):
        span = np.arange(start, end)
        phase[span] = (first + 0.5 * (span - start) / (end - start)) % 1.0
        number[span] = index
    return phase, number


def _steps(local: Vectors, frame_rate: float) -> Iterator[tuple[int, int, float]]:
    """Yield first frame, end and first phase of each step: from one foot's peak to the other's."""
    peaks = []
    for name, first in (("LeftFoot", 0.0), ("RightFoot", 0.5)):
        ahead = local[:, REFERENCE.index(name), 2]
        found, _ = find_peaks(ahead, prominence=_PROMINENCE, distance=round(0.25 * frame_rate))
        peaks += [(int(frame), first) for frame in found]
    peaks.sort()
    for (start, first), (end, other) in pairwise(peaks):
        seconds = (end - start) / frame_rate
        if first != other and _STEP_S[0] < seconds < _STEP_S[1]:
            yield start, end, first


def _running(step: Indices, local: Vectors, speed: Floats) -> Flags:
    """Call a step running that is faster than 2.3 m/s, or than 1.4 with both feet off the ground.

    Contacts do not serve here: the toe of a quick walk is hardly ever still.
    """
    feet = REFERENCE.indices(CONTACT_JOINTS)
    lowest = (local[:, feet, 1] - rest_heights(REFERENCE, feet)).min(axis=1)
    run = np.zeros(len(step), bool)
    for number in range(step.max() + 1):
        inside = step == number
        flies = np.mean(lowest[inside] > _AIR_HEIGHT) > _AIR_SHARE
        run[inside] = speed[inside].mean() > (_RUN_SPEED if flies else _SURE_RUN_SPEED)
    return run
