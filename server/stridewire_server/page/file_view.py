"""Motion files for the page: joints in the world as one block a file."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from stridewire import __version__
from stridewire.drawing.subject import Subject
from stridewire.formats.reading import read_motion

MOST_FRAMES = 36_000
"""Ten minutes at 60 frames a second; longer files are cut off there."""


def file_view(paths: Sequence[Path]) -> tuple[dict[str, Any], Mapping[str, bytes]]:
    """Return what the page is told about files, and the blocks that it fetches.

    Raises:
        ValueError: If a file cannot be read, or does not say its frame rate.
        OSError: If it cannot be opened.
    """
    files, blobs = [], {}
    for i, path in enumerate(paths):
        subject = Subject.of_source(read_motion(path))
        url = f"/page/files/{i}.f32"
        blobs[url] = np.asarray(subject.positions[:MOST_FRAMES], "<f4").tobytes()
        files.append(_told(subject, url))
    return {"version": __version__, "libraries": [], "stitchers": [], "files": files}, blobs


def _told(subject: Subject, url: str) -> dict[str, Any]:
    frames = min(len(subject.positions), MOST_FRAMES)
    return {
        "name": subject.name,
        "url": url,
        "frames": frames,
        "frameRate": subject.frame_rate,
        "seconds": (frames - 1) / subject.frame_rate,
        "parents": list(subject.parents),
        "sides": subject.sides.tolist(),
        "head": subject.head,
    }
