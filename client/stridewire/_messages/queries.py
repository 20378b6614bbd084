"""Unary queries; each knows the type of its answer."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

from stridewire._messages.about import LibraryInfo, ServerInfo
from stridewire._messages.controls import Trajectory
from stridewire._messages.matches import ClipTime, DesiredMotion, ExcludedMatch, Match
from stridewire.motion.array_types import Indices
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton

AnswerT = TypeVar("AnswerT")
PartT = TypeVar("PartT")


class Query(Generic[AnswerT]):
    """A question that a runtime answers with one object of a type."""


class PartsQuery(Generic[PartT]):
    """A question that a runtime answers with parts of a type, one after the other."""


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
class SearchQuery(Query[SearchResult]):
    """What is looked for: a moment to continue from and where to go."""

    pose: ClipTime | Pose
    """A moment of the library, or one pose (no leading shape) on its skeleton. A pose stands still:
    neither velocities nor the way before it are compared."""
    intent: Trajectory | DesiredMotion | None = None
    """None means where the referenced clip itself goes; with a pose, that no way is compared."""
    k: int = 5
    library: str = ""
    exclude: Sequence[ClipTime] = ()
    filter: str = ""
    weights: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class InfoQuery(Query[ServerInfo]):
    """What is this server?"""


@dataclass(frozen=True)
class LibrariesQuery(Query[tuple[LibraryInfo, ...]]):
    """Which libraries are open? The default comes first."""


@dataclass(frozen=True)
class LibraryDetails:
    """What a library holds."""

    info: LibraryInfo
    seconds_by_tag: Mapping[str, float]


@dataclass(frozen=True)
class LibraryQuery(Query[LibraryDetails]):
    """What does a library hold?"""

    name: str = ""


@dataclass(frozen=True)
class TagTime:
    """A named span of a clip; seconds."""

    name: str
    start_s: float
    end_s: float


@dataclass(frozen=True)
class ClipInfo:
    """A clip in a few words."""

    name: str
    seconds: float
    frames: int
    source: str
    tags: tuple[TagTime, ...]


@dataclass(frozen=True)
class ClipPage:
    """Clips, one page."""

    clips: tuple[ClipInfo, ...]
    next_page_token: str
    """Empty on the last page."""
    total: int
    """Clips on all pages."""


@dataclass(frozen=True)
class ClipsQuery(Query[ClipPage]):
    """Which clips has a library?"""

    library: str = ""
    page_size: int = 0
    """0 means 100."""
    page_token: str = ""
    """Empty means the first page."""
    name_contains: str = ""
    tag: str = ""

    def after(self, page: ClipPage) -> "ClipsQuery":
        """Return the question for the page after one."""
        return replace(self, page_token=page.next_page_token)


@dataclass(frozen=True)
class ClipPoses:
    """Poses of a clip."""

    clip: ClipInfo
    frame_rate_hz: float
    pose: Pose
    """`(T, …)` float32."""
    contacts: Indices
    """`(T,)` masks as in `Frame.contacts`."""


@dataclass(frozen=True)
class ClipQuery(Query[ClipPoses]):
    """What are the poses of a clip, or of a span of it?"""

    clip: str
    library: str = ""
    start_s: float = 0.0
    end_s: float = 0.0
    """0 means the clip's end."""


@dataclass(frozen=True)
class SkeletonQuery(Query[Skeleton]):
    """What is the skeleton of a library?"""

    library: str = ""
