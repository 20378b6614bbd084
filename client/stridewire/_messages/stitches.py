"""Stitches: one motion out of several clips."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from stridewire._messages.queries import PartsQuery
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import Skeleton


@dataclass(frozen=True)
class ClipSpan:
    """A span of a clip of a library."""

    clip: str
    start_s: float = 0.0
    end_s: float = 0.0
    """0 means the clip's end."""
    library: str = ""


@dataclass(frozen=True)
class BvhText:
    """The text of a BVH file, of any human; it is brought onto the reference skeleton."""

    text: str


@dataclass(frozen=True)
class RootPath:
    """Where the root is to go, whatever the clips do."""

    positions_xz: Floats
    """`(K, 2)` in the world, metres; K from 2 to 100,000."""
    times_s: Floats
    """`(K,)` seconds, ascending, from 0 to the end of the motion or later."""
    facings_yaw: Floats | None = None
    """`(K,)` radians; None means along the path."""


@dataclass(frozen=True)
class StitchHeader:
    """What the poses will be."""

    skeleton: Skeleton
    frame_rate_hz: float
    frames: int


@dataclass(frozen=True)
class Seam:
    """How one seam was hidden."""

    frame: int
    """First frame of the clip that follows."""
    method: str
    """Name of the stitcher that hid it."""
    reason: str = ""
    """Why, where it is not the one asked for."""
    cut_before: int = 0
    """Frames that the search left out at the end of the clip before."""
    cut_after: int = 0
    """Frames that it left out at the start of the clip that follows."""


@dataclass(frozen=True)
class MotionFigures:
    """How good a motion is, over the frames in which seams are hidden."""

    sliding_c_cm_s: float
    """Mean speed over the ground of toes that the clips call planted."""
    sliding_a_cm_s: float
    """The same of toes less than 2 cm above the ground, whatever the clips say."""
    toe_jerk: float
    """Mean length of the third derivative of the toes' places; m/s³."""
    knee_jerk: float
    """The same of the knees."""
    seam_step_cm_s: float
    """Largest change of a toe's velocity within the frame of a seam, mean over the seams."""


@dataclass(frozen=True)
class StitchReport:
    """What was done, and what it was good for."""

    seams: tuple[Seam, ...]
    before: MotionFigures
    """Of the clips laid end to end."""
    after: MotionFigures
    """Of the answer."""
    elsewhere: MotionFigures
    """Of the clips away from seams, to compare with; no seams there."""
    changed_frames: int
    """All others are the clips' own."""
    window_s: float
    """Seconds after a seam in which it was hidden."""
    models: Mapping[str, str]
    """Hash of each network that was used, by name."""
    version: str
    """Of stridewire."""


@dataclass(frozen=True)
class Stitched:
    """One motion, whole."""

    clip: Clip
    """At the header's frame rate, on its skeleton."""
    report: StitchReport


StitchPart = StitchHeader | Pose | StitchReport
"""A header comes first, then poses `(T, …)` float32 in order, then a report."""


@dataclass(frozen=True)
class StitchQuery(PartsQuery[StitchPart]):
    """What is one natural motion of these clips, in this order?"""

    clips: Sequence[ClipSpan | Clip | BvhText]
    """2 to 64, each of at least 10 frames at 60 frames/s; contacts of a `Clip` are found anew."""
    stitcher: str = "auto"
    """Name of a stitcher; `auto` takes the best for each seam."""
    window_s: float = 1.5
    """Within so many seconds after a seam poses may differ from the clips'; 0.1 to 2."""
    shift_s: float | None = None
    """How far the network's windows are apart, up to `window_s`; None means 0.5 at most."""
    passes: int = 1
    """How often the network works on its own result; 1 to 8."""
    search_frames: int = 0
    """Up to so many frames are left out at each end of a clip where the seam gets better; 60."""
    strength: float = 1.0
    """Share of the correction; 0 to 1."""
    joint_mask: Mapping[str, float] = field(default_factory=dict)
    """Share of the correction that joints take, 0 to 1; else 1."""
    start_s: float = 0.0
    """Frames before it stay the clips'."""
    end_s: float = 0.0
    """Frames after it stay the clips'; 0 means the end."""
    path: RootPath | None = None
    """None means the clips' own paths, each going on where the one before ends."""

    @property
    def shift(self) -> float:
        """Seconds between the network's windows."""
        return min(0.5, self.window_s) if self.shift_s is None else self.shift_s
