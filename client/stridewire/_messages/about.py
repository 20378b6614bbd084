"""What a library and a server are."""

from collections.abc import Mapping
from dataclasses import dataclass


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
class ServerInfo:
    """About the server or the runtime in this process."""

    version: str
    libraries: tuple[LibraryInfo, ...]
    models: Mapping[str, str]
    limits: Limits
    stitchers: tuple[str, ...]
    sessions: int
    characters: int
