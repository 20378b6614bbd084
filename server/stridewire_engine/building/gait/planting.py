"""Planting: feet that stay where they are put, on any path of the body.

A toe is planted at the mean, over its stance, of where the unpinned toe would be in the world; so
steps agree with the travel without a formula for their length. In between the foot follows the
style's path plus an offset that leads from the last plant to the next.
"""

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


def plant(feet: Feet, holding: Flags, height: float) -> Feet:
    """Pin the toes of unpinned feet.

    Args:
        feet: Where the style would have them, moving along with the body.
        holding: `(T,)` whether the character stands; a stance with standing in it is planted there.
        height: Of a planted toe joint above the ground, metres.
    """
    toe, yaw = feet.toe.copy(), feet.yaw.copy()
    for side in range(2):
        motion = np.column_stack([toe[:, side, 0], toe[:, side, 2], yaw[:, side]])
        pinned = _pin(motion, feet.planted[:, side], holding)
        toe[:, side, 0], toe[:, side, 2], yaw[:, side] = pinned.T
        down = feet.planted[:, side]
        toe[:, side, 1] = np.where(down, height, np.maximum(toe[:, side, 1], height))
    return Feet(toe, yaw, feet.pitch, feet.planted)


def stances(planted: Flags) -> list[tuple[int, int]]:
    """Return the spans (first frame, one past the last) in which a foot `(T,)` is planted."""
    edges = np.flatnonzero(np.diff(planted.astype(np.int8), prepend=0, append=0))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _pin(motion: Floats, planted: Flags, holding: Flags) -> Floats:
    """Hold `(T, C)` still in each stance and ease the offset over each swing."""
    offset = np.zeros_like(motion)
    out = motion.copy()
    spans = stances(planted)
    for start, end in spans:
        still = holding[start:end]
        frames = np.flatnonzero(still) if still.any() else np.arange(end - start)
        out[start:end] = motion[start:end][frames].mean(axis=0)
    offset[planted] = (out - motion)[planted]
    ends = [0, *(end for _, end in spans)]
    starts = [*(start for start, _ in spans), len(motion)]
    for end, start in zip(ends, starts, strict=True):
        if end < start:
            _ease(out, motion, end, start)
    return out


def _ease(out: Floats, motion: Floats, first: int, last: int) -> None:
    """Fill the swing of frames `first` up to `last` so that it meets the plants around it."""
    before = out[first - 1] - motion[first - 1] if first > 0 else None
    after = out[last] - motion[last] if last < len(motion) else None
    if before is None or after is None:
        whole = before if before is not None else after
        out[first:last] = motion[first:last] + (0.0 if whole is None else whole)
        return
    x = (np.arange(first, last) - first + 1.0) / (last - first + 1.0)
    weight = (x * x * (3.0 - 2.0 * x))[:, None]
    out[first:last] = motion[first:last] + before + weight * (after - before)
