"""Posture: frames in which a body does something that speed over the ground does not tell.

Thresholds lie beyond what walks, runs and turns of CMU's and LaFAN1's subjects do. Below 1 m/s
their hips are above 0.8 m and their hands below the chest, up to 2 m/s below the shoulders; seen
from the character, hands are slower than 1.5 m/s and three quarters of the pace; but in leaps, one
toe is below 0.2 m.
"""

from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.clip import Clip, differences
from stridewire.motion.root import savitzky_golay
from stridewire.motion.skeleton import REFERENCE

_LOW_HIPS, _LOW_STANDING = 0.7, 0.84
_SLOW, _FAST = 1.0, 2.0
_LEANING = np.cos(np.deg2rad(60.0))
_ALOFT = 0.2
_CHEST, _RAISED = -0.15, 0.05
_HAND_SPEED, _HAND_PACE = 1.5, 0.75
_AROUND_ALOFT_S, _AROUND_GESTURE_S = 0.5, 0.25
_SMOOTHING_S = 0.5


@dataclass(frozen=True)
class Posture:
    """By frame `(T,)`."""

    low: Flags
    """Crawls, sits, lies, or stands deep: hips low or trunk level."""
    aloft: Flags
    """Both feet are off the ground, as while climbing or leaping; half a second around it, too."""
    gesture: Flags
    """A hand is up or faster than the gait swings it; a quarter of a second around it, too."""


def posture(clip: Clip, speed: Floats) -> Posture:
    """Tell what a body does besides moving over the ground.

    Args:
        clip: On the reference skeleton, its ground at 0.
        speed: `(T,)` of the root; m/s.
    """
    pose = clip.pose.astype(np.float64)
    joints, _ = kinematics.forward(REFERENCE, pose.hips, pose.rotations)
    trunk = joints[:, REFERENCE.index("Neck")] - joints[:, 0]
    level = trunk[:, 1] < _LEANING * np.linalg.norm(trunk, axis=-1)
    least = np.where(speed < _SLOW, _LOW_STANDING, _LOW_HIPS) * REFERENCE.offsets[0, 1]
    toes = joints[:, REFERENCE.indices(("LeftToe", "RightToe")), 1]
    hands = joints[:, REFERENCE.indices(("LeftHand", "RightHand"))]
    shoulders = joints[:, REFERENCE.indices(("LeftArm", "RightArm"))]
    limit = np.select([speed < _SLOW, speed < _FAST], [_CHEST, _RAISED], np.inf)
    raised = (hands[..., 1] - shoulders[..., 1]).max(axis=-1) > limit
    fast = _pace(clip, hands) > _HAND_SPEED + _HAND_PACE * speed
    rate = clip.frame_rate
    return Posture(
        (joints[:, 0, 1] < least) | level,
        _widened(toes.min(axis=-1) > _ALOFT, round(_AROUND_ALOFT_S * rate)),
        _widened(raised | fast, round(_AROUND_GESTURE_S * rate)),
    )


def _pace(clip: Clip, hands: Floats) -> Floats:
    """Return `(T,)` smoothed speed of the faster hand, seen from the character; m/s."""
    speed = np.linalg.norm(differences(hands, 1.0 / clip.frame_rate), axis=-1).max(axis=-1)
    window = 2 * round(0.5 * _SMOOTHING_S * clip.frame_rate) + 1
    return savitzky_golay(speed[:, None], window, order=1)[:, 0]


def _widened(flags: Flags, frames: int) -> Flags:
    """Raise flags `frames` before and after raised ones, too."""
    near = np.convolve(flags, np.ones(2 * frames + 1))[frames : frames + len(flags)]
    return np.asarray(near > 0.5)
