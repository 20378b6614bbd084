"""Coordinates of engines: from ours to theirs and back.

Ours: metres, right-handed, +Y up, a character looks along +Z and its left is +X; quaternions are
w, x, y, z. A rotation R becomes M R Mᵀ for the matrix M between the axes: its quaternion keeps w
and turns its vector v to det(M) M v, since where handedness changes a turn changes its sense.

| system  | handed | up | forward | left | unit | quaternion | from (x, y, z)          |
|---------|--------|----|---------|------|------|------------|-------------------------|
| Unity   | left   | +Y | +Z      | −X   | m    | x, y, z, w | (−x, y, z)              |
| Unreal  | left   | +Z | +X      | −Y   | cm   | X, Y, Z, W | (100 z, −100 x, 100 y)  |
| Godot   | right  | +Y | −Z      | −X   | m    | x, y, z, w | (−x, y, −z)             |
| glTF    | right  | +Y | +Z      | +X   | m    | x, y, z, w | (x, y, z)               |
| Blender | right  | +Z | −Y      | +X   | m    | w, x, y, z | (x, −z, y)              |

    UNITY.positions(frame.root[:, :3]), UNITY.rotations(frame.root[:, 3:])
    UNITY.rotations(frame.rotations)  # local rotations go the same way
"""

from dataclasses import dataclass, replace

import numpy as np

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton


@dataclass(frozen=True)
class CoordinateSystem:
    """Axes, unit and order of quaternions of an engine."""

    name: str
    axes: tuple[tuple[int, int, int], tuple[int, int, int], tuple[int, int, int]]
    """Rows of M: their x, y and z in our axes."""
    units_per_metre: float = 1.0
    scalar_last: bool = True
    """Whether quaternions are x, y, z, w."""

    @property
    def handedness(self) -> float:
        """1 where right-handed, -1 where left-handed."""
        return float(round(np.linalg.det(np.array(self.axes))))

    def positions(self, ours: Vectors) -> Vectors:
        """Convert positions, offsets or velocities `(..., 3)` from metres to the engine's unit."""
        return np.asarray(ours @ self._matrix(ours) * ours.dtype.type(self.units_per_metre))

    def directions(self, ours: Vectors) -> Vectors:
        """Convert directions `(..., 3)`, which have no unit."""
        return np.asarray(ours @ self._matrix(ours))

    def rotations(self, ours: Quaternions) -> Quaternions:
        """Convert rotations `(..., 4)`, local ones or in the world, to the engine's order."""
        vector = self.handedness * (ours[..., 1:] @ self._matrix(ours))
        parts = (vector, ours[..., :1]) if self.scalar_last else (ours[..., :1], vector)
        return np.concatenate(parts, axis=-1).astype(ours.dtype, copy=False)

    def positions_back(self, theirs: Vectors) -> Vectors:
        """Convert positions `(..., 3)` of the engine to ours."""
        return np.asarray(theirs @ self._matrix(theirs).T / theirs.dtype.type(self.units_per_metre))

    def rotations_back(self, theirs: Quaternions) -> Quaternions:
        """Convert rotations `(..., 4)` in the engine's order to ours."""
        if self.scalar_last:
            scalar, vector = theirs[..., 3:], theirs[..., :3]
        else:
            scalar, vector = theirs[..., :1], theirs[..., 1:]
        vector = self.handedness * (vector @ self._matrix(theirs).T)
        return np.concatenate([scalar, vector], axis=-1).astype(theirs.dtype, copy=False)

    def skeleton(self, ours: Skeleton) -> Skeleton:
        """Convert a skeleton's offsets; names and parents stay."""
        return replace(ours, offsets=self.positions(ours.offsets))

    def skeleton_back(self, theirs: Skeleton) -> Skeleton:
        """Convert the offsets of an engine's skeleton, for instance for `output_skeleton`."""
        return replace(theirs, offsets=self.positions_back(theirs.offsets))

    def _matrix(self, like: Floats) -> Floats:
        """Return Mᵀ, which rows are multiplied by."""
        return np.array(self.axes, like.dtype).T


UNITY = CoordinateSystem("Unity", ((-1, 0, 0), (0, 1, 0), (0, 0, 1)))
UNREAL = CoordinateSystem("Unreal", ((0, 0, 1), (-1, 0, 0), (0, 1, 0)), units_per_metre=100.0)
GODOT = CoordinateSystem("Godot", ((-1, 0, 0), (0, 1, 0), (0, 0, -1)))
GLTF = CoordinateSystem("glTF", ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
BLENDER = CoordinateSystem("Blender", ((1, 0, 0), (0, 0, -1), (0, 1, 0)), scalar_last=False)

SYSTEMS = (UNITY, UNREAL, GODOT, GLTF, BLENDER)
"""All that are known."""
