"""Planting: feet that stay where they are put, on any path of the body.

A toe is planted at the mean, over its stance, of where the unpinned toe would be in the world; so
steps agree with the travel without a formula for their length. In between the foot follows the
model's path plus an offset that leads from the last plant to the next.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Vectors


@dataclass(frozen=True)
class Feet:
    """Feet in the world, left and right."""

    toe: Vectors
    """`(T, 2, 3)` toe joints, metres."""
    yaw: Floats
    """`(T, 2)` headings, radians."""
    pitch: Floats
    """`(T, 2)` heel above the toe, radians; negative with the toe up."""
    planted: Flags
    """`(T, 2)` whether the toe is planted."""


def plant(feet: Feet, holding: Flags, pivot: Floats, height: float) -> Feet:
    """Pin the toes of unpinned feet.

    Args:
        feet: Where the model would have them, moving along with the body.
        holding: `(T,)` whether the character stands; a stance with standing in it is planted there.
        pivot: `(T,)` share of its turning that a planted foot does about its toe, 0 to 1.
        height: Of a planted toe joint above the ground, metres.
    """
    toe, yaw, pitch = feet.toe.copy(), feet.yaw.copy(), feet.pitch.copy()
    for side in range(2):
        down = feet.planted[:, side]
        for axis in (0, 2):
            toe[:, side, axis] = _pin(toe[:, side, axis], down, holding, np.zeros_like(pivot))
        yaw[:, side] = _pin(yaw[:, side], down, holding, pivot)
        level = np.full(len(pivot), height)
        toe[:, side, 1] = np.maximum(_settle(toe[:, side, 1], down, level), height)
        pitch[:, side] = _settle(pitch[:, side], down, np.maximum(pitch[:, side], 0.0))
    return Feet(toe, yaw, pitch, feet.planted)


def stances(planted: Flags) -> list[tuple[int, int]]:
    """Return the spans (first frame, one past the last) in which a foot `(T,)` is planted."""
    edges = np.flatnonzero(np.diff(planted.astype(np.int8), prepend=0, append=0))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _pin(motion: Floats, planted: Flags, holding: Flags, loose: Floats) -> Floats:
    """Hold `(T,)` still in each stance, but for a loose share, and ease the offset over swings."""
    out = motion.copy()
    for start, end in stances(planted):
        still = holding[start:end]
        frames = np.flatnonzero(still) if still.any() else np.arange(end - start)
        place = motion[start:end][frames].mean()
        out[start:end] = place + loose[start:end] * (motion[start:end] - place)
    for first, last, before, after in _swings(out - motion, planted):
        x = _progress(first, last)
        out[first:last] += before + x * x * (3.0 - 2.0 * x) * (after - before)
    return out


def _settle(values: Floats, planted: Flags, goal: Floats) -> Floats:
    """Take the goal `(T,)` in stances; leave it fast in swings, so that feet clear the ground."""
    out = np.where(planted, goal, values)
    for first, last, before, after in _swings(out - values, planted):
        x = _progress(first, last)
        out[first:last] += before * _fade(x) + after * _fade(1.0 - x)
    return out


def _swings(offset: Floats, planted: Flags) -> Iterator[tuple[int, int, float, float]]:
    """Yield the spans between stances with the offsets `(T,)` before and after each.

    At the ends of a clip, where there is no stance, the other one's offset is taken.
    """
    for first, last in stances(~planted):
        before = offset[first - 1 if first > 0 else last % len(offset)]
        after = offset[last if last < len(offset) else first - 1]
        yield first, last, float(before), float(after)


def _progress(first: int, last: int) -> Floats:
    return (np.arange(first, last) - first + 1.0) / (last - first + 1.0)


def _fade(x: Floats) -> Floats:
    """From 1 at 0 smoothly to 0 at 0.35."""
    x = np.clip(x / 0.35, 0.0, 1.0)
    return np.asarray(1.0 - x * x * (3.0 - 2.0 * x))
