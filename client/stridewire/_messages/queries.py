"""Unary queries and their answers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from stridewire._messages.controls import Trajectory
from stridewire._messages.matches import ClipTime, DesiredMotion, ExcludedMatch, Match


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
class SearchResult:
    """The matches, best first."""

    matches: tuple[Match, ...]
    library: str
    content_hash: str
    excluded: tuple[ExcludedMatch, ...] = ()
    """Moments better than the last match that were excluded, best first."""
    exact: bool = True
    """Whether every row was looked at."""
