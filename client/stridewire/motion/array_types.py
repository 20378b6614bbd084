"""Names for the arrays that the whole package passes around."""

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.floating[Any]]
"""Floating-point array; float32 in the tick, float64 in building and evaluation."""

Quaternions: TypeAlias = Floats
"""`(..., 4)` unit quaternions in the order w, x, y, z."""

Vectors: TypeAlias = Floats
"""`(..., 3)` positions, offsets or velocities; metres, Y up, +Z forward."""

Flags: TypeAlias = npt.NDArray[np.bool_]
"""Boolean array."""

Indices: TypeAlias = npt.NDArray[np.integer[Any]]
"""Integer array."""
