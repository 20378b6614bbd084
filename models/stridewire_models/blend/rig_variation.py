"""Rig variation: the same motion as other rigs hold it, so that the network learns none by heart.

Retargeted captures differ by constant turns of joints: one rig's wrists rest bent, another's are
straight. A network that saw one of them only is lost on the other.
"""

from dataclasses import replace

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.blend.pairs import Pairs
from stridewire_engine.networks.blend.postures import Postures

_UPPER, _LEGS = 0.2, 0.05
"""Largest deviations of the turns; radians. Feet on the ground bear less."""
_LEG_JOINTS = ("UpLeg", "Leg", "Foot", "Toe")


def _spread() -> Floats:
    """Return the largest deviation of each joint's turn `(J, 1)`; the hips keep theirs."""
    legs = [name.endswith(_LEG_JOINTS) for name in REFERENCE.names]
    spread = np.where(legs, _LEGS, _UPPER)
    spread[0] = 0.0
    return np.asarray(spread[:, None], np.float32)


_SPREAD = _spread()


def vary_rigs(pairs: Pairs, rng: np.random.Generator) -> Pairs:
    """Turn each joint of a pair, and of what lies between, by a constant of its own.

    Args:
        pairs: `(N, W)`.
        rng: Draws the turns, small ones more often than large ones.
    """
    count, joints = len(pairs), len(REFERENCE)
    size = rng.random((count, 1, 1), np.float32) * _SPREAD
    turns = rng.standard_normal((count, joints, 3), np.float32) * size
    turn = quaternion.from_scaled_axis(turns)
    return replace(
        pairs,
        start=_turned(pairs.start, turn),
        end=_turned(pairs.end, turn),
        truth=_turned(pairs.truth, turn[:, None]),
    )


def _turned(postures: Postures, turn: Quaternions) -> Postures:
    return Postures(postures.hips, quaternion.multiply(postures.rotations, turn))
