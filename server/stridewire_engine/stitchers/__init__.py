"""Stitchers: what hides a transition, one interface, many characters at once.

A stitcher never changes a frame that was sent. When a character jumps, `begin` takes over what was
shown and what comes next; from then on `apply` turns the sampled pose into the shown one. It may be
interrupted at any frame by the next `begin`.
"""

from stridewire_engine.stitchers.cut import Cut
from stridewire_engine.stitchers.dead_blend import DeadBlend
from stridewire_engine.stitchers.inertialization import SpringInertialization
from stridewire_engine.stitchers.quintic import QuinticInertialization
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
    "STITCHERS",
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
)
"""All stitchers, the default first; a character holds an index into this tuple."""
