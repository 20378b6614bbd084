"""What a character is asked to do: steps and rarer controls."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from stridewire.motion.array_types import Floats, Indices


class CorrectionMode(IntEnum):
    """How a root correction is taken."""

    ADJUST = 1
    TELEPORT = 2


@dataclass(frozen=True)
class GroundPose:
    """A place on the ground and a heading, in the world."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    yaw: float = 0.0


@dataclass(frozen=True)
class Trajectory:
    """Where to go, as points in time."""

    positions_xz: Floats
    """`(K, 2)` metres."""
    times_s: Floats
    """`(K,)` seconds from now, ascending."""
    facings_yaw: Floats | None = None
    """`(K,)` radians, or None for along the path."""


@dataclass(frozen=True)
class RootCorrection:
    """A new place for a character's root."""

    root: GroundPose
    mode: CorrectionMode = CorrectionMode.ADJUST


@dataclass(frozen=True)
class Ground:
    """The ground under a character."""

    height: float = 0.0
    normal: tuple[float, float, float] = (0.0, 1.0, 0.0)
    foot_heights: Floats | None = None
    foot_normals: Floats | None = None


@dataclass(frozen=True)
class Sparse:
    """Rarer controls of one character."""

    character: int
    trajectory: Trajectory | None = None
    filter: str | None = None
    gait: str | None = None
    root_correction: RootCorrection | None = None
    ground: Ground | None = None
    force_search: bool = False


@dataclass(frozen=True)
class Step:
    """Advances a session, or with server pacing replaces its controls."""

    step: int = 0
    dt_s: float = 1.0 / 60.0
    last_frame: int = 0
    client_time_s: float = 0.0
    characters: Indices | None = None
    """`(N,)` ids; None or empty means all, in the order of adding."""
    velocity_xz: Floats | None = None
    """`(N, 2)` m/s in the world; None means no change."""
    facing_yaw: Floats | None = None
    """`(N,)` radians; NaN means along the velocity; None means no change."""
    sparse: Sequence[Sparse] = ()
    ack_only: bool = False
