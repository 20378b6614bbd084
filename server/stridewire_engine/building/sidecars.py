"""What lies beside motion files: `index.csv` with true frame rates, subjects and descriptions."""

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path

_NAME = "index.csv"
_LEVELS = 3


class SidecarError(ValueError):
    """A sidecar or split file is malformed; the message names file, line and what is expected."""


@dataclass(frozen=True)
class Sidecar:
    """What an index says about one file."""

    subject: str = ""
    frame_rate: float | None = None
    """Frames per second; None where the index says nothing."""
    words: str = ""
    """Description and category."""


@dataclass
class Sidecars:
    """Indexes by folder, each read once.

    An `index.csv` lies in the file's folder or up to three above it and has a column `file` with
    paths relative to itself, and any of `subject`, `fps`, `description` and `category`.
    """

    _indexes: dict[Path, dict[str, Sidecar]] = field(default_factory=dict)

    def of(self, path: Path) -> Sidecar:
        """Return what is known about a file; a blank one where no index names it.

        Raises:
            SidecarError: If an index is malformed.
        """
        path = path.resolve()
        for folder in path.parents[: _LEVELS + 1]:
            if folder not in self._indexes:
                index = folder / _NAME
                self._indexes[folder] = _read(index) if index.is_file() else {}
            found = self._indexes[folder].get(path.relative_to(folder).as_posix())
            if found is not None:
                return found
        return Sidecar()


def subject_of(path: Path, sidecar: Sidecar) -> str:
    """Return the subject: the index's, else `subjectN` in the name, else the number before `_`."""
    if sidecar.subject:
        return sidecar.subject
    named = re.search(r"subject(\d+)", path.stem) or re.match(r"(\d+)_", path.stem)
    return named[1] if named else ""


@dataclass(frozen=True)
class Splits:
    """Which subjects of which data set belong to which split."""

    path: Path
    rows: tuple[tuple[str, str, str], ...]
    """Data set, subject or `*`, split."""

    def of(self, path: Path, sidecar: Sidecar) -> str:
        """Return the split of a file; empty where the split file does not cover it.

        A data set is a folder of its name on the file's path, with or without a suffix (`cmu`
        covers `cmu-more`); subjects compare as integers; a folder `fragments` is `exclude`.
        """
        folders = path.resolve().parts[:-1]
        subject = _number(subject_of(path, sidecar))
        rest = ""
        for data, of, split in self.rows:
            if not any(folder == data or folder.startswith(f"{data}-") for folder in folders):
                continue
            if "fragments" in folders:
                return "exclude"
            if of == "*":
                rest = split
            elif _number(of) == subject:
                return split
        return rest

    @property
    def names(self) -> tuple[str, ...]:
        """The splits that occur."""
        return tuple(sorted({split for _, _, split in self.rows}))


def read_splits(path: Path) -> Splits:
    """Read a CSV file with the columns `data`, `subject` (or `*`) and `split`.

    Raises:
        SidecarError: If a column is missing.
        OSError: If it cannot be opened.
    """
    rows = _rows(path, ("data", "subject", "split"))
    return Splits(path, tuple((row["data"], row["subject"], row["split"]) for row in rows))


def _number(subject: str) -> int | str:
    digits = re.sub(r"\D", "", subject)
    return int(digits) if digits else subject


def _rows(path: Path, needed: tuple[str, ...]) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8-sig") as file:
        reader = csv.DictReader(file)
        columns = reader.fieldnames or ()
        missing = [name for name in needed if name not in columns]
        if missing:
            raise SidecarError(
                f"{path}: no column {missing[0]!r}; expected the first line to name "
                f"{', '.join(needed)}"
            )
        return [{k: v or "" for k, v in row.items() if isinstance(k, str)} for row in reader]


def _read(path: Path) -> dict[str, Sidecar]:
    known = {}
    for row in _rows(path, ("file",)):
        try:
            rate = float(row.get("fps") or "nan")
        except ValueError:
            raise SidecarError(
                f"{path}: fps of {row['file']} is {row['fps']!r}; expected frames per second"
            ) from None
        words = " ".join(row.get(column, "") for column in ("description", "category"))
        known[row["file"]] = Sidecar(
            row.get("subject", ""), rate if rate > 0.0 else None, words.strip()
        )
    return known
