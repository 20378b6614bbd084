"""Left and right: which side of the body joints are on, told by their names."""

import re

import numpy as np

from stridewire.motion.array_types import Indices


def joint_sides(names: tuple[str, ...]) -> Indices:
    """Return `(J,)` 1 for left, -1 for right, 0 for the middle, by names that come in pairs."""
    folded = [name.lower() for name in names]
    sides = np.zeros(len(names), np.intp)
    for left, right in (("left", "right"), ("l", "r")):
        pattern = re.compile(f"{left}" if len(left) > 1 else rf"^{left}|(?<=[_.:\- ]){left}")
        for index, name in enumerate(folded):
            partner = pattern.sub(right, name, count=1)
            if partner != name and partner in folded and sides[index] == 0:
                sides[index], sides[folded.index(partner)] = 1, -1
    return sides


def head_joint(names: tuple[str, ...]) -> int | None:
    """Return the first joint that is called a head; None where none is."""
    return next((i for i, name in enumerate(names) if "head" in name.lower()), None)
