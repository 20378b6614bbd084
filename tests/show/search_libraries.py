"""Libraries for `make show-search`, built once into build/show/libraries.

A million frames are made of captured clips by playing them at other speeds, turning each joint of a
copy by a few degrees, and mirroring: other motion, but no new capture.
"""

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import count

import numpy as np
from capture import BUILD
from import_libraries import LIBRARIES, STANDARD

from stridewire.motion import quaternion
from stridewire.motion.clip import Clip
from stridewire_engine.building import FRAME_RATE, build_library
from stridewire_engine.library import Library, LibraryError

FOLDER = BUILD / "libraries"
MILLION = 1_000_000


@cache
def captured(name: str) -> Library:
    """Open a library of the judge's, building it where it is missing."""
    path = FOLDER / name
    try:
        return Library.open(path)
    except LibraryError:
        recipe = next(one for one in (*LIBRARIES, STANDARD) if one.name == name)
        words = [sys.executable, "-m", "stridewire", *map(str, recipe.command(path))]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        return Library.open(path)


@cache
def million() -> Library:
    """Open a library of a million frames."""
    return reduced(MILLION)


@cache
def reduced(frames: int) -> Library:
    """Open a library of so many frames: captured first, then varied copies."""
    path = FOLDER / f"frames-{frames}"
    try:
        return Library.open(path)
    except LibraryError:
        clips, left = [], frames // 2
        for clip in _endless():
            if left < 120:
                break
            clips.append(clip.cut(0, min(len(clip), left)))
            left -= len(clips[-1])
        return build_library(clips, path, name=f"{frames // 1000}k")


def _endless() -> Iterator[Clip]:
    """Yield captured clips, then copies at other speeds and slightly other poses."""
    sources = [
        library.clip(entry.name)
        for library in (captured("cmu-seen"), captured("lafan1-dev"), captured("lafan1"))
        for entry in library.clips
        if not entry.name.endswith("-mirrored") and entry.frames > 120
    ]
    rng = np.random.default_rng(5)
    for lap in count():
        for number, clip in enumerate(sources):
            if lap == 0:
                yield replace(clip, name=f"{number}-{clip.name}", tags=clip.tags)
            else:
                speed = rng.uniform(0.8, 1.25)
                yield _varied(clip, speed, rng, f"{lap}-{number}-{clip.name}")


def _varied(clip: Clip, speed: float, rng: np.random.Generator, name: str) -> Clip:
    frames = int((len(clip) - 1) / speed)
    times = np.arange(frames) * speed / FRAME_RATE
    pose = clip.sample(times)
    turn = quaternion.from_scaled_axis(rng.normal(scale=0.03, size=(22, 3)))
    rotations = quaternion.multiply(pose.rotations.astype(np.float64), turn)
    tags = tuple(
        replace(tag, start=int(tag.start / speed), end=min(int(tag.end / speed), frames))
        for tag in clip.tags
    )
    return Clip(
        name,
        clip.skeleton,
        FRAME_RATE,
        replace(pose, rotations=rotations),
        clip.contacts[np.round(np.arange(frames) * speed).astype(int)],
        tags,
        f"{clip.source} at {speed:.2f} of its speed, varied",
    )
