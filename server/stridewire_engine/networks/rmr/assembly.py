"""Assembly: from rows of takes to motion, with springs over the seams, and to plans."""

from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_world
from stridewire_engine.networks.rmr.pairs import Pairs
from stridewire_engine.networks.rmr.plans import FRAME_RATE, Plans
from stridewire_engine.networks.rmr.takes import (
    ANKLES,
    HIP_JOINTS,
    LOWER,
    TOES,
    Takes,
)

_HALFLIFE = 0.1
_RATE = 2.0 * float(np.log(2.0)) / _HALFLIFE


@dataclass(frozen=True)
class Legs:
    """Legs of N windows of T frames in the world of their plans."""

    hips: Vectors
    """`(N, T, 3)`."""
    hip_joints: Vectors
    """`(N, T, 2, 3)`."""
    ankles: Vectors
    """`(N, T, 2, 3)`."""
    toes: Vectors
    """`(N, T, 2, 3)`."""
    feet: Quaternions
    """`(N, T, 2, 4)` rotations."""

    @staticmethod
    def of(root: Vectors, yaw: Floats, hips: Vectors, rotations: Quaternions) -> "Legs":
        """Place the lower bodies of poses: hips `(N, T, 3)`, local rotations `(N, T, 9, 4)`."""
        joints, turns = kinematics.forward(LOWER, hips, rotations)
        joints = _place(joints, root, yaw)
        facing = quaternion.from_yaw(yaw)[:, :, None]
        return Legs(
            joints[:, :, 0],
            joints[:, :, HIP_JOINTS],
            joints[:, :, ANKLES],
            joints[:, :, TOES],
            quaternion.multiply(facing, turns[:, :, ANKLES]),
        )


@dataclass(frozen=True)
class Assembled:
    """N pairs as legs in the world; the first frame's root of each lies at the origin."""

    plans: Plans
    sprung: Legs
    """With springs over the seams."""
    clip: Legs
    """As the clips are."""
    before: Vectors
    """`(N, T, 2, 3)` where each frame's clip had its toes a frame earlier, across no seam."""
    truth: Legs
    """As the take is."""


def assemble(takes: Takes, pairs: Pairs, path: tuple[Vectors, Floats] | None = None) -> Assembled:
    """Put clips under the take's root path, springs over the seams.

    Args:
        takes: That the pairs' rows are of.
        pairs: N pairs of T frames.
        path: Another path than the take's: roots `(N, T, 3)` and yaws `(N, T)`.
    """
    own, own_yaw = takes.root_path(pairs.truth)
    root, yaw = (own, own_yaw) if path is None else path
    hips = takes.hips[pairs.rows].astype(np.float64)
    turns = takes.rotations[pairs.rows][:, :, : len(LOWER)].astype(np.float64)
    shown_hips, shown_turns = spring(takes, pairs.rows, pairs.starts, hips, turns)
    clip = Legs.of(root, yaw, hips, turns)
    sprung = Legs.of(root, yaw, shown_hips, shown_turns)
    before = placed_before(takes, clip.toes, pairs.rows, pairs.starts, root, yaw)
    plans = Plans(
        root,
        yaw,
        sprung.hips,
        sprung.toes,
        sprung.ankles,
        clip.toes,
        takes.contacts[pairs.rows],
        pairs.seam,
        np.ones(len(pairs), bool),
    )
    truth = Legs.of(
        own,
        own_yaw,
        takes.hips[pairs.truth].astype(np.float64),
        takes.rotations[pairs.truth][:, :, : len(LOWER)].astype(np.float64),
    )
    return Assembled(plans, sprung, clip, before, truth)


def placed_before(
    takes: Takes, toes: Vectors, rows: Indices, starts: Flags, root: Vectors, yaw: Floats
) -> Vectors:
    """Return where each frame's clip had its toes a frame earlier `(N, T, 2, 3)`.

    Args:
        takes: That the rows are of.
        toes: `(N, T, 2, 3)` of the rows in the world.
        rows: `(N, T)`.
        starts: `(N, T)` whether a clip begins.
        root: `(N, T, 3)`.
        yaw: `(N, T)`.
    """
    before = np.concatenate([toes[:, :1], toes[:, :-1]], axis=1)
    n, t = np.nonzero(starts)
    local = takes.joints[rows[n, t] - 1][:, TOES].astype(np.float64)
    before[n, t] = turn_to_world(local, yaw[n, t - 1]) + root[n, t - 1, None]
    return before


def spring(
    takes: Takes, rows: Indices, starts: Flags, hips: Vectors, turns: Quaternions
) -> tuple[Vectors, Quaternions]:
    """Let offsets at seams decay as critically damped springs.

    What is shown in the two frames before a seam, against what the coming clip does in its own two
    frames before, gives offset and rate.

    Args:
        takes: That rows are of.
        rows: `(N, T)`.
        starts: `(N, T)` whether a clip begins.
        hips: `(N, T, 3)` of the rows.
        turns: `(N, T, L, 4)` of the rows, the first L joints.
    """
    joints = turns.shape[2]
    shown_hips, shown_turns = hips.copy(), turns.copy()
    frames = np.arange(rows.shape[1])
    for at in np.unique(np.nonzero(starts)[1]):
        which = np.flatnonzero(starts[:, at])
        coming = rows[which, at][:, None] - np.array([2, 1])
        own = takes.rotations[coming][:, :, :joints].astype(np.float64)
        away = quaternion.multiply(shown_turns[which, at - 2 : at], quaternion.conjugate(own))
        turn = quaternion.to_scaled_axis(away)
        move = shown_hips[which, at - 2 : at] - takes.hips[coming]
        time = (frames[at:] - at + 1) / FRAME_RATE
        shown_hips[which, at:] = hips[which, at:] + _decayed(move, time)
        shown_turns[which, at:] = quaternion.multiply(
            quaternion.from_scaled_axis(_decayed(turn, time)), turns[which, at:]
        )
    return shown_hips, shown_turns


def _decayed(two: Floats, time: Floats) -> Floats:
    """Return offsets `(N, T, ...)` at times `(T,)` after those of two frames `(N, 2, ...)`."""
    offset = two[:, 1:]
    rate = (two[:, 1:] - two[:, :1]) * FRAME_RATE
    t = time.reshape(-1, *(1,) * (two.ndim - 2))
    return np.asarray(np.exp(-_RATE * t) * (offset + (rate + offset * _RATE) * t))


def _place(points: Vectors, root: Vectors, yaw: Floats) -> Vectors:
    n, t = yaw.shape
    flat = turn_to_world(points.reshape(n * t, -1, 3), yaw.reshape(-1))
    return flat.reshape(points.shape) + root[:, :, None]
