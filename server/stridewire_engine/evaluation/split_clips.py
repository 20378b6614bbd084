"""Clips of a split: the captured subjects that training, choosing or judging may see."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from stridewire.motion.clip import Clip
from stridewire_engine.building.importing import import_files, motion_files
from stridewire_engine.building.sidecars import read_splits

SPLIT_FILE = "split.csv"


class MissingCaptureError(ValueError):
    """The capture is not where it was said to be; the message says what to do."""


def split_files(data: Path, name: str, split: str) -> list[Path]:
    """Return the motion files of a data set's split, sorted.

    Args:
        data: Folder that holds `split.csv` and the unpacked data sets.
        name: Of the data set; folders `NAME` and `NAME-…` belong to it.
        split: `train`, `validation` or `test`.

    Raises:
        MissingCaptureError: If the split file or the data set is not there.
        SidecarError: If the split file or an index is malformed.
    """
    table = data / SPLIT_FILE
    if not table.is_file():
        raise MissingCaptureError(
            f"no {SPLIT_FILE} in {data}; expected a CSV file with the columns data, subject and "
            "split beside the folders of the data sets"
        )
    folders = [
        path
        for path in sorted(data.iterdir())
        if path.is_dir() and (path.name == name or path.name.startswith(f"{name}-"))
    ]
    files = motion_files(folders, (split,), read_splits(table))
    if not files:
        raise MissingCaptureError(
            f"no motion file of {name}'s split {split!r} in {data}; unpack the data set there"
        )
    return files


def import_clips(files: Sequence[Path]) -> Iterator[Clip | None]:
    """Import files one by one; None where one was refused."""
    for outcome in import_files(files):
        yield outcome.clip
