"""How thick a body is: radii for the joints of any skeleton, from bones' lengths and sides."""

from collections.abc import Sequence

import numpy as np

from stridewire.motion.array_types import Floats, Indices

TRUNK = 0.085
"""Radius of the trunk, front to back, in a body whose longest chain of bones is 1 m, as a leg."""
HEAD = 0.095
BREADTH = 1.45
"""A trunk is so much broader than deep."""

_LIMB, _LEAST = 0.078, 0.04
_THINNER = 0.45
"""Limbs lose so much of their radius towards their ends."""


def trunk_joints(parents: Sequence[int], sides: Indices) -> set[int]:
    """Return the joints of the middle from which, or below which, a sided joint branches off."""
    trunk: set[int] = set()
    for joint in range(len(parents) - 1, 0, -1):
        parent = parents[joint]
        if sides[parent] == 0 and (sides[joint] != 0 or joint in trunk):
            trunk.add(parent)
    return trunk


def limb_radii(parents: Sequence[int], bones: Floats, trunk: set[int], size: float) -> Floats:
    """Return `(J,)` radii: larger in longer limbs, smaller towards their ends.

    Args:
        parents: Of the joints, -1 for the first.
        bones: `(J,)` distances to the parents.
        trunk: Joints that belong to no limb.
        size: Length of the longest chain of bones.
    """
    below, way = np.zeros(len(parents)), np.zeros(len(parents))
    for joint in range(len(parents) - 1, 0, -1):
        parent = parents[joint]
        below[parent] = max(below[parent], below[joint] + bones[joint])
    whole = below.copy()
    for joint, parent in enumerate(parents[1:], start=1):
        if parent not in trunk:
            way[joint], whole[joint] = way[parent] + bones[joint], whole[parent]
    share = np.minimum(way / np.maximum(whole, 1e-9), 1.0)
    thick = np.maximum(_LIMB * np.sqrt(whole / max(size, 1e-9)), _LEAST) * size
    return np.asarray(thick * (1.0 - _THINNER * share))
