"""Blends of many pairs at many weights, in one pass over arrays."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stridewire._messages import BlendMethod
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.clip import Pose
from stridewire_engine.blending.feet import keep_feet
from stridewire_engine.networks.blend import BlendNetwork, PairFrame, Postures
from stridewire_engine.networks.blend.correction import correct, linear
from stridewire_engine.networks.blend.features import LONGEST_S


@dataclass(frozen=True)
class Pair:
    """Two postures and what is asked of the way between them."""

    start: Pose
    """Without leading shape, in the world."""
    end: Pose
    weights: Floats
    """`(W,)` from 0 to 1."""
    shares: Floats
    """`(J,)` of the weight that each joint takes."""
    method: BlendMethod = BlendMethod.AUTO
    ground: float = 0.0
    """Height of the ground; metres."""
    duration: float = 0.0
    """Seconds between the postures; 0 where unknown."""


@dataclass(frozen=True)
class Blended:
    """The postures of one pair."""

    pose: Pose
    """`(W, …)`."""
    method: BlendMethod
    """`NEURAL` or `SLERP`: which one made them."""
    reason: str = ""
    """Why, where it is not the one asked for."""


def blend(pairs: Sequence[Pair], network: BlendNetwork | None, reason: str = "") -> list[Blended]:
    """Blend pairs.

    Args:
        pairs: On one skeleton; the reference skeleton where there is a network.
        network: None where there is none for this skeleton: all blends are linear.
        reason: Why there is none.
    """
    starts = _stack([pair.start for pair in pairs])
    ends = _stack([pair.end for pair in pairs])
    of = np.repeat(np.arange(len(pairs)), [len(pair.weights) for pair in pairs])
    weights = np.concatenate([pair.weights[:, None] * pair.shares for pair in pairs])
    ground = np.array([pair.ground for pair in pairs])
    start, end = Postures.of(starts), Postures.of(ends)
    frame = PairFrame.of(start, ground)
    start, end = frame.enter(start), frame.enter(end)
    between = linear(start[of], end[of], weights)
    reasons = [reason if pair.method is not BlendMethod.SLERP else "" for pair in pairs]
    neural: Flags = np.zeros(len(pairs), np.bool_)
    if network is not None:
        reasons, neural, better = _correct(pairs, network, start, end, of, weights, between)
        chosen = neural[of]
        between = Postures(
            np.where(chosen[:, None], better.hips, between.hips),
            np.where(chosen[:, None, None], better.rotations, between.rotations),
        )
    rows = frame[of].leave(between)
    poses = _to_poses(rows, starts[of], ends[of], weights).astype(np.float32)
    stops = np.cumsum([len(pair.weights) for pair in pairs])
    return [
        Blended(
            poses[stop - len(pair.weights) : stop],
            BlendMethod.NEURAL if by_network else BlendMethod.SLERP,
            why,
        )
        for pair, stop, by_network, why in zip(pairs, stops, neural, reasons, strict=True)
    ]


def _correct(
    pairs: Sequence[Pair],
    network: BlendNetwork,
    start: Postures,
    end: Postures,
    of: Indices,
    weights: Floats,
    between: Postures,
) -> tuple[list[str], Flags, Postures]:
    """Return for each pair why not the network, whether it, and its postures for every row."""
    duration = np.array([pair.duration for pair in pairs])
    coefficients, distance = network.coefficients(start, end, duration)
    reasons = [
        _why_not(pair, float(far), network) for pair, far in zip(pairs, distance, strict=True)
    ]
    neural = np.array(
        [
            not why and pair.method is not BlendMethod.SLERP
            for pair, why in zip(pairs, reasons, strict=True)
        ]
    )
    better = correct(between, coefficients[of], network.bounds, weights)
    return reasons, neural, keep_feet(better, start[of], end[of], weights)


def _why_not(pair: Pair, distance: float, network: BlendNetwork) -> str:
    if pair.method is BlendMethod.SLERP:
        return ""
    if not distance <= network.furthest:
        return (
            f"the pair is too unlike what the network was trained on: distance {distance:.2f}, "
            f"it is used up to {network.furthest:.2f}"
        )
    if pair.method is BlendMethod.AUTO and pair.duration > LONGEST_S:
        return (
            f"{pair.duration:g} s lie between the postures; the network was trained on up to "
            f"{LONGEST_S:g} s"
        )
    return ""


def _to_poses(rows: Postures, start: Pose, end: Pose, weights: Floats) -> Pose:
    """Return poses relative to a root that goes straight; ends are the very numbers given."""
    share = weights[:, :1]
    position = start.root_position * (1.0 - share) + end.root_position * share
    turn = quaternion.slerp(start.root_rotation, end.root_rotation, share[:, 0])
    back = quaternion.conjugate(turn)
    rotations = rows.rotations.copy()
    rotations[:, 0] = quaternion.multiply(back, rotations[:, 0])
    hips = quaternion.rotate(back, rows.hips - position)
    for at, side in ((0.0, start), (1.0, end)):
        there = share == at
        turn = np.where(there, side.root_rotation, turn)
        hips = np.where(there, side.hips, hips)
        rotations[:, 0] = np.where(there, side.rotations[:, 0], rotations[:, 0])
    return Pose(position, turn, hips, rotations)


def _stack(poses: Sequence[Pose]) -> Pose:
    return Pose.concatenate([pose[np.newaxis] for pose in poses]).astype(np.float64)
