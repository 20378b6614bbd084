"""What travels between a client and a runtime, as plain dataclasses over numpy arrays.

The wire format (`proto/stridewire/v1`) says units, frames, orders and limits of every field; these
classes have its names and are what both transports exchange, so in process and over gRPC mean the
same. Field paths in errors are those of the wire.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from stridewire._errors import Violation
from stridewire.motion.array_types import Floats, Indices
from stridewire.motion.skeleton import Skeleton


class Pacing(IntEnum):
    """Who decides when a frame is made."""

    CLIENT = 1
    SERVER = 2


class PoseFormat(IntEnum):
    """How the blocks of a frame are written."""

    F32 = 1
    F16 = 2


class Detail(IntEnum):
    """What a frame tells beside poses."""

    NONE = 1
    EVENTS = 2
    COSTS = 3


class CorrectionMode(IntEnum):
    """How a root correction is taken."""

    ADJUST = 1
    TELEPORT = 2


class TransitionReason(IntEnum):
    """Why a transition was made."""

    BETTER_MATCH = 1
    CONTROL_CHANGE = 2
    CLIP_END = 3
    FORCED = 4
    START = 5
    FILTER_CHANGE = 6


class FrameFlag(IntEnum):
    """States of a character within a frame; the bit of a flag in `Frame.flags` is `1 << flag`."""

    DT_CLAMPED = 1
    DEGRADED = 2
    HELD = 3
    FALLBACK = 4
    TELEPORTED = 5


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
class CharacterSpec:
    """One character as it is added or changed."""

    id: int
    root: GroundPose = GroundPose()
    height_m: float = 0.0
    stitcher: str = ""
    filter: str = ""
    weights: Mapping[str, float] = field(default_factory=dict)
    responsiveness: float | None = None
    foot_lock: bool = True
    rate_divider: int = 0


@dataclass(frozen=True)
class Open:
    """Begins a session."""

    characters: Sequence[CharacterSpec]
    library: str = ""
    pacing: Pacing = Pacing.CLIENT
    rate_hz: float = 60.0
    output_skeleton: Skeleton | None = None
    format: PoseFormat = PoseFormat.F32
    max_frames_in_flight: int = 30
    detail: Detail = Detail.EVENTS
    seed: int = 0
    resume_token: str = ""


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


@dataclass(frozen=True)
class CharacterUpdate:
    """A change of one character: the fields of `spec` that `mask` names."""

    spec: CharacterSpec
    mask: tuple[str, ...]


@dataclass(frozen=True)
class Edit:
    """Adds, removes and changes characters; applied in the order remove, add, update."""

    add: Sequence[CharacterSpec] = ()
    remove: Sequence[int] = ()
    update: Sequence[CharacterUpdate] = ()


@dataclass(frozen=True)
class Close:
    """Ends a session."""


@dataclass(frozen=True)
class LibraryInfo:
    """A library in a few words."""

    name: str
    content_hash: str
    clips: int
    frames: int
    frame_rate_hz: float
    synthetic: bool
    licence: str
    credit: str
    schema: str


@dataclass(frozen=True)
class Limits:
    """Limits that hold for a session."""

    max_characters: int = 4096
    max_dt_s: float = 0.25
    max_speed: float = 20.0
    max_message_bytes: int = 1 << 20
    write_timeout_s: float = 2.0


@dataclass(frozen=True)
class Settings:
    """Settings that hold for a session."""

    pacing: Pacing
    rate_hz: float
    max_frames_in_flight: int
    format: PoseFormat
    detail: Detail
    seed: int
    default_stitcher: str


@dataclass(frozen=True)
class Opened:
    """Answers Open."""

    session: str
    skeleton: Skeleton
    library: LibraryInfo
    server_version: str
    settings: Settings
    limits: Limits
    models: Mapping[str, str] = field(default_factory=dict)
    resume_token: str = ""


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
    runners_up: tuple["Match", ...] = ()
    """The next best moments, best first."""
    excluded: tuple["ExcludedMatch", ...] = ()
    """Better moments that were not to be chosen, best first."""


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
    """`(N, 4)` x, y, z, yaw; only with `Detail.COSTS`."""
    events: Sequence[Event] = ()
    dropped: int = 0
    timings_ms: Mapping[str, float] = field(default_factory=dict)

    def flagged(self, flag: FrameFlag) -> Indices:
        """Return the ids of the characters that have a flag."""
        return np.asarray(self.characters[(self.flags >> np.uint32(flag)) & 1 == 1])


@dataclass(frozen=True)
class StreamError:
    """What was wrong with a message; the stream lives, the previous control holds."""

    step: int
    violations: tuple[Violation, ...]
    more: int = 0


@dataclass(frozen=True)
class Notice:
    """News about the session or the server."""

    kind: int
    message: str
    deadline_s: float = 0.0
    resume_token: str = ""


ClientMessage = Open | Step | Edit | Close
ServerMessage = Opened | Frame | StreamError | Notice


@dataclass(frozen=True)
class ClipTime:
    """A moment of a clip."""

    clip: str
    time_s: float


@dataclass(frozen=True)
class DesiredMotion:
    """A desired velocity and heading, in the frame of the pose's root."""

    velocity_x: float = 0.0
    velocity_z: float = 0.0
    facing_yaw: float | None = None


@dataclass(frozen=True)
class SearchQuery:
    """What is looked for: a moment to continue from and where to go."""

    pose: ClipTime
    intent: Trajectory | DesiredMotion | None = None
    """None means where the referenced clip itself goes."""
    k: int = 5
    library: str = ""
    exclude: Sequence[ClipTime] = ()
    filter: str = ""
    weights: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Match:
    """A moment of the library that fits."""

    clip: str
    time_s: float
    tags: tuple[str, ...]
    cost: float
    channels: Mapping[str, float]
    bias: float = 0.0
    """Share of the cost that the moment carries for its tags."""


@dataclass(frozen=True)
class ExcludedMatch:
    """A moment that fits but was not to be chosen."""

    match: Match
    reason: str


@dataclass(frozen=True)
class SearchResult:
    """The matches, best first."""

    matches: tuple[Match, ...]
    library: str
    content_hash: str
    excluded: tuple[ExcludedMatch, ...] = ()
    """Moments better than the last match that were excluded, best first."""
    exact: bool = True
    """Whether every row was looked at."""


@dataclass(frozen=True)
class ServerInfo:
    """About the server or the runtime in this process."""

    version: str
    libraries: tuple[LibraryInfo, ...]
    models: Mapping[str, str]
    limits: Limits
    stitchers: tuple[str, ...]
    sessions: int
    characters: int
