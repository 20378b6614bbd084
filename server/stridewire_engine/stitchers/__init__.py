"""Stitchers: what hides a transition, one interface, many characters at once.

A stitcher never changes a frame that was sent. When a character jumps, `begin` takes over what was
shown and what comes next; from then on `apply` turns the sampled pose into the shown one. It may be
interrupted at any frame by the next `begin`.
"""

from stridewire_engine.stitchers.cut import Cut
from stridewire_engine.stitchers.dead_blend import DeadBlend
from stridewire_engine.stitchers.inertialization import SpringInertialization
from stridewire_engine.stitchers.quintic import QuinticInertialization
from stridewire_engine.stitchers.refine import Refine
from stridewire_engine.stitchers.stance import Stance
from stridewire_engine.stitchers.stitcher import (
    STITCH_COLUMNS,
    Guide,
    LegsAhead,
    Motion,
    Roots,
    Sample,
    Stitcher,
    StitchState,
)

__all__ = [
    "AUTO",
    "DEFAULT_STITCHER",
    "STITCHERS",
    "STITCHER_NAMES",
    "STITCH_COLUMNS",
    "Guide",
    "LegsAhead",
    "Motion",
    "Roots",
    "Sample",
    "StitchState",
    "Stitcher",
]

STITCHERS: tuple[Stitcher, ...] = (
    SpringInertialization(),
    Cut(),
    QuinticInertialization(),
    DeadBlend(),
    Stance(),
    Refine(),
)
"""All stitchers; a character holds an index into this tuple, or `AUTO`."""

AUTO = len(STITCHERS)
"""Stands for the better of two at each transition; see `auto`."""
STITCHER_NAMES = (*(stitcher.name for stitcher in STITCHERS), "auto")
"""What a caller can ask for, by index."""
DEFAULT_STITCHER = "stance"
"""For callers that ask for none."""
