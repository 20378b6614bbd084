"""The bench: measures cells of a library, several at once, and keeps what it measured."""

import functools
import hashlib
import json
import multiprocessing
import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

import stridewire.motion
import stridewire_engine
from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.evaluation.figures import Blocks, Figures, captured_row, streamed_row
from stridewire_engine.evaluation.naive import naive_stream
from stridewire_engine.evaluation.streaming import Stream, Wanted, stream, wanted_of
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher

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
        return self.run_wanted(cell, wanted_of(cell))

    def run_wanted(self, cell: Cell, wanted: Wanted) -> Stream:
        """Make the motion of a cell under given controls."""
        make = naive_stream if cell.row == "naive" else stream
        return make(self.library, self._matcher, cell, wanted)

    def measure(self, cell: Cell) -> Measurement:
        """Make the motion of a cell and measure it."""
        made = self.run(cell)
        blocks = Blocks(made)
        every = blocks.mask("all")
        return {
            **{name: streamed_row(made, self.captured, blocks.mask(name)) for name in BLOCKS},
            "captured": captured_row(made, self.captured, every),
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
    code = code_hash()
    files = {cell: cache / f"{cell.key(library_hash, code)}.json" for cell in cells}
    missing = [cell for cell, file in files.items() if not file.exists()]
    for cell, file in files.items():
        if file.exists():
            yield cell, _read(file)
    cache.mkdir(parents=True, exist_ok=True)
    if jobs == 1 or len(missing) < 2:
        for cell in missing:
            yield cell, _keep(_bench(path).measure(cell), files[cell])
        return
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(missing)), mp_context=spawn) as pool:
        pending = {pool.submit(_measure, path, cell, files[cell]): cell for cell in missing}
        for future in as_completed(pending):
            yield pending[future], _read(future.result())


def code_hash() -> str:
    """Hash all code of the engine and the client: whatever changes in it, is measured again."""
    digest = hashlib.sha256()
    client = Path(stridewire.motion.__file__).parents[1]
    for folder in (client, Path(stridewire_engine.__file__).parent):
        for source in sorted(folder.rglob("*.py")):
            digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def default_cache() -> Path:
    """Return the folder of measurements in the user's cache."""
    home = os.environ.get("XDG_CACHE_HOME")
    return (Path(home) if home else Path.home() / ".cache") / "stridewire" / "evaluation"


@functools.lru_cache(maxsize=1)
def _bench(path: Path) -> Bench:
    return Bench(path)


def _measure(path: Path, cell: Cell, file: Path) -> Path:
    _keep(_bench(path).measure(cell), file)
    return file


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
