"""The interface of stitchers and the arrays that they keep for each character."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from stridewire.motion.array_types import Floats, Indices, Quaternions, Vectors


class Motion(NamedTuple):
    """Poses relative to the root and how they change, for N characters."""

    hips: Vectors
    """`(N, 3)` metres."""
    rotations: Quaternions
    """`(N, J, 4)` local."""
    hips_velocity: Vectors
    """`(N, 3)` m/s."""
    angular_velocity: Vectors
    """`(N, J, 3)` rad/s in the parent's space."""

    def take(self, rows: Indices) -> "Motion":
        """Return some characters' motion."""
        return Motion(*(array[rows] for array in self))


@dataclass
class StitchState:
    """What is added to the sampled pose, for N characters; plain arrays, changed in place."""

    hips: Vectors
    """`(N, 3)` offset of the hips, metres."""
    hips_velocity: Vectors
    """`(N, 3)` its rate of change."""
    rotations: Vectors
    """`(N, J, 3)` offsets as scaled axes, turned after the sampled rotation, radians."""
    angular_velocity: Vectors
    """`(N, J, 3)` rate of change of the scaled axes, rad/s."""

    def take(self, rows: slice | Indices) -> "StitchState":
        """Return the rows: a view for a slice, a copy for indices."""
        return StitchState(
            self.hips[rows],
            self.hips_velocity[rows],
            self.rotations[rows],
            self.angular_velocity[rows],
        )

    def put(self, rows: slice | Indices, part: "StitchState") -> None:
        """Write rows back."""
        self.hips[rows] = part.hips
        self.hips_velocity[rows] = part.hips_velocity
        self.rotations[rows] = part.rotations
        self.angular_velocity[rows] = part.angular_velocity


class Stitcher(Protocol):
    """Hides transitions."""

    name: str
    """Name on the wire."""
    settled_s: float
    """So long after a transition, what is shown is the clip again, as good as."""
    keeps_root_velocity: bool
    """Whether the root's velocity, too, goes over without a step."""

    def begin(self, state: StitchState, source: Motion, target: Motion) -> None:
        """Take over at a jump, for characters that all jump now.

        Args:
            state: What was added to the source; changed in place to what is to be added to the
                target.
            source: The clip that was playing, at the moment of the jump.
            target: The clip that comes, at its own moment.
        """

    def apply(
        self, state: StitchState, hips: Vectors, rotations: Quaternions, dt: Floats
    ) -> tuple[Vectors, Quaternions]:
        """Advance by `dt` `(N,)` and return the shown hips `(N, 3)` and rotations `(N, J, 4)`."""
