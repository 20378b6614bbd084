"""Chains: spans of a plan that are worked on, each alone, and how much of the work is shown.

A seam is hidden within the window that follows it. Windows that reach into each other make one
chain, since the second transition starts from what the first one shows.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Indices

CLEAN_UP_FRAMES = 10
"""Within so many frames at the end of a chain, what is shown becomes the plan again."""


class Chains(NamedTuple):
    """Spans of frames, in order and apart."""

    starts: Indices
    """`(C,)` first frame: a seam, or the plan's first frame."""
    ends: Indices
    """`(C,)` frame after the last."""

    def __len__(self) -> int:
        return len(self.starts)

    def part(self, start: int, stop: int) -> "Chains":
        """Return some of them."""
        return Chains(self.starts[start:stop], self.ends[start:stop])


def chains_after(seams: Indices, window: int, frames: int) -> Chains:
    """Return the chains of `seams` with windows of so many frames, in a plan of `frames`."""
    if not len(seams):
        return Chains(seams, seams)
    begins = np.append(True, np.diff(seams) > window)
    ends = np.append(begins[1:], True)
    return Chains(seams[begins], np.minimum(seams[ends] + window, frames))


def whole(frames: int) -> Chains:
    """Return one chain over all frames."""
    return Chains(np.array([0]), np.array([frames]))


def shares(chains: Chains, frames: int, stays: bool) -> Floats:
    """Return to what share `(frames,)` the work on each frame is shown.

    Args:
        chains: Of the plan.
        frames: Of the plan.
        stays: Whether it is shown to the end, and does not become the plan again.
    """
    share = np.zeros(frames)
    for start, end in zip(chains.starts, chains.ends, strict=True):
        share[start:end] = 1.0
        length = min(CLEAN_UP_FRAMES, end - start)
        if not stays and end < frames:
            x = np.arange(1, length + 1) / (length + 1)
            share[end - length : end] = 1.0 - x * x * (3.0 - 2.0 * x)
    return share
