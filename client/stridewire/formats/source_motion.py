"""What a motion file says before anything is converted: its own skeleton, units and axes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton


class FormatError(ValueError):
    """A file cannot be read; the message names the file, the line and what to do."""

    def __init__(self, path: Path | str, problem: str, line: int | None = None) -> None:
        where = f"{path}, line {line}" if line else f"{path}"
        super().__init__(f"{where}: {problem}")


@dataclass(frozen=True)
class SourceMotion:
    """Motion as it lies in a file."""

    path: Path
    skeleton: Skeleton
    """Offsets in file units; many files repeat the root's first position in the first."""
    tips: Mapping[int, Vectors]
    """Offsets of end sites by the index of their joint; file units."""
    frame_rate: float | None
    """Frames per second; None where the file does not say."""
    root_positions: Vectors
    """`(T, 3)` first joint in the world, file units."""
    rotations: Quaternions
    """`(T, J, 4)` local rotations, the first joint's in the world."""
    translations: Vectors | None = None
    """`(T, J, 3)` offsets from the parents by frame, file units; None where the skeleton's hold."""
    metres_per_unit: float | None = None
    """None where the file does not say."""
    notes: tuple[str, ...] = ()
    """What was odd about the file and how it was read."""

    def __len__(self) -> int:
        return len(self.rotations)

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.path.stem

    def after(self, frames: int) -> "SourceMotion":
        """Return the same motion without its first frames."""
        moving = self.translations
        return replace(
            self,
            root_positions=self.root_positions[frames:],
            rotations=self.rotations[frames:],
            translations=None if moving is None else moving[frames:],
        )

    def global_poses(self) -> tuple[Vectors, Quaternions]:
        """Return positions `(T, J, 3)` in file units and rotations `(T, J, 4)` in the world."""
        offsets = self.skeleton.offsets if self.translations is None else self.translations
        positions = np.empty((*self.rotations.shape[:-1], 3))
        turned = np.empty_like(self.rotations)
        positions[:, 0], turned[:, 0] = self.root_positions, self.rotations[:, 0]
        for joints, parents in self.skeleton.levels:
            turned[:, joints] = quaternion.multiply(turned[:, parents], self.rotations[:, joints])
            step = np.broadcast_to(offsets[..., joints, :], (len(self), len(joints), 3))
            positions[:, joints] = positions[:, parents] + quaternion.rotate(
                turned[:, parents], step
            )
        return positions, turned
