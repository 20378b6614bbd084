"""Frames: the poses of one tick, and what happened in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from stridewire._messages.matches import ExcludedMatch, Match
from stridewire.motion.array_types import Floats, Indices


class PoseFormat(IntEnum):
    """How the blocks of a frame are written."""

    F32 = 1
    F16 = 2


class TransitionReason(IntEnum):
    """Why a transition was made."""

    BETTER_MATCH = 1
    CONTROL_CHANGE = 2
    CLIP_END = 3
    FORCED = 4
    START = 5
    FILTER_CHANGE = 6


class FallbackReason(IntEnum):
    """Why a transition that `refine` should hide is hidden by `stance`."""

    NO_NETWORK = 1
    OTHER_SKELETON = 2
    OTHER_RATE = 3
    TOO_FEW_FRAMES = 4
    BUSY = 5
    UNLIKE_TRAINING = 6


class FrameFlag(IntEnum):
    """States of a character within a frame; the bit of a flag in `Frame.flags` is `1 << flag`."""

    DT_CLAMPED = 1
    DEGRADED = 2
    HELD = 3
    FALLBACK = 4
    TELEPORTED = 5


@dataclass(frozen=True)
class Transition:
    """A jump from one moment of the library to another."""

    character: int
    frame: int
    from_clip: str
    """Empty where the character begins."""
    from_time_s: float
    to_clip: str
    to_time_s: float
    reason: TransitionReason
    cost: float = 0.0
    stay_cost: float = 0.0
    channels: Mapping[str, float] = field(default_factory=dict)
    bias: float = 0.0
    """By how much the cost of staying had to be beaten."""
    runners_up: tuple[Match, ...] = ()
    """The next best moments, best first."""
    excluded: tuple[ExcludedMatch, ...] = ()
    """Better moments that were not to be chosen, best first."""
    fallback: FallbackReason | None = None
    """Why `stance` hides it, where `refine` was asked for."""
    refined_frames: int = 0
    """For how many frames a network guided the feet after the character's transition before."""


@dataclass(frozen=True)
class ContactChange:
    """A joint that was planted or lifted."""

    character: int
    frame: int
    joint: int
    planted: bool


@dataclass(frozen=True)
class ClipEnd:
    """The end of the clip that was playing."""

    character: int
    frame: int
    clip: str


@dataclass(frozen=True)
class TagEntered:
    """The begin of a tagged span."""

    character: int
    frame: int
    tag: str


Event = Transition | ContactChange | ClipEnd | TagEntered


@dataclass(frozen=True)
class Inside:
    """What the runtime works with behind a frame; arrays are float32 and read-only views."""

    ahead_s: Floats
    """`(K,)` seconds from now, ascending."""
    predicted: Floats
    """`(N, K, 3)` x, z, yaw in the world: where the control's springs lead the simulated root."""
    captured: Floats
    """`(N, K, 3)` x, z, yaw in the world: where the clip that plays would lead the root."""
    hips: Floats
    """`(N, 3)` of the clip that plays, before stitching, on the library's skeleton."""
    rotations: Floats
    """`(N, J, 4)` of the same."""


@dataclass(frozen=True)
class Frame:
    """The poses of one tick; arrays are float32 and read-only views."""

    frame: int
    applied_step: int
    time_s: float
    client_time_s: float
    characters: Indices
    """`(N,)` uint32 ids in the order of adding."""
    root: Floats
    """`(N, 7)` x, y, z, quaternion w, x, y, z in the world."""
    root_delta: Floats
    """`(N, 4)` x, y, z, yaw in the root's frame before."""
    hips: Floats
    """`(N, 3)` relative to the root."""
    rotations: Floats
    """`(N, J, 4)` local rotations."""
    contacts: Indices
    """`(N,)` uint32 masks."""
    foot_targets: Floats
    """`(N, 2, 3)` world; NaN where a foot is not locked."""
    flags: Indices
    """`(N,)` uint32 masks of `1 << FrameFlag`."""
    simulated_root: Floats | None = None
    """`(N, 4)` x, y, z, yaw; only from `Detail.COSTS` on."""
    inside: Inside | None = None
    """Only with `Detail.INSIDE`."""
    events: Sequence[Event] = ()
    dropped: int = 0
    searches: int = 0
    """Characters that searched in this tick."""
    timings_ms: Mapping[str, float] = field(default_factory=dict)
    format: PoseFormat = PoseFormat.F32
    """How the frame travels; arrays are float32 all the same."""

    def flagged(self, flag: FrameFlag) -> Indices:
        """Return the ids of the characters that have a flag."""
        return np.asarray(self.characters[(self.flags >> np.uint32(flag)) & 1 == 1])
