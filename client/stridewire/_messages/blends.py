"""Blends: postures between two postures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

from stridewire._messages.matches import ClipTime
from stridewire._messages.queries import Query
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Pose


class BlendMethod(IntEnum):
    """How a posture is blended; values are the wire's."""

    NEURAL = 1
    """By the network, but for pairs too unlike what it was trained on."""
    SLERP = 2
    """Each joint at constant speed on the short side, hips and root straight."""
    AUTO = 3
    """By the network where it is sure, else as `SLERP`."""


@dataclass(frozen=True)
class BlendResult:
    """The postures between."""

    pose: Pose
    """`(W, …)` float32, one for each weight."""
    method: BlendMethod
    """`NEURAL` or `SLERP`: which one made them."""
    reason: str = ""
    """Why, where it is not the one asked for."""


@dataclass(frozen=True)
class BlendQuery(Query[BlendResult]):
    """Which postures lie between these two?"""

    start: ClipTime | Pose
    """At weight 0: a moment of a library, or one pose (no leading shape)."""
    end: ClipTime | Pose
    """At weight 1; a moment of another clip than the start's is moved to the start's root."""
    weights: Sequence[float] | Floats
    """1 to 10,000, each from 0 to 1."""
    method: BlendMethod = BlendMethod.AUTO
    joint_mask: Mapping[str, float] = field(default_factory=dict)
    """Share of the weight that joints take, 0 to 1; the hips' also moves the root; else 1."""
    ground_height: float = 0.0
    """Metres."""
    duration_s: float = 0.0
    """Seconds between the postures; 0 means what their clip says, else unknown."""


@dataclass(frozen=True)
class BlendManyQuery(Query[tuple[BlendResult, ...]]):
    """Which postures lie between these pairs?"""

    requests: Sequence[BlendQuery]
    """1 to 1,000 pairs with 10,000 weights in all."""
