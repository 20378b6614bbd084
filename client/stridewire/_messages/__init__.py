"""What travels between a client and a runtime, as plain dataclasses over numpy arrays.

The wire format (`proto/stridewire/v1`) says units, frames, orders and limits of every field; these
classes have its names and are what both transports exchange, so in process and over gRPC mean the
same. Field paths in errors are those of the wire.
"""

from stridewire._messages.about import LibraryInfo, Limits, ServerInfo
from stridewire._messages.characters import CharacterSpec, CharacterUpdate, Edit
from stridewire._messages.controls import (
    CorrectionMode,
    Ground,
    GroundPose,
    RootCorrection,
    Sparse,
    Step,
    Trajectory,
)
from stridewire._messages.frames import (
    ClipEnd,
    ContactChange,
    Event,
    Frame,
    FrameFlag,
    TagEntered,
    Transition,
    TransitionReason,
)
from stridewire._messages.matches import ClipTime, DesiredMotion, ExcludedMatch, Match
from stridewire._messages.queries import SearchQuery, SearchResult
from stridewire._messages.session import (
    ClientMessage,
    Close,
    Detail,
    Notice,
    Open,
    Opened,
    Pacing,
    PoseFormat,
    ServerMessage,
    Settings,
    StreamError,
)

__all__ = [
    "CharacterSpec",
    "CharacterUpdate",
    "ClientMessage",
    "ClipEnd",
    "ClipTime",
    "Close",
    "ContactChange",
    "CorrectionMode",
    "DesiredMotion",
    "Detail",
    "Edit",
    "Event",
    "ExcludedMatch",
    "Frame",
    "FrameFlag",
    "Ground",
    "GroundPose",
    "LibraryInfo",
    "Limits",
    "Match",
    "Notice",
    "Open",
    "Opened",
    "Pacing",
    "PoseFormat",
    "RootCorrection",
    "SearchQuery",
    "SearchResult",
    "ServerInfo",
    "ServerMessage",
    "Settings",
    "Sparse",
    "Step",
    "StreamError",
    "TagEntered",
    "Trajectory",
    "Transition",
    "TransitionReason",
]
