"""Feature schemas as data: which numbers describe a moment, and how much each counts.

A cost is the sum over channels of `weight * |q - x|^2` over normalised features: **cost is
proportional to the weight**, dimensions are not divided out. Each channel has one deviation, the
mean of those of its dimensions (Holden): a deviation for every dimension would inflate nearly
constant ones into noise.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
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
    TRAJECTORY_POSITION = "trajectory-position"
    """Root in the future: x, z a time; m."""
    TRAJECTORY_DIRECTION = "trajectory-direction"
    """Root's forward axis in the future: x, z a time; unitless."""


_TRAJECTORY = {ChannelKind.TRAJECTORY_POSITION, ChannelKind.TRAJECTORY_DIRECTION}


@dataclass(frozen=True)
class Channel:
    """One group of features with a common unit, deviation and weight."""

    name: str
    kind: ChannelKind
    weight: float
    joints: tuple[str, ...] = ()
    """Joints measured; for positions and velocities."""
    times: tuple[float, ...] = ()
    """Seconds ahead; for trajectories."""

    @property
    def dimensions(self) -> int:
        """Number of features."""
        return 2 * len(self.times) if self.kind in _TRAJECTORY else 3 * len(self.joints)

    @property
    def is_trajectory(self) -> bool:
        """Whether the channel describes where the root goes, not what the pose is."""
        return self.kind in _TRAJECTORY


@dataclass(frozen=True)
class Schema:
    """Channels in order; features lie in the same order."""

    name: str
    channels: tuple[Channel, ...]

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
        """All times ahead at which the root is asked for, ascending."""
        return tuple(sorted({time for channel in self.channels for time in channel.times}))

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
            LibraryError: If it is not understood.
        """
        try:
            channels = tuple(
                Channel(
                    channel["name"],
                    ChannelKind(channel["kind"]),
                    float(channel["weight"]),
                    tuple(channel["joints"]),
                    tuple(channel["times"]),
                )
                for channel in data["channels"]
            )
            return cls(str(data["name"]), channels)
        except (KeyError, TypeError, ValueError) as error:
            raise LibraryError(f"the feature schema is not understood: {error}") from error


_TIMES = (20 / 60, 40 / 60, 60 / 60)
_FEET = ("LeftFoot", "RightFoot")

LOCOMOTION = Schema(
    "locomotion",
    (
        Channel("foot-position", ChannelKind.POSITION, 0.5625, joints=_FEET),
        Channel("foot-velocity", ChannelKind.VELOCITY, 1.0, joints=_FEET),
        Channel("hips-velocity", ChannelKind.VELOCITY, 1.0, joints=("Hips",)),
        Channel("trajectory-position", ChannelKind.TRAJECTORY_POSITION, 1.0, times=_TIMES),
        Channel("trajectory-direction", ChannelKind.TRAJECTORY_DIRECTION, 2.25, times=_TIMES),
    ),
)
"""The classic 27 features of Holden's *Motion-Matching*, its weights squared since cost is
proportional to w."""
