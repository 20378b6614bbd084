"""Skipping a frame: what it told goes into its successor, so that nothing is lost but poses."""

from dataclasses import replace

import numpy as np

from stridewire._messages import Frame, FrameFlag
from stridewire.motion.array_types import Floats

MAX_EVENTS = 4096
"""Most events that a frame carries; the oldest give way."""


def skip(skipped: Frame, newer: Frame) -> Frame:
    """Return `newer` as the successor of whatever was sent before `skipped`.

    Root motions are composed, flags and events of both are kept, the skipped frame is counted.
    """
    delta = newer.root_delta.copy()
    flags = newer.flags.copy()
    here, there = _shared_rows(skipped, newer)
    flags[there] |= skipped.flags[here]
    # A teleport breaks the root motion: what came before it leads nowhere.
    stayed = (newer.flags[there] >> np.uint32(FrameFlag.TELEPORTED)) & 1 == 0
    here, there = here[stayed], there[stayed]
    delta[there] = compose(skipped.root_delta[here], delta[there])
    return replace(
        newer,
        root_delta=delta,
        flags=flags,
        events=(*skipped.events, *newer.events)[-MAX_EVENTS:],
        dropped=newer.dropped + skipped.dropped + 1,
        searches=newer.searches + skipped.searches,
    )


def compose(first: Floats, second: Floats) -> Floats:
    """Return root motions `(N, 4)` x, y, z, yaw of `first` followed by `second`."""
    x, y, z, yaw = first.T
    sin, cos = np.sin(yaw), np.cos(yaw)
    return np.stack(
        [
            x + cos * second[:, 0] + sin * second[:, 2],
            y + second[:, 1],
            z - sin * second[:, 0] + cos * second[:, 2],
            yaw + second[:, 3],
        ],
        axis=-1,
    )


def _shared_rows(skipped: Frame, newer: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of the characters that both frames have."""
    _, here, there = np.intersect1d(
        skipped.characters, newer.characters, assume_unique=True, return_indices=True
    )
    return here, there
