"""The bench: measures cells of a library, several at once, and keeps what it measured."""

import functools
import json
import multiprocessing
import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.evaluation.code import code_hash
from stridewire_engine.evaluation.figures import Blocks, Figures, Judged
from stridewire_engine.evaluation.naive import naive_streams
from stridewire_engine.evaluation.streaming import PER_SEED, Stream, Wanted, streams, wanted_of
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher

_MOST_CHARACTERS = 400
"""Share their ticks: Python's part of a tick is small then, and the frames fit into memory."""
BLOCKS = ("all", "0", "1", "2", "3")
Measurement = Mapping[str, Figures]
"""Figures by block of frames since the last transition, and `captured` for the frames played."""


class Bench:
    """One library, its captured figures and its index."""

    def __init__(self, path: Path) -> None:
        """Open a library and measure its clips.

        Raises:
            LibraryError: If it cannot be opened.
        """
        self.library = Library.open(path)
        self.captured = Captured(self.library)
        self._matcher = Matcher(self.library)

    def run(self, cell: Cell) -> Stream:
        """Make the motion of a cell."""
        return next(self.run_all([cell]))

    def run_all(self, cells: Sequence[Cell]) -> Iterator[Stream]:
        """Make the motion of cells that share their ticks."""
        asked: dict[tuple[str, tuple[int, ...]], Wanted] = {}
        for cell in cells:
            if (cell.script, cell.seeds) not in asked:
                asked[cell.script, cell.seeds] = wanted_of(cell)
        return self.run_under(cells, [asked[cell.script, cell.seeds] for cell in cells])

    def run_under(self, cells: Sequence[Cell], wanted: Sequence[Wanted]) -> Iterator[Stream]:
        """Make the motion of cells under given controls."""
        make = naive_streams if cells[0].row == "naive" else streams
        return make(self.library, self._matcher, cells, wanted)

    def measure(self, cell: Cell) -> Measurement:
        """Make the motion of a cell and measure it."""
        return self.judge(self.run(cell))

    def measure_all(self, cells: Sequence[Cell]) -> Iterator[Measurement]:
        """Make the motion of cells that share their ticks and measure each."""
        return (self.judge(made) for made in self.run_all(cells))

    def judge(self, made: Stream) -> Measurement:
        """Measure motion that was made."""
        blocks, judged = Blocks(made), Judged(made, self.captured)
        return {
            **{name: judged.streamed(blocks.mask(name)) for name in BLOCKS},
            "captured": judged.captured(blocks.mask("all")),
        }


def measure_cells(
    path: Path, cells: Sequence[Cell], jobs: int, cache: Path
) -> Iterator[tuple[Cell, Measurement]]:
    """Yield the measurements of cells as they come; what was measured before is read.

    Args:
        path: Of the library.
        cells: To measure.
        jobs: Processes.
        cache: Folder of measurements.
    """
    library_hash = Library.open(path).manifest.content_hash
    code = code_hash(Path(__file__))
    files = {cell: cache / f"{cell.key(library_hash, code)}.json" for cell in cells}
    for cell, file in files.items():
        if file.exists():
            yield cell, _read(file)
    cache.mkdir(parents=True, exist_ok=True)
    work = list(_batches([cell for cell, file in files.items() if not file.exists()]))
    if jobs == 1 or len(work) < 2:
        for batch in work:
            for cell, measurement in zip(batch, _bench(path).measure_all(batch), strict=True):
                yield cell, _keep(measurement, files[cell])
        return
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(work)), mp_context=spawn) as pool:
        pending = {pool.submit(_measure, path, {c: files[c] for c in b}): b for b in work}
        for future in as_completed(pending):
            future.result()
            yield from ((cell, _read(files[cell])) for cell in pending[future])


def _batches(cells: Sequence[Cell]) -> Iterator[list[Cell]]:
    """Yield cells that share their ticks, up to `_MOST_CHARACTERS` together."""
    for tick in dict.fromkeys(cell.tick for cell in cells):
        batch: list[Cell] = []
        count = 0
        for cell in (cell for cell in cells if cell.tick == tick):
            characters = PER_SEED * len(cell.seeds)
            if batch and count + characters > _MOST_CHARACTERS:
                yield batch
                batch, count = [], 0
            batch.append(cell)
            count += characters
        yield batch


def default_cache() -> Path:
    """Return the folder of measurements in the user's cache."""
    home = os.environ.get("XDG_CACHE_HOME")
    return (Path(home) if home else Path.home() / ".cache") / "stridewire" / "evaluation"


@functools.lru_cache(maxsize=1)
def _bench(path: Path) -> Bench:
    return Bench(path)


def _measure(path: Path, files: Mapping[Cell, Path]) -> None:
    cells = list(files)
    for cell, measurement in zip(cells, _bench(path).measure_all(cells), strict=True):
        _keep(measurement, files[cell])


def _keep(measurement: Measurement, file: Path) -> Measurement:
    data = {
        block: {name: figure.data() for name, figure in figures.items()}
        for block, figures in measurement.items()
    }
    part = file.with_suffix(f".{os.getpid()}.part")
    part.write_text(json.dumps(data))
    part.replace(file)
    return measurement


def _read(file: Path) -> Measurement:
    data = json.loads(file.read_text())
    return {
        block: {name: tally.from_data(figure) for name, figure in figures.items()}
        for block, figures in data.items()
    }
