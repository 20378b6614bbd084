"""Cells: what one measurement is of; a table is made of many."""

import hashlib
import json
from dataclasses import asdict, dataclass, replace

from stridewire_engine.runtime import TickSettings
from stridewire_engine.runtime.response import NEUTRAL

REPORT_SEEDS = tuple(range(100, 120))
"""Seeds of reports; tuning uses others."""
TUNING_SEEDS = tuple(range(10))
KEPT_OUT = ("zigzag", "random-stick")
"""Scripts that tuning never sees."""
NAIVE_SEEDS = 3
_DEFAULTS = TickSettings()


@dataclass(frozen=True)
class Cell:
    """One script on one library, under one way of making motion."""

    script: str
    row: str = "streamed"
    """`streamed` or `naive`."""
    stitch: str = ""
    """Name of a stitcher."""
    foot_lock: bool = True
    forced_interval_frames: int = 0
    """A transition is forced every so many frames; 0 for natural ones."""
    seeds: tuple[int, ...] = REPORT_SEEDS
    """Two characters each."""
    seconds: float = 10.0
    match_rank: int = 1
    """Which of the best matches is taken."""
    root_scale: float = 1.0
    """The root is driven so many times as fast as the clip."""
    label_shift_frames: int = 0
    """Contact labels come so many frames late; negative: early."""
    settings: TickSettings = _DEFAULTS
    weights: tuple[tuple[str, float], ...] = ()
    """Of channels; the others have the schema's."""
    responsiveness: float = NEUTRAL
    """From 0, quality, to 1, response."""

    @property
    def tick(self) -> "Cell":
        """All that the tick itself depends on: cells where it is equal can share their ticks."""
        return replace(
            self, script="", stitch="", foot_lock=True, seeds=(), weights=(), responsiveness=NEUTRAL
        )

    def key(self, library_hash: str, code_hash: str) -> str:
        """Return a name for the cache that changes with anything the result depends on."""
        text = json.dumps([library_hash, code_hash, asdict(self)], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:24]
