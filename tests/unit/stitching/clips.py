"""Clips of the synthetic library, cut so that their steps do not fit together."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from stridewire._messages import StitchQuery, StitchReport
from stridewire.motion.clip import Clip, Pose
from stridewire_engine.library import Library
from stridewire_engine.stitching import Stitching, stitching


def cuts_of(library: Library, frames: int = 150, count: int = 4) -> list[Clip]:
    """Return pieces of walks, runs and a stop from places of their own."""
    names = ("walk-1.4", "run-3.0", "walk-turn", "stop")
    found = [next(c.name for c in library.clips if c.name.startswith(n)) for n in names]
    clips = [library.clip(found[i % 4]) for i in range(count)]
    starts = [(17 * i) % max(len(c) - frames, 1) for i, c in enumerate(clips)]
    return [c.cut(s, s + frames) for c, s in zip(clips, starts, strict=True)]


def stitched(clips: Sequence[Clip], **given: Any) -> tuple[Stitching, Pose, StitchReport]:
    """Return a stitching that is done, its poses as they came, and its report."""
    made = stitching([c.name for c in clips], clips, StitchQuery(tuple(clips), **given))
    parts = list(made.parts())
    assert isinstance(parts[-1], StitchReport)
    return made, Pose.concatenate(p for p in parts if isinstance(p, Pose)), parts[-1]


def broken(clip: Clip, **changes: Any) -> Clip:
    """Return a clip with arrays of its pose changed, unchecked."""
    pose = replace(clip.pose, **{n: f(getattr(clip.pose, n)) for n, f in changes.items()})
    out = object.__new__(Clip)
    for name, value in {**vars(clip), "pose": pose}.items():
        object.__setattr__(out, name, value)
    return out


def nan(array: Any) -> Any:
    """Return an array with one number that is none."""
    out = np.array(array)
    out[3, 0] = np.nan
    return out
