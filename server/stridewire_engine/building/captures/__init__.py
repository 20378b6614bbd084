"""Public captures that can be fetched: what they are, their terms, and where each file lies.

A list is a TOML file: name, title, base_url, licence, credit and files as rows of path, frames per
second (0 for skeletons) and description.
"""

import csv
import tomllib
import urllib.error
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import Any

from stridewire.formats.acclaim import read_asf
from stridewire.formats.reading import READERS, read_motion

_CHUNK = 1 << 16
_LARGEST = 1 << 28
_TIMEOUT_S = 30.0
_WORDS = ("name", "title", "base_url", "licence", "credit")


class CaptureError(ValueError):
    """A list is malformed or a file could not be fetched; the message says what to do."""


@dataclass(frozen=True)
class CaptureFile:
    """One file of a capture."""

    path: str
    """Relative to the base address and to the folder that it is fetched into."""
    frame_rate: float
    """Frames per second; 0 for a skeleton."""
    description: str


@dataclass(frozen=True)
class Capture:
    """A public capture."""

    name: str
    title: str
    base_url: str
    licence: str
    credit: str
    files: tuple[CaptureFile, ...]


def find_capture(name: str) -> Capture:
    """Return a shipped list by its name, or the list in a TOML file.

    Raises:
        CaptureError: If there is no such list or it is malformed.
    """
    if name.endswith(".toml"):
        return _parse(Path(name).read_text(encoding="utf-8"), name)
    folder = files(__name__)
    known = sorted(
        e.name.removesuffix(".toml") for e in folder.iterdir() if e.name.endswith("toml")
    )
    if name not in known:
        raise CaptureError(
            f"no capture {name!r}; known are {', '.join(known)}, or give a .toml list"
        )
    return _parse((folder / f"{name}.toml").read_text(encoding="utf-8"), name)


def fetch(capture: Capture, folder: Path, base_url: str | None = None) -> Iterator[tuple[str, str]]:
    """Fetch what is missing and yield each file's path with its problem, empty where there is none.

    Half-fetched files are continued; each is read, those that were there already, too, and dropped
    where that fails. An `index.csv`
    with frame rates and descriptions is written beside them, which `library build` obeys.

    Args:
        capture: What to fetch.
        folder: Where to.
        base_url: A mirror, instead of the list's address.
    """
    address = (base_url or capture.base_url).rstrip("/")
    folder.mkdir(parents=True, exist_ok=True)
    _write_index(capture, folder)
    for file in capture.files:
        path = folder / file.path
        try:
            if not path.exists():
                path.parent.mkdir(parents=True, exist_ok=True)
                partial = path.with_name(f"{path.name}.part")
                _download(f"{address}/{file.path}", partial)
                partial.rename(path)
            _check(path)
        except (OSError, ValueError) as error:
            yield file.path, str(error)
        else:
            yield file.path, ""


def _download(url: str, partial: Path) -> None:
    """Fetch into a file, going on where an earlier try ended."""
    have = partial.stat().st_size if partial.exists() else 0
    request = urllib.request.Request(url, headers={"Range": f"bytes={have}-"} if have else {})
    try:
        with urllib.request.urlopen(request, timeout=_TIMEOUT_S) as answer:
            resumed = answer.status == 206
            with partial.open("ab" if resumed else "wb") as out:
                _copy(answer, out, url)
    except urllib.error.HTTPError as error:
        error.close()
        if error.code == 416 and have:
            return
        raise CaptureError(
            f"{url}: {error.code} {error.reason}; try again or give --base-url"
        ) from None
    except urllib.error.URLError as error:
        raise CaptureError(f"{url}: {error.reason}; is there a network?") from None


def _copy(answer: Any, out: Any, url: str) -> None:
    total = 0
    while chunk := answer.read(_CHUNK):
        total += len(chunk)
        if total > _LARGEST:
            raise CaptureError(
                f"{url}: larger than {_LARGEST >> 20} MiB; is that the right address?"
            )
        out.write(chunk)
    promised = answer.headers.get("Content-Length")
    if promised is not None and total < int(promised):
        raise CaptureError(f"{url}: the connection ended after {total} of {promised} bytes")


def _check(path: Path) -> None:
    """Read a fetched file; take it away again where that fails, so that the next try fetches it."""
    try:
        if path.suffix.lower() == ".asf":
            read_asf(path)
        elif path.suffix.lower() in READERS:
            read_motion(path)
    except ValueError:
        path.unlink()
        raise


def _write_index(capture: Capture, folder: Path) -> None:
    with (folder / "index.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("file", "fps", "description"))
        rows = (f for f in capture.files if f.frame_rate > 0.0)
        writer.writerows((f.path, f"{f.frame_rate:g}", f.description) for f in rows)


def _parse(text: str, where: str) -> Capture:
    try:
        table = tomllib.loads(text)
        rows = tuple(CaptureFile(str(p), float(r), str(d)) for p, r, d in table["files"])
        words = {key: str(table[key]) for key in _WORDS}
    except (tomllib.TOMLDecodeError, KeyError, TypeError, ValueError) as error:
        raise CaptureError(
            f"{where}: {error}; expected name, title, base_url, licence, credit and files = "
            "[[path, frames per second, description], …]"
        ) from None
    for row in rows:
        parts = PurePosixPath(row.path)
        if parts.is_absolute() or ".." in parts.parts:
            raise CaptureError(f"{where}: path {row.path!r} leaves the folder")
    return Capture(**words, files=rows)
