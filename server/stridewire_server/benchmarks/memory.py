"""Memory: what a character, a session and a minute of capture hold."""

import tracemalloc
from collections.abc import Iterator

import numpy as np

from stridewire._messages import CharacterSpec, Open
from stridewire_engine.library import Library
from stridewire_engine.matching.index import augment_rows
from stridewire_engine.matching.schema import Schema
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import Runtime
from stridewire_engine.runtime.characters import Characters
from stridewire_server.benchmarks.comparison import Compared

_SESSIONS = 200
_FLOAT = 4


def memory(library: Library) -> Iterator[Compared]:
    """Tell bytes of state, of a session, and of a minute of capture on disk and beside it."""
    joints, schema = len(library.skeleton), Schema.from_data(library.manifest.schema)
    pose = _FLOAT * (7 + 3 + 4 * joints)
    rows = Characters.allocate(1, joints, len(schema.channels))
    state = sum(column.nbytes for column in vars(rows).values())
    yield Compared("memory", "a character", "bytes", "its pose on the wire", state, pose)
    yield Compared("memory", "a session of one", "bytes", "a character", _session(library), state)
    minutes = len(library.features) / library.frame_rate / 60.0
    mapped = sum(file.stat().st_size for file in library.path.glob("*.npy")) / minutes
    frames = 60.0 * library.frame_rate * pose
    yield Compared(
        "memory", "a minute of capture, mapped", "bytes", "its poses alone", mapped, frames
    )
    some = np.arange(min(1000, len(library.features)))
    indexed = augment_rows(schema, library.features[some], np.zeros(len(some)))
    share = indexed.nbytes / len(some) * len(library.features) / minutes
    yield Compared(
        "memory", "a minute of capture, index", "bytes", "its poses alone", share, frames
    )
    boxes = Matcher(library).candidates.everything.boxes
    if boxes is not None:
        share = boxes.nbytes / minutes
        yield Compared(
            "memory", "a minute of capture, boxes", "bytes", "its poses alone", share, frames
        )


def _session(library: Library) -> float:
    """Return by how many bytes a process grows for a session of one character."""
    runtime = Runtime([library])
    opening = Open([CharacterSpec(0)])
    runtime.open(opening)
    tracemalloc.start()
    try:
        before, _ = tracemalloc.get_traced_memory()
        opened = [runtime.open(opening) for _ in range(_SESSIONS)]
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return (after - before) / len(opened)
