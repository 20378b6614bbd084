"""Postures in the frame of a pair: what the network sees, wherever in the world a pair stands.

The frame lies under the hips of the start, at the height of the ground, and looks where these hips
look (Gaisbauer et al. 2019, section 3.2). It depends on the posture alone, not on where a caller
puts the root.
"""

from dataclasses import dataclass
from typing import Any

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE


@dataclass(frozen=True)
class Postures:
    """Postures of any leading shape `(...)` on the reference skeleton, J joints."""

    hips: Vectors
    """`(..., 3)` position of the hips, metres."""
    rotations: Quaternions
    """`(..., J, 4)` local rotations; the hips' in the frame that the positions are in."""

    def __getitem__(self, index: Any) -> "Postures":
        """Index the leading shape."""
        return Postures(self.hips[index], self.rotations[index])

    def joints(self) -> Vectors:
        """Return where the joints are `(..., J, 3)`."""
        return kinematics.forward(REFERENCE, self.hips, self.rotations)[0]

    @staticmethod
    def of(pose: Pose) -> "Postures":
        """Return poses in the world."""
        hips, turn = pose.world_hips
        rotations = pose.rotations.copy()
        rotations[..., 0, :] = turn
        return Postures(hips, rotations)


@dataclass(frozen=True)
class PairFrame:
    """Frames `(N,)` of pairs, in the world."""

    origin: Vectors
    """`(N, 3)` on the ground under the start's hips, metres."""
    turn: Quaternions
    """`(N, 4)` heading of the start's hips."""

    def __getitem__(self, index: Any) -> "PairFrame":
        """Take some of the frames, or one several times."""
        return PairFrame(self.origin[index], self.turn[index])

    @staticmethod
    def of(start: Postures, ground: Floats) -> "PairFrame":
        """Return the frames of pairs that begin with postures `(N,)` in the world.

        Args:
            start: Postures at weight 0.
            ground: `(N,)` height of the ground, metres.
        """
        origin = start.hips.copy()
        origin[:, 1] = ground
        return PairFrame(origin, quaternion.from_yaw(quaternion.to_yaw(start.rotations[:, 0])))

    def enter(self, postures: Postures) -> Postures:
        """Take postures `(N, ...)` in the world into the frames."""
        back = quaternion.conjugate(self._turn(postures))
        rotations = postures.rotations.copy()
        rotations[..., 0, :] = quaternion.multiply(back, rotations[..., 0, :])
        return Postures(quaternion.rotate(back, postures.hips - self._origin(postures)), rotations)

    def leave(self, postures: Postures) -> Postures:
        """Take postures `(N, ...)` out into the world: `enter` undone."""
        turn = self._turn(postures)
        rotations = postures.rotations.copy()
        rotations[..., 0, :] = quaternion.multiply(turn, rotations[..., 0, :])
        return Postures(quaternion.rotate(turn, postures.hips) + self._origin(postures), rotations)

    def _turn(self, postures: Postures) -> Quaternions:
        return self.turn.reshape(len(self.turn), *(1,) * (postures.hips.ndim - 2), 4)

    def _origin(self, postures: Postures) -> Vectors:
        return self.origin.reshape(len(self.origin), *(1,) * (postures.hips.ndim - 2), 3)
