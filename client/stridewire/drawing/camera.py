"""A camera that looks at a character from the front and the side, a little from above."""

from dataclasses import dataclass

import numpy as np

from stridewire.drawing.subject import Subject
from stridewire.motion.array_types import Floats, Vectors

_DISTANCE = 5.0
_ELEVATION = np.radians(14.0)
_TARGET_HEIGHT = 0.85
_FROM_FRONT = np.radians(55.0)


@dataclass(frozen=True)
class Camera:
    """A perspective camera; at its target a metre is a unit of the picture."""

    yaw: float
    """Direction from the target to the camera about +Y from +Z; radians."""

    @classmethod
    def beside(cls, subject: Subject) -> "Camera":
        """Stand where the subject comes towards the right of the picture."""
        way = subject.root[-1] - subject.root[0]
        if np.hypot(way[0], way[2]) > 0.5:
            heading = float(np.arctan2(way[0], way[2]))
        else:
            heading = float(subject.heading[0])
        return cls(heading - _FROM_FRONT)

    @property
    def right(self) -> Vectors:
        """`(3,)` the picture's right in the world."""
        return np.array([np.cos(self.yaw), 0.0, -np.sin(self.yaw)])

    @property
    def away(self) -> Vectors:
        """`(3,)` along the ground away from the camera."""
        return np.array([-np.sin(self.yaw), 0.0, -np.cos(self.yaw)])

    def project(self, points: Vectors, root: Vectors) -> tuple[Floats, Floats]:
        """Return picture coordinates `(..., 2)` and depths `(...)`, larger farther.

        Args:
            points: `(..., 3)` in the world, metres.
            root: `(3,)` ground point that the camera follows.
        """
        p = points - root - [0.0, _TARGET_HEIGHT, 0.0]
        along, sine, cosine = p @ self.away, np.sin(_ELEVATION), np.cos(_ELEVATION)
        up = cosine * p[..., 1] + sine * along
        depth = cosine * along - sine * p[..., 1]
        scale = _DISTANCE / (_DISTANCE + depth)
        return np.stack([p @ self.right * scale, up * scale], axis=-1), depth

    def plan(self, points: Vectors) -> Floats:
        """Return `(..., 2)` the points from above, turned as the camera sees them."""
        return np.stack([points @ self.right, points @ self.away], axis=-1)
