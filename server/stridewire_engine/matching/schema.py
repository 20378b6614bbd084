"""Feature schemas as data: which numbers describe a moment, and how much each counts.

A cost is the sum over channels of `weight * |q - x|^2` over normalised features: **cost is
proportional to the weight**, dimensions are not divided out. Each channel has one deviation, the
mean of those of its dimensions (Holden): a deviation for every dimension would inflate nearly
constant ones into noise.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from enum import StrEnum
from functools import cached_property
from typing import Any

import numpy as np

from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.library import LibraryError


class ChannelKind(StrEnum):
    """What a channel measures, always in the root's frame."""

    POSITION = "position"
    """Joints relative to the root: x, y, z a joint; m."""
    VELOCITY = "velocity"
    """World velocity of joints, turned into the root's frame: x, y, z a joint; m/s."""
    HEADING = "heading"
    """Forward axis of joints on the ground: x, z a joint; unitless."""
    HEIGHT = "height"
    """Joints above the ground: y a joint; m."""
    CUSTOM = "custom"
    """Numbers that the builder of the library supplies."""
    TRAJECTORY_POSITION = "trajectory-position"
    """Root in the future or past: x, z a time; m."""
    TRAJECTORY_DIRECTION = "trajectory-direction"
    """Root's forward axis in the future or past: x, z a time; unitless."""


_DIMENSIONS_A_JOINT = {
    ChannelKind.POSITION: 3,
    ChannelKind.VELOCITY: 3,
    ChannelKind.HEADING: 2,
    ChannelKind.HEIGHT: 1,
}
_TRAJECTORY = {ChannelKind.TRAJECTORY_POSITION, ChannelKind.TRAJECTORY_DIRECTION}


MAX_TIME = 5.0
"""Furthest that a trajectory looks ahead or back; seconds."""


class SchemaError(LibraryError):
    """A feature schema is malformed; the message names the channel and the fix."""


@dataclass(frozen=True)
class Channel:
    """One group of features with a common unit, deviation and weight."""

    name: str
    kind: ChannelKind
    weight: float
    joints: tuple[str, ...] = ()
    """Joints measured; for positions, velocities, headings and heights."""
    times: tuple[float, ...] = ()
    """Seconds ahead, negative ones back; for trajectories."""
    size: int = 0
    """Number of features; for custom ones."""

    def __post_init__(self) -> None:
        wanted = "times" if self.is_trajectory else "joints"
        if self.kind is ChannelKind.CUSTOM:
            wanted = "size"
        if not getattr(self, wanted):
            raise SchemaError(f"channel {self.name!r} of kind {self.kind} needs {wanted}")
        if not (math.isfinite(self.weight) and self.weight >= 0.0):
            raise SchemaError(
                f"channel {self.name!r} has weight {self.weight}; allowed are finite numbers from 0"
            )
        if 0.0 in self.times or not all(abs(time) <= MAX_TIME for time in self.times):
            raise SchemaError(
                f"channel {self.name!r} has times {self.times}; allowed are seconds up to "
                f"{MAX_TIME:g} ahead or back, but not 0"
            )

    @property
    def dimensions(self) -> int:
        """Number of features."""
        if self.kind is ChannelKind.CUSTOM:
            return self.size
        return 2 * len(self.times) or _DIMENSIONS_A_JOINT[self.kind] * len(self.joints)

    @property
    def is_trajectory(self) -> bool:
        """Whether the channel describes the root's way, not what the pose is."""
        return self.kind in _TRAJECTORY


@dataclass(frozen=True)
class Schema:
    """Channels in order; features lie in the same order."""

    name: str
    channels: tuple[Channel, ...]

    def __post_init__(self) -> None:
        names = [channel.name for channel in self.channels]
        twice = [name for name in names if names.count(name) > 1]
        if twice or not names:
            what = f"two channels are called {twice[0]!r}" if twice else "there is no channel"
            raise SchemaError(f"feature schema {self.name!r}: {what}")
        if not self.weights.any():
            raise SchemaError(f"feature schema {self.name!r}: all weights are 0")

    @cached_property
    def dimensions(self) -> int:
        """Number of features of a moment."""
        return sum(channel.dimensions for channel in self.channels)

    @cached_property
    def starts(self) -> Indices:
        """`(C,)` index of each channel's first feature."""
        return np.cumsum([0, *(channel.dimensions for channel in self.channels[:-1])])

    @cached_property
    def channel_of(self) -> Indices:
        """`(D,)` index of the channel of each feature."""
        return np.repeat(np.arange(len(self.channels)), [c.dimensions for c in self.channels])

    @cached_property
    def weights(self) -> Floats:
        """`(C,)` float64 weight of each channel."""
        return np.array([channel.weight for channel in self.channels])

    @cached_property
    def horizon(self) -> float:
        """Seconds ahead that the features know."""
        return max((time for channel in self.channels for time in channel.times), default=0.0)

    @cached_property
    def trajectory_times(self) -> tuple[float, ...]:
        """All times ahead at which the root is asked for, ascending; none back."""
        times = {time for channel in self.channels for time in channel.times}
        return tuple(sorted(time for time in times if time > 0.0))

    def slice(self, channel: Channel) -> slice:
        """Return where a channel's features lie."""
        start = int(self.starts[self.channels.index(channel)])
        return slice(start, start + channel.dimensions)

    def to_data(self) -> dict[str, Any]:
        """Return the schema as plain data."""
        return {"name": self.name, "channels": [asdict(channel) for channel in self.channels]}

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> "Schema":
        """Read a schema back from plain data.

        Raises:
            SchemaError: If it is not understood.
        """
        try:
            channels = tuple(_channel(entry) for entry in data["channels"])
            return cls(str(data["name"]), channels)
        except KeyError as error:
            raise SchemaError(f"the feature schema lacks {error}") from error
        except TypeError as error:
            raise SchemaError(f"the feature schema is not understood: {error}") from error


def _channel(entry: Mapping[str, Any]) -> Channel:
    kinds = [kind.value for kind in ChannelKind]
    if entry["kind"] not in kinds:
        raise SchemaError(
            f"channel {entry['name']!r} has kind {entry['kind']!r}; kinds: {', '.join(kinds)}"
        )
    unknown = set(entry) - {field.name for field in fields(Channel)}
    if unknown:
        raise SchemaError(f"channel {entry['name']!r} has unknown {', '.join(sorted(unknown))}")
    return Channel(
        str(entry["name"]),
        ChannelKind(entry["kind"]),
        float(entry.get("weight", 1.0)),
        tuple(entry.get("joints", ())),
        tuple(float(time) for time in entry.get("times", ())),
        int(entry.get("size", 0)),
    )
