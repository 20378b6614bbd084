"""Characters as they are added, changed and removed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from stridewire._messages.controls import GroundPose


@dataclass(frozen=True)
class CharacterSpec:
    """One character as it is added or changed."""

    id: int
    root: GroundPose = field(default_factory=GroundPose)
    height_m: float = 0.0
    stitcher: str = ""
    filter: str = ""
    weights: Mapping[str, float] = field(default_factory=dict)
    responsiveness: float | None = None
    foot_lock: bool = True
    rate_divider: int = 0


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
