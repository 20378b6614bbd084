"""Holding: far characters are stepped every n-th tick and in between show what they showed.

A step of theirs makes up for all the time since the one before. Ticks of theirs are spread, so that
a crowd of them costs the same in each.
"""

from dataclasses import replace

import numpy as np

from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.tick import Block

_MOST_OWED_S = 0.25
"""So long a character is not stepped at most, however few ticks that takes."""
_KEPT = ("root", "hips", "rotations", "foot_targets", "simulated_root", "fallback")


def due(rows: Characters, dt: Floats) -> Flags:
    """Tell who `(N,)` is to be stepped, by `owed` seconds; who begins always is.

    Args:
        rows: N of them; what they are owed grows by `dt`.
        dt: `(N,)` seconds; a paused character waits where it is.
    """
    begins = rows.clip < 0
    rows.owed += dt
    rows.ticks_left -= dt > 0.0
    stepped = (rows.ticks_left <= 0) | (rows.owed > _MOST_OWED_S) | begins
    every = np.maximum(rows.rate_divider, 1)
    # those that begin together fall apart
    first = 1 + (rows.stagger * every).astype(np.int8)
    rows.ticks_left[...] = np.where(stepped, np.where(begins, first, every), rows.ticks_left)
    return np.asarray(stepped)


def held(rows: Characters, stepped: Flags, block: Block) -> Block:
    """Return the block of all rows from that of those who were stepped.

    Args:
        rows: N of them, already stepped.
        stepped: `(N,)` who was.
        block: Of those.
    """
    where = np.flatnonzero(stepped)
    for name in _KEPT:
        getattr(rows, f"held_{name}")[where] = getattr(block, name)
    before = rows.contacts.copy()
    before[where] = block.contacts_before
    delta = np.zeros((len(rows), 4), np.float32)
    delta[where] = block.root_delta
    entered = np.zeros(len(rows), block.tags_entered.dtype)
    entered[where] = block.tags_entered
    searched = np.zeros(len(rows), np.bool_)
    searched[where] = block.searched
    jumps = block.jumps
    return replace(
        block,
        **{name: getattr(rows, f"held_{name}").copy() for name in _KEPT},
        root_delta=delta,
        contacts=rows.contacts.copy(),
        contacts_before=before,
        tags_entered=entered,
        searched=searched,
        jumps=None if jumps is None else jumps._replace(characters=where[jumps.characters]),
        refined_frames=rows.refined_frames.copy(),
    )
