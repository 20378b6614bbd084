"""The plan: clips laid end to end, seams and all. It is what a stitcher works on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.stitchers.legs import LegPose, Legs, leg_pose


@dataclass(frozen=True)
class Plan:
    """T frames of several clips under one root path."""

    skeleton: Skeleton
    frame_rate: float
    """Frames per second."""
    root_position: Vectors
    """`(T, 3)` in the world, float64."""
    root_yaw: Floats
    """`(T,)` radians, float64, without jumps of a whole turn."""
    hips: Vectors
    """`(T, 3)` relative to the root: the clips' own."""
    rotations: Quaternions
    """`(T, J, 4)` local: the clips' own."""
    contacts: Flags
    """`(T, 2)` whether the left and the right toe are planted, by the clips."""
    seams: Indices
    """First frame of each clip but the first."""
    imposed: bool = False
    """Whether the root path is a caller's and not the clips'."""

    def __len__(self) -> int:
        return len(self.hips)

    @cached_property
    def legs(self) -> Legs:
        """Of the skeleton."""
        return Legs.of(self.skeleton)

    @cached_property
    def leg_pose(self) -> LegPose:
        """Legs in every frame, in the root's frame."""
        return leg_pose(self.legs, self.hips, self.rotations)

    def pose(self, frames: slice) -> Pose:
        """Return poses as they stand in the plan, float32."""
        return Pose(
            self.root_position[frames].astype(np.float32),
            quaternion.from_yaw(self.root_yaw[frames]).astype(np.float32),
            self.hips[frames],
            self.rotations[frames],
        )
