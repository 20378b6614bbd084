"""What is drawn: joints in the world with sides, feet and root, of a clip or a motion file."""

from dataclasses import dataclass, replace

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.formats.units import likely_unit
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.clip import Clip, TagSpan, differences
from stridewire.motion.root import savitzky_golay
from stridewire.motion.sides import head_joint, joint_sides
from stridewire.motion.skeleton import CONTACT_JOINTS

_UPPER_BODY = ("head", "neck", "skull", "chest", "thorax", "torso", "spine")
"""Parts of names of joints above the hips, the highest first."""

_LEAST_HIP_WIDTH = 0.05
"""Hip joints of some skeletons begin with a pair of joints in one place; metres."""


@dataclass(frozen=True)
class Subject:
    """T frames of J joints, ready to be drawn."""

    name: str
    frame_rate: float
    """Frames per second."""
    parents: tuple[int, ...]
    """Index of each joint's parent, -1 for the first."""
    sides: Indices
    """`(J,)` 1 left, -1 right, 0 middle."""
    positions: Vectors
    """`(T, J, 3)` joints in the world, metres, the ground at y = 0."""
    root: Vectors
    """`(T, 3)` on the ground, metres."""
    heading: Floats
    """`(T,)` radians about +Y from +Z."""
    feet: Indices
    """`(C,)` joints that can be planted; left ones first, as many right ones after."""
    planted: Flags
    """`(T, C)` which of them are."""
    head: int | None = None
    """The joint that gets a head's circle."""
    tags: tuple[TagSpan, ...] = ()

    @property
    def seconds(self) -> float:
        """Time from the first to the last frame."""
        return (len(self.positions) - 1) / self.frame_rate

    @property
    def speed(self) -> Floats:
        """`(T,)` speed of the root over the ground, m/s."""
        return np.asarray(np.linalg.norm(differences(self.root, 1.0 / self.frame_rate), axis=-1))

    def between(self, start_s: float, end_s: float) -> "Subject":
        """Return the frames of a span, without tags.

        Raises:
            ValueError: If the span holds no frame.
        """
        first = max(round(start_s * self.frame_rate), 0)
        last = min(round(end_s * self.frame_rate), len(self.positions) - 1)
        if last < first:
            raise ValueError(
                f"{start_s:g} to {end_s:g} s holds no frame; {self.name} lasts {self.seconds:.2f} s"
            )
        span = slice(first, last + 1)
        return replace(
            self,
            positions=self.positions[span],
            root=self.root[span],
            heading=self.heading[span],
            planted=self.planted[span],
            tags=(),
        )

    @classmethod
    def of_clip(cls, clip: Clip) -> "Subject":
        """Take a clip with its own root and contacts."""
        positions, _ = kinematics.forward_world(clip.skeleton, clip.pose)
        feet = [name for name in CONTACT_JOINTS if name in clip.skeleton.names]
        return cls(
            name=clip.name,
            frame_rate=clip.frame_rate,
            parents=clip.skeleton.parents,
            sides=joint_sides(clip.skeleton.names),
            positions=positions,
            root=clip.pose.root_position,
            heading=quaternion.to_yaw(clip.pose.root_rotation),
            feet=clip.skeleton.indices(feet),
            planted=clip.contacts[:, [CONTACT_JOINTS.index(name) for name in feet]],
            head=head_joint(clip.skeleton.names),
            tags=clip.tags,
        )

    @classmethod
    def of_source(cls, source: SourceMotion, frame_rate: float | None = None) -> "Subject":
        """Take a motion file as it is, its units, axes, feet and root guessed from what moves.

        Args:
            source: Any skeleton.
            frame_rate: Frames per second, instead of what the file says.

        Raises:
            ValueError: If neither the file nor the caller says the frame rate.
        """
        rate = frame_rate or source.frame_rate
        if rate is None:
            raise ValueError(f"{source.path} does not say its frame rate; give it")
        positions, _ = source.global_poses()
        positions = positions * (source.metres_per_unit or likely_unit(source.skeleton))
        names = source.skeleton.names
        positions = _upright(positions, names)
        sides = joint_sides(names)
        feet = _feet(positions, sides)
        # low toes stand on the ground; a quantile, since marker noise goes below
        positions = positions - [0.0, np.quantile(positions[:, feet, 1].min(axis=1), 0.05), 0.0]
        root = savitzky_golay(positions[:, 0], 2 * round(0.25 * rate) + 1) * [1.0, 0.0, 1.0]
        return cls(
            name=source.name,
            frame_rate=rate,
            parents=source.skeleton.parents,
            sides=sides,
            positions=positions,
            root=root,
            heading=_heading(positions, source.skeleton.parents, sides, feet, root),
            feet=feet,
            planted=_planted(positions[:, feet], rate),
            head=head_joint(names),
        )


def _upright(positions: Vectors, names: tuple[str, ...]) -> Vectors:
    """Turn Z-up files to Y-up, told by where the upper body is above the hips."""
    upper = next(
        (i for word in _UPPER_BODY for i, name in enumerate(names) if word in name.lower()), None
    )
    if upper is None:
        return positions
    x, y, z = np.abs(np.median(positions[:, upper] - positions[:, 0], axis=0))
    if z <= max(x, y):
        return positions
    return np.stack([positions[..., 0], positions[..., 2], -positions[..., 1]], axis=-1)


def _feet(positions: Vectors, sides: Indices) -> Indices:
    """Return the joint of each side that is lowest most of the time; without sides, of all."""
    height = np.median(positions[..., 1], axis=0)
    found = [np.flatnonzero(sides == side) for side in (1, -1)]
    if not all(len(joints) for joints in found):
        return np.array([np.argmin(height)])
    return np.array([joints[np.argmin(height[joints])] for joints in found])


def _heading(
    positions: Vectors, parents: tuple[int, ...], sides: Indices, feet: Indices, root: Vectors
) -> Floats:
    """Return `(T,)` the front of the line between the hip joints; without sides, the way."""
    for right, left in zip(
        *(_chain(parents, sides, foot) for foot in reversed(feet)), strict=False
    ):
        across = positions[:, left] - positions[:, right]
        if np.median(np.linalg.norm(across, axis=-1)) > _LEAST_HIP_WIDTH:
            return np.asarray(np.arctan2(-across[:, 2], across[:, 0]))
    step = np.gradient(root, axis=0) if len(root) > 1 else np.zeros_like(root)
    return np.asarray(np.arctan2(step[:, 0], step[:, 2]))


def _chain(parents: tuple[int, ...], sides: Indices, joint: int) -> list[int]:
    """Return the joints of one side from the body down to a joint."""
    chain: list[int] = []
    while joint >= 0 and sides[joint] != 0:
        chain.insert(0, int(joint))
        joint = parents[joint]
    return chain


def _planted(feet: Vectors, frame_rate: float) -> Flags:
    """Return `(T, C)`: low and slower than 0.25 m/s."""
    speed = np.linalg.norm(differences(feet, 1.0 / frame_rate), axis=-1)
    low = feet[..., 1] < np.quantile(feet[..., 1], 0.05, axis=0) + 0.05
    return np.asarray(low & (speed < 0.25))
