"""Poses and clips.

A pose is a root on the ground (position, heading), the hips relative to it and one local rotation a
joint. The same class holds one pose, a batch `(N, …)` or a clip's frames `(T, …)`.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton


class ClipError(ValueError):
    """A clip's arrays do not fit together or hold numbers that are not finite."""


@dataclass(frozen=True)
class Pose:
    """Poses of any leading shape `(...)`."""

    root_position: Vectors
    """`(..., 3)` on the ground, metres."""
    root_rotation: Quaternions
    """`(..., 4)` turns about +Y."""
    hips: Vectors
    """`(..., 3)` hips relative to the root and in its frame, metres."""
    rotations: Quaternions
    """`(..., J, 4)` local rotations; the first joint's is relative to the root."""

    def __getitem__(self, index: Any) -> "Pose":
        """Index the leading shape."""
        return Pose(
            self.root_position[index],
            self.root_rotation[index],
            self.hips[index],
            self.rotations[index],
        )

    @property
    def world_hips(self) -> tuple[Vectors, Quaternions]:
        """Position `(..., 3)` and rotation `(..., 4)` of the hips in the world."""
        position = self.root_position + quaternion.rotate(self.root_rotation, self.hips)
        return position, quaternion.multiply(self.root_rotation, self.rotations[..., 0, :])

    @staticmethod
    def concatenate(poses: Iterable["Pose"]) -> "Pose":
        """Join along the first axis."""
        parts = list(poses)
        return Pose(
            np.concatenate([p.root_position for p in parts]),
            np.concatenate([p.root_rotation for p in parts]),
            np.concatenate([p.hips for p in parts]),
            np.concatenate([p.rotations for p in parts]),
        )

    def astype(self, dtype: type) -> "Pose":
        """Return the same poses in another float type."""
        return Pose(
            self.root_position.astype(dtype, copy=False),
            self.root_rotation.astype(dtype, copy=False),
            self.hips.astype(dtype, copy=False),
            self.rotations.astype(dtype, copy=False),
        )


@dataclass(frozen=True)
class TagSpan:
    """A named span of a clip: frames `start` up to, not including, `end`."""

    name: str
    start: int
    end: int


@dataclass(frozen=True)
class Clip:
    """Poses at a frame rate.

    Raises:
        ClipError: If lengths differ, a number is not finite or there is no frame.
    """

    name: str
    skeleton: Skeleton
    frame_rate: float
    """Frames per second."""
    pose: Pose
    """`(T, …)`."""
    contacts: Flags
    """`(T, 4)`: left foot, left toe, right foot, right toe planted."""
    tags: tuple[TagSpan, ...] = ()
    source: str = ""
    """File or generator that the clip came from."""
    loops: bool = False
    """Whether the last frame is the first pose again, one lap on."""

    def __post_init__(self) -> None:
        frames, joints = self.pose.rotations.shape[:2]
        expected = {
            "root_position": (frames, 3),
            "root_rotation": (frames, 4),
            "hips": (frames, 3),
            "rotations": (frames, len(self.skeleton), 4),
        }
        for field, shape in expected.items():
            array = getattr(self.pose, field)
            if array.shape != shape:
                raise ClipError(
                    f"clip {self.name!r}: {field} has shape {array.shape}; expected {shape}"
                )
            if not np.all(np.isfinite(array)):
                raise ClipError(f"clip {self.name!r}: {field} is not finite")
        if self.contacts.shape != (frames, 4):
            raise ClipError(
                f"clip {self.name!r}: contacts have shape {self.contacts.shape}; "
                f"expected {(frames, 4)}"
            )
        if frames == 0 or joints == 0 or not self.frame_rate > 0.0:
            raise ClipError(
                f"clip {self.name!r}: {frames} frames at {self.frame_rate} per second; "
                "expected at least one frame and a positive rate"
            )

    def __len__(self) -> int:
        return len(self.pose.rotations)

    @property
    def seconds(self) -> float:
        """Time from the first to the last frame."""
        return (len(self) - 1) / self.frame_rate

    def sample(self, times: Floats | float) -> Pose:
        """Return the poses at `times` `(...)` seconds, within the clip, by nlerp between frames."""
        at = np.clip(np.asarray(times, np.float64) * self.frame_rate, 0.0, len(self) - 1)
        first = np.minimum(at.astype(np.intp), max(len(self) - 2, 0))
        second = np.minimum(first + 1, len(self) - 1)
        dtype = self.pose.rotations.dtype
        weight = (at - first).astype(dtype)
        a, b = self.pose[first], self.pose[second]
        return Pose(
            a.root_position + weight[..., None] * (b.root_position - a.root_position),
            quaternion.nlerp(a.root_rotation, b.root_rotation, weight),
            a.hips + weight[..., None] * (b.hips - a.hips),
            quaternion.nlerp(a.rotations, b.rotations, weight[..., None]),
        )

    def cut(self, start: int, end: int, name: str | None = None) -> "Clip":
        """Return frames `start` up to `end` as a clip of their own, tags moved along."""
        tags = tuple(
            TagSpan(t.name, max(t.start, start) - start, min(t.end, end) - start)
            for t in self.tags
            if t.start < end and t.end > start
        )
        return replace(
            self,
            name=name or self.name,
            pose=self.pose[start:end],
            contacts=self.contacts[start:end],
            tags=tags,
            loops=self.loops and (start, end) == (0, len(self)),
        )


def differences(values: Floats, dt: float) -> Floats:
    """Return rates of change `(T, ...)` by central differences, one-sided at both ends.

    Call it clip by clip: a difference across a cut is no velocity.

    Args:
        values: `(T, ...)`.
        dt: Seconds between frames.
    """
    if len(values) < 2:
        return np.zeros_like(values)
    return np.gradient(values, dt, axis=0).astype(values.dtype)
