"""Units of length in motion files, by name, in metres or by the size of a skeleton."""

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire.motion.skeleton import Skeleton

UNITS = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 0.001,
    "foot": 0.3048,
    "inch": 0.0254,
    "cmu": 0.0254 / 0.45,
}
"""Metres per unit by the unit's name; `cmu` is the CMU database's."""

_SMALLEST, _LARGEST = 1e-6, 1e3
_ALIKE = 0.005

_LIKELY = (1.0, 0.1, 0.0564, 0.0254, 0.01, 0.001)
"""Metres in the units that motion files are in; 0.0564 is that of the CMU database."""

_LEG = 1.0
"""Length of the longest chain of bones downwards from the hips in people; metres."""


def parse_unit(text: str) -> float:
    """Return the metres of a unit given by its name or as a number of metres.

    Raises:
        ValueError: If it is neither.
    """
    try:
        metres = UNITS[text] if text in UNITS else float(text)
    except ValueError:
        metres = 0.0
    if not _SMALLEST <= metres <= _LARGEST:
        raise ValueError(
            f"unit {text!r}; expected {', '.join(UNITS)} or the metres of one unit, such as 0.0254"
        )
    return metres


def unit_name(metres: float) -> str:
    """Return the name of a unit, else how many metres it has."""
    for name, known in UNITS.items():
        if abs(metres - known) < _ALIKE * known:
            return name
    return f"{metres:.4g} m"


def likely_unit(skeleton: Skeleton) -> float:
    """Return the metres of the unit in which the longest chain of bones is nearest to a leg."""
    distance = np.abs(np.log(np.array(_LIKELY) * max(longest_chain(skeleton), 1e-9) / _LEG))
    return _LIKELY[int(np.argmin(distance))]


def longest_chain(skeleton: Skeleton) -> float:
    """Return the length of the longest chain of bones from the first joint; its unit."""
    bones = np.linalg.norm(skeleton.offsets, axis=-1)
    chain: Floats = np.zeros(len(skeleton))
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        chain[joint] = chain[parent] + bones[joint]
    return float(chain.max())
