"""Moments of a library: those asked about and those that fit."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class ClipTime:
    """A moment of a clip."""

    clip: str
    time_s: float
    library: str = ""
    """Name of the clip's library; empty means the default, or the one that is searched."""


@dataclass(frozen=True)
class DesiredMotion:
    """A desired velocity and heading, in the frame of the pose's root."""

    velocity_x: float = 0.0
    velocity_z: float = 0.0
    facing_yaw: float | None = None


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
