"""The begin and the end of a session, and what a server says within it beside frames."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

from stridewire._errors import Violation
from stridewire._messages.about import LibraryInfo, Limits
from stridewire._messages.characters import CharacterSpec, Edit
from stridewire._messages.controls import Step
from stridewire._messages.frames import Frame, PoseFormat
from stridewire.motion.skeleton import Skeleton


class Pacing(IntEnum):
    """Who decides when a frame is made."""

    CLIENT = 1
    SERVER = 2


class Detail(IntEnum):
    """What a frame tells beside poses."""

    NONE = 1
    EVENTS = 2
    COSTS = 3
    INSIDE = 4


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
class Close:
    """Ends a session."""


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
