"""Planting: toes of a rig that stay where they came down, because the hips give way.

With limbs' directions as the reference has them, a planted toe decides where the hips are. The foot
that lands takes over from where it is, so nothing jumps; when one lifts and the other wants the
hips elsewhere, that difference decays.
"""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.springs import damper_fraction

_GIVING_HALFLIFE = 0.04
"""Damper of the hips' lag after a foot has come down or lifted; seconds."""
_ACROSS = 0.05
"""What a foot's way across itself counts beside that along itself, in moving the hips."""
_RELEASE_HALFLIFE = 0.06
"""Damper of the correction of a foot that has lifted; seconds."""
_HELD = 0.004
"""Metres that a toe may be from where the reference's is, to be where that one is locked."""
_SETTLE_HALFLIFE = 0.05
"""Damper that brings a foot that came down too high or too low to the ground; seconds."""


@dataclass
class Planting:
    """What N characters' feet, left and right, remember from frame to frame."""

    planted: Flags
    """`(N, 2)` in the frame before."""
    held: Vectors
    """`(N, 2, 3)` from the reference's toe to what the rig's follows, in the rig's size; world."""
    aside: Vectors
    """`(N, 2, 3)` from where the reference's toe was, in the rig's size, to where the rig's came
    down; in the world."""
    correction: Vectors
    """`(N, 2, 3)` by which the toe is off its limbs' directions, relative to the root."""
    lag: Vectors
    """`(N, 3)` by which the hips are off where planted feet want them; relative to the root."""

    @classmethod
    def fresh(cls, count: int) -> "Planting":
        """Return rows for characters that begin."""
        return cls(
            np.zeros((count, 2), np.bool_),
            np.zeros((count, 2, 3), np.float32),
            np.zeros((count, 2, 3), np.float32),
            np.zeros((count, 2, 3), np.float32),
            np.zeros((count, 3), np.float32),
        )

    def put(self, rows: Indices, other: "Planting", other_rows: Indices) -> None:
        """Take rows over from elsewhere."""
        for field in fields(self):
            getattr(self, field.name)[rows] = getattr(other, field.name)[other_rows]


class Feet(NamedTuple):
    """What the reference's feet do."""

    planted: Flags
    """`(N, 2)`."""
    held: Vectors
    """`(N, 2, 3)` from the toes to near where they are locked, in the rig's size; world."""
    toes: Vectors
    """`(N, 2, 3)` in the rig's size."""
    to_world: Quaternions
    """`(N, 2, 4)` rotation of the root."""


class Legs(NamedTuple):
    """Both legs' joints, `(N, 2, 3)` each."""

    hip: Vectors
    knee: Vectors
    ankle: Vectors
    toe: Vectors


def plant(
    planting: Planting,
    legs: Legs,
    feet: Feet,
    height: float,
    dt: Floats,
) -> Vectors:
    """Update what the feet remember and return by how much the hips give way, `(N, 3)`.

    Args:
        planting: N rows; updated.
        legs: As the limbs' directions have them.
        feet: The reference's.
        height: Of the rig's toes over those, both on the ground.
        dt: `(N,)` seconds.
    """
    passed = dt[:, None, None]
    to_root = quaternion.conjugate(feet.to_world)
    planted = feet.planted
    foot = legs.toe - legs.ankle
    # where a lock begins or ends nothing jumps
    let_go = (np.any(feet.held, axis=-1) != np.any(planting.held, axis=-1))[..., None]
    aside = planting.aside + np.where(let_go, planting.held - feet.held, 0.0)
    natural = feet.toes + quaternion.rotate(to_root, feet.held) - legs.toe
    lag = planting.lag * (1.0 - damper_fraction(_GIVING_HALFLIFE, passed[:, 0]))
    shift = _giving(natural + quaternion.rotate(to_root, aside), foot, planting.planted) + lag
    released = planting.correction * (1.0 - damper_fraction(_RELEASE_HALFLIFE, passed))
    lands = (planted & ~planting.planted)[..., None]
    came_down = shift[:, None] + released - natural
    aside = np.where(lands, quaternion.rotate(feet.to_world, came_down), aside)
    apart = natural + quaternion.rotate(to_root, aside)
    changed = (planted != planting.planted).any(axis=1, keepdims=True)
    wanted = _giving(apart, foot, planted)
    planting.lag[...] = np.where(changed, shift - wanted, lag)
    shift = wanted + planting.lag
    planting.correction[...] = np.where(planted[..., None], apart - shift[:, None], released)
    fraction = damper_fraction(_SETTLE_HALFLIFE, passed[..., 0])
    aside[..., 1] += np.where(planted, fraction * (height - aside[..., 1]), 0.0)
    planting.aside[...] = aside
    planting.held[...] = feet.held
    planting.planted[...] = planted
    return np.asarray(shift, np.float32)


def nearby(held: Vectors) -> Vectors:
    """Shorten ways `(N, 2, 3)` that are too long; none where NaN."""
    way = np.nan_to_num(held)
    length = np.linalg.norm(way, axis=-1, keepdims=True)
    return np.asarray(way * np.minimum(1.0, _HELD / np.maximum(length, 1e-6)))


def _giving(apart: Vectors, foot: Vectors, planted: Flags) -> Vectors:
    """Return where the hips `(N, 3)` are to go for the planted feet.

    What lies along a foot only the hips can give; what lies across it the foot can, by turning.
    """
    way = foot / np.maximum(np.linalg.norm(foot, axis=-1, keepdims=True), 1e-3)
    weigh = way[..., :, None] * way[..., None, :] + _ACROSS * np.eye(3, dtype=np.float32)
    weigh = weigh * planted[..., None, None]
    wanted = (weigh @ apart[..., None]).sum(axis=1)
    whole = weigh.sum(axis=1) + 1e-6 * np.eye(3, dtype=np.float32)
    return np.asarray(np.linalg.solve(whole, wanted)[..., 0])
