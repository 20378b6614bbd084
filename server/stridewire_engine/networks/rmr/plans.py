"""Plans: windows of motion around seams, as a plain stitcher shows them and as the clips are.

All arrays are over N plans of T frames at 60 frames/s, in the world, metres and radians, the ground
at y = 0. Feet are left, right.
"""

from dataclasses import dataclass, fields

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors

FRAME_RATE = 60.0
TOKEN = 4
"""Frames that the network reads at once; T is a multiple of it."""
WINDOW = 60
"""Frames of the plans that the network is trained on."""


@dataclass(frozen=True)
class Plans:
    """What the network is told of N plans.

    A seam is the first frame of a clip that follows another one. Each plan has one after its first
    frame at least.
    """

    root: Vectors
    """`(N, T, 3)` the root that is shown."""
    yaw: Floats
    """`(N, T)` its heading."""
    hips: Vectors
    """`(N, T, 3)` hips with springs over the seams."""
    toes: Vectors
    """`(N, T, 2, 3)` toes with springs over the seams; before the first one, as they were shown."""
    ankles: Vectors
    """`(N, T, 2, 3)` ankles, alike."""
    clip_toes: Vectors
    """`(N, T, 2, 3)` toes of the clips' own poses under the root that is shown."""
    contacts: Flags
    """`(N, T, 2)` whether the clips have the toes planted."""
    seam: Indices
    """`(N, T)` frame of the last seam, or of the first one before it."""
    imposed: Flags
    """`(N,)` whether the root's path was given from elsewhere; else it is the clips' own."""

    def __len__(self) -> int:
        return len(self.root)

    def __getitem__(self, index: Indices | slice) -> "Plans":
        """Take some of the plans."""
        return Plans(*(getattr(self, field.name)[index] for field in fields(self)))

    @property
    def frames(self) -> int:
        """T."""
        return int(self.root.shape[1])

    @property
    def first_seam(self) -> Indices:
        """`(N,)` frame of each plan's first seam."""
        return self.seam[:, 0]

    @property
    def since_first(self) -> Indices:
        """`(N, T)` frames since the first seam, negative before it."""
        return np.arange(self.frames) - self.first_seam[:, None]

    @property
    def since_last(self) -> Indices:
        """`(N, T)` frames since the last seam, negative before the first."""
        return np.arange(self.frames) - self.seam


def seams_of(starts: Flags) -> Indices:
    """Return `Plans.seam` from flags `(N, T)` that are true at the seams.

    Raises:
        ValueError: If a plan has no seam after its first frame.
    """
    starts = starts.copy()
    starts[:, 0] = False
    if not starts.any(axis=1).all():
        raise ValueError("a plan has no seam after its first frame; give it as it is")
    frames = np.arange(starts.shape[1])
    last = np.maximum.accumulate(np.where(starts, frames, 0), axis=1)
    return np.asarray(np.where(last > 0, last, starts.argmax(axis=1)[:, None]))
