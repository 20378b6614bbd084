"""Showing for kernels: the arrays of a tick's block that are told from the characters' state.

The counterpart of `Tick._block`.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire_engine.compiled import kernel


class Seen(NamedTuple):
    """Columns of characters that a block tells of."""

    root_position: Vectors
    root_yaw: Floats
    sim_position: Floats
    sim_yaw: Floats
    terrain: Floats
    locked: Flags
    lock_point: Vectors
    tag_bits: Indices
    contacts: Flags


class Told(NamedTuple):
    """Arrays of N rows that are written; see `Block`."""

    root: Floats
    root_delta: Floats
    foot_targets: Vectors
    simulated_root: Floats
    tags_entered: Indices
    contacts_before: Flags


@kernel
def tell(
    seen: Seen,
    tag_bits: Indices,
    rows: Indices,
    weight: Floats,
    delta: Floats,
    contacts: Flags,
    told: Told,
) -> None:
    """Write what a block tells, and note contacts and tags for the next one.

    Args:
        seen: Of N characters.
        tag_bits: `(F,)` of the library.
        rows: `(N,)` of the library, at or before the time.
        weight: `(N,)` share of the next row.
        delta: `(N, 4)` root motion.
        contacts: `(N, 4)` now.
        told: Out.
    """
    for row in range(len(rows)):
        half = 0.5 * seen.root_yaw[row]
        height = seen.root_position[row, 1] + seen.terrain[row, 0]
        _place(told.root, row, seen.root_position[row, 0], height, seen.root_position[row, 2])
        told.root[row, 3], told.root[row, 5] = math.cos(half), math.sin(half)
        told.root[row, 4] = told.root[row, 6] = 0.0
        _place(
            told.simulated_root, row, seen.sim_position[row, 0], height, seen.sim_position[row, 1]
        )
        told.simulated_root[row, 3] = seen.sim_yaw[row]
        for i in range(4):
            told.root_delta[row, i] = delta[row, i]
            told.contacts_before[row, i] = seen.contacts[row, i]
            seen.contacts[row, i] = contacts[row, i]
        for side in range(2):
            for axis in range(3):
                point = seen.lock_point[row, side, axis]
                if axis == 1:
                    point += seen.terrain[row, 1 + side]
                told.foot_targets[row, side, axis] = point if seen.locked[row, side] else math.nan
        now = tag_bits[rows[row] + 1] if weight[row] >= 0.5 else tag_bits[rows[row]]
        told.tags_entered[row] = now & ~seen.tag_bits[row]
        seen.tag_bits[row] = now


@kernel
def _place(out: Floats, row: int, x: float, y: float, z: float) -> None:
    out[row, 0], out[row, 1], out[row, 2] = x, y, z
