"""Benchmarks of the engine: search, tick, stitchers, blending, opening a library."""

from collections.abc import Iterator
from itertools import count

import numpy as np

from stridewire._messages import (
    BlendMethod,
    BlendQuery,
    CharacterSpec,
    ClipTime,
    Detail,
    Open,
    Step,
)
from stridewire.scripts import script
from stridewire_engine import blending
from stridewire_engine.library import Library
from stridewire_engine.matching.index import ExactIndex, augment_queries
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import Runtime, Session
from stridewire_engine.stitchers import STITCHERS
from stridewire_server.benchmarks.comparison import Compared, Work, compare

_QUERIES = 32
_NEIGHBOURS = 64
_POSTURES = 32
_SETTLED = 90
"""Frames after which characters are out of step with each other."""
_STITCHED = 64
_FRAME_S = 1.0 / 60.0


def search(library: Library, rounds: int) -> Iterator[Compared]:
    """Compare a search of a crowd's with a scan of all rows."""
    matcher = Matcher(library)
    rng = np.random.default_rng(1)
    rows = rng.choice(np.flatnonzero(library.startable), _QUERIES)
    moments = library.features[rows]
    queries = moments + rng.normal(scale=0.3, size=moments.shape)
    weights = np.tile(matcher.schema.weights, (_QUERIES, 1))
    excluded = rows[:, None]
    everything = np.flatnonzero(library.startable)
    scan = ExactIndex(matcher.schema, library.features, matcher.bias, everything)
    augmented = augment_queries(matcher.schema, queries, weights)
    value, reference = compare(
        lambda: matcher.search(queries, weights, excluded),
        lambda: scan.search(augmented, _NEIGHBOURS),
        rounds,
    )
    yield Compared(
        "search",
        f"{_QUERIES} queries, {len(everything)} rows",
        "us a query",
        "exact scan",
        value / _QUERIES,
        reference / _QUERIES,
    )


def tick(library: Library, rounds: int, sizes: tuple[int, ...]) -> Iterator[Compared]:
    """Compare a tick of many characters with one of a single character."""
    alone = _Crowd(library, 1, "refine")
    for size in sizes:
        crowd = _Crowd(library, size, "refine")
        value, reference = compare(crowd.tick, alone.tick, rounds)
        yield Compared(
            "tick",
            f"{size} characters, refine",
            "us a character-frame",
            "one character",
            value / size,
            reference,
        )


def stitchers(library: Library, rounds: int) -> Iterator[Compared]:
    """Compare a tick with each stitcher with one without."""
    plain = _Crowd(library, _STITCHED, "none")
    for stitcher in STITCHERS:
        if stitcher.name == "none":
            continue
        value, reference = compare(
            _Crowd(library, _STITCHED, stitcher.name).tick, plain.tick, rounds
        )
        yield Compared(
            f"stitcher {stitcher.name}",
            f"{_STITCHED} characters, the whole tick",
            "us a character-frame",
            "stitcher none",
            value / _STITCHED,
            reference / _STITCHED,
        )


def blend(library: Library, rounds: int) -> Iterator[Compared]:
    """Compare blending by the network with linear blending."""
    clip = max(library.clips, key=lambda clip: clip.frames)
    start, end = ClipTime(clip.name, 0.2), ClipTime(clip.name, 0.7)
    weights = np.linspace(0.0, 1.0, _POSTURES)

    def ask(method: BlendMethod) -> Work:
        query = BlendQuery(start, end, weights, method)
        return lambda: blending.answer(lambda _: library, query)

    value, reference = compare(ask(BlendMethod.NEURAL), ask(BlendMethod.SLERP), rounds)
    yield Compared(
        "blend",
        f"{_POSTURES} postures",
        "us a posture",
        "SLERP",
        value / _POSTURES,
        reference / _POSTURES,
    )


def opening(library: Library, rounds: int) -> Iterator[Compared]:
    """Compare opening and indexing a library with reading its files."""
    paths = [path for path in library.path.iterdir() if path.is_file()]
    value, reference = compare(
        lambda: Matcher(Library.open(library.path)),
        lambda: [path.read_bytes() for path in paths],
        rounds,
    )
    yield Compared(
        "open library",
        f"{len(library.features)} frames",
        "us",
        "reading its files",
        value,
        reference,
    )


class _Crowd:
    """A session under the script `random-stick`; one call is one tick."""

    def __init__(self, library: Library, size: int, stitcher: str) -> None:
        self._runtime = Runtime([library])
        specs = tuple(CharacterSpec(i, stitcher=stitcher) for i in range(size))
        self.session: Session = self._runtime.open(Open(characters=specs, detail=Detail.EVENTS))
        self._size, self._steps = size, count(1)
        for _ in range(_SETTLED):
            self.tick()

    def tick(self) -> object:
        """Advance by a sixtieth of a second; return the frame."""
        number = next(self._steps)
        asked = script("random-stick").controls(number * _FRAME_S, self._size, 0)
        step = Step(number, _FRAME_S, velocity_xz=asked.velocity, facing_yaw=asked.facing)
        return self._runtime.advance([(self.session, step)])[0][0]
