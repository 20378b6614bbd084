"""Skeletons: names, parents, rest offsets of joints; the reference that everything runs on."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stridewire.motion.array_types import Indices, Vectors


class SkeletonError(ValueError):
    """A skeleton is malformed or lacks a joint; the message says which and what to do."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints at rest.

    Raises:
        SkeletonError: If names repeat, a parent does not precede its child, or lengths differ.
    """

    names: tuple[str, ...]
    """Names of the J joints, the hips first."""
    parents: tuple[int, ...]
    """Index of each joint's parent, -1 for the first."""
    offsets: Vectors
    """`(J, 3)` offsets from the parent, in its frame, metres; the first: the hips' rest height."""

    def __post_init__(self) -> None:
        offsets = np.asarray(self.offsets, np.float64)
        object.__setattr__(self, "offsets", offsets)
        if not len(self.names) == len(self.parents) == len(offsets) or offsets.shape[1:] != (3,):
            raise SkeletonError(
                f"{len(self.names)} names, {len(self.parents)} parents and offsets of shape "
                f"{offsets.shape}; expected J, J and (J, 3)"
            )
        if len(set(self.names)) != len(self.names):
            twice = next(name for name in self.names if self.names.count(name) > 1)
            raise SkeletonError(f"the joint name {twice!r} occurs twice; names must be unique")
        for joint, parent in enumerate(self.parents):
            if (parent == -1) != (joint == 0) or parent >= joint:
                raise SkeletonError(
                    f"joint {self.names[joint]!r} has parent {parent}; expected -1 for the first "
                    "joint alone and for others the index of an earlier joint"
                )
        if not np.all(np.isfinite(offsets)):
            raise SkeletonError("an offset is not finite; expected metres")

    def __len__(self) -> int:
        return len(self.names)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Skeleton) and self.hash == other.hash

    def __hash__(self) -> int:
        return hash(self.hash)

    def index(self, name: str) -> int:
        """Return the index of a joint.

        Raises:
            SkeletonError: If the skeleton has no such joint.
        """
        try:
            return self.names.index(name)
        except ValueError:
            raise SkeletonError(
                f"no joint {name!r}; this skeleton has {', '.join(self.names)}"
            ) from None

    def indices(self, names: Sequence[str]) -> Indices:
        """Return the indices of several joints."""
        return np.array([self.index(name) for name in names], np.intp)

    @cached_property
    def hash(self) -> str:
        """Hexadecimal digest of names, parents and offsets (to 0.01 mm)."""
        text = f"{self.names}{self.parents}{np.round(self.offsets * 1e5).astype(int).tolist()}"
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @cached_property
    def levels(self) -> tuple[tuple[Indices, Indices], ...]:
        """Joints by depth below the hips, with their parents: what `forward` loops over."""
        depth = [0] * len(self)
        for joint, parent in enumerate(self.parents[1:], start=1):
            depth[joint] = depth[parent] + 1
        levels = []
        for level in range(1, max(depth) + 1):
            joints = np.array([j for j, d in enumerate(depth) if d == level], np.intp)
            levels.append((joints, np.array([self.parents[j] for j in joints], np.intp)))
        return tuple(levels)

    @cached_property
    def mirror(self) -> Indices:
        """For each joint the index of its partner on the other side; itself on the spine."""
        partner = {
            name: name.replace("Left", "\0").replace("Right", "Left").replace("\0", "Right")
            for name in self.names
        }
        return np.array([self.index(partner[name]) for name in self.names], np.intp)

    def scaled(self, factor: float) -> "Skeleton":
        """Return the same skeleton `factor` times as large."""
        return Skeleton(self.names, self.parents, self.offsets * factor)


_REFERENCE_JOINTS = (
    # name, parent, offset at rest in metres: a T-pose 1.75 m tall
    ("Hips", -1, (0.0, 0.95, 0.0)),
    ("LeftUpLeg", 0, (0.095, -0.04, 0.0)),
    ("LeftLeg", 1, (0.0, -0.43, 0.0)),
    ("LeftFoot", 2, (0.0, -0.41, 0.0)),
    ("LeftToe", 3, (0.0, -0.05, 0.135)),
    ("RightUpLeg", 0, (-0.095, -0.04, 0.0)),
    ("RightLeg", 5, (0.0, -0.43, 0.0)),
    ("RightFoot", 6, (0.0, -0.41, 0.0)),
    ("RightToe", 7, (0.0, -0.05, 0.135)),
    ("Spine", 0, (0.0, 0.09, 0.0)),
    ("Spine1", 9, (0.0, 0.12, 0.0)),
    ("Spine2", 10, (0.0, 0.12, 0.0)),
    ("Neck", 11, (0.0, 0.21, 0.0)),
    ("Head", 12, (0.0, 0.11, 0.01)),
    ("LeftShoulder", 11, (0.035, 0.16, 0.0)),
    ("LeftArm", 14, (0.135, 0.0, 0.0)),
    ("LeftForeArm", 15, (0.29, 0.0, 0.0)),
    ("LeftHand", 16, (0.255, 0.0, 0.0)),
    ("RightShoulder", 11, (-0.035, 0.16, 0.0)),
    ("RightArm", 18, (-0.135, 0.0, 0.0)),
    ("RightForeArm", 19, (-0.29, 0.0, 0.0)),
    ("RightHand", 20, (-0.255, 0.0, 0.0)),
)

REFERENCE = Skeleton(
    tuple(name for name, _, _ in _REFERENCE_JOINTS),
    tuple(parent for _, parent, _ in _REFERENCE_JOINTS),
    np.array([offset for _, _, offset in _REFERENCE_JOINTS]),
)
"""The 22 joints, LaFAN1's names and order, on which networks and the live runtime work."""

CONTACT_JOINTS = ("LeftFoot", "LeftToe", "RightFoot", "RightToe")
"""Joints whose planting is recorded, in the order of contact arrays and masks."""

HEAD_TOP = 0.15
"""From the head joint of the reference skeleton to the top of the head; metres."""
