"""Opening a library of any kind: a built one, a folder of motion files, the embedded default.

What has to be built first is built once, into the user's cache.
"""

import hashlib
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import stridewire.motion
import stridewire_engine
from stridewire_engine.building.build import build_library
from stridewire_engine.building.gait.model import gait_coefficients
from stridewire_engine.building.importing import import_files, motion_files
from stridewire_engine.building.synthetic import CREDIT, synthetic_clips
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.library.manifest import MANIFEST_NAME


def open_library(folder: Path | str | None = None) -> Library:
    """Open a library folder, a folder of motion files, or the embedded library.

    Args:
        folder: A library; or motion files, which are imported into the user's cache; or None for
            the embedded synthetic library.

    Raises:
        LibraryError: If it is neither, or none of the files can be used; the message says why.
    """
    if folder is None:
        return embedded_library()
    folder = Path(folder)
    if (folder / MANIFEST_NAME).is_file() or not folder.is_dir():
        return Library.open(folder)
    files = motion_files([folder])
    if not files:
        return Library.open(folder)
    stamps = [(str(file), file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    key = hashlib.sha256(f"{_fingerprint()}{stamps}".encode()).hexdigest()[:12]
    name = folder.resolve().name
    return _cached(f"{name}-{key}", lambda path: _import(folder, files, path, name))


def embedded_library() -> Library:
    """Open the default library, building it first where the cache lacks it or it is broken."""
    return _cached(
        f"synthetic-{_fingerprint()}",
        lambda path: build_library(
            synthetic_clips(),
            path,
            name="synthetic",
            synthetic=True,
            licence="Apache-2.0",
            credit=CREDIT,
        ),
    )


def _cached(key: str, build: Callable[[Path], Library]) -> Library:
    path = _cache() / key
    try:
        library = Library.open(path)
        library.verify()
        return library
    except LibraryError:
        return build(path)


def _import(folder: Path, files: Sequence[Path], path: Path, name: str) -> Library:
    outcomes = [*import_files(files)]
    clips = [outcome.clip for outcome in outcomes if outcome.clip is not None]
    if not clips:
        raise LibraryError(
            f"none of the {len(files)} motion files in {folder} can be used; the first: "
            f"{outcomes[0].problem}"
        )
    command = f"stridewire library build {folder} --out {path} --name {name}"
    return build_library(clips, path, name=name, build_command=command)


def _fingerprint() -> str:
    """Hash the code and coefficients that libraries are made by: a change makes others."""
    engine = Path(stridewire_engine.__file__).parent
    kernel = Path(stridewire.motion.__file__).parent
    digest = hashlib.sha256()
    for folder in (kernel, engine / "building", engine / "library", engine / "matching"):
        for source in sorted(folder.rglob("*.py")):
            digest.update(source.read_bytes())
    digest.update(gait_coefficients())
    return digest.hexdigest()[:12]


def _cache() -> Path:
    """Return the user's cache folder (XDG base directory specification)."""
    home = os.environ.get("XDG_CACHE_HOME")
    return (Path(home) if home else Path.home() / ".cache") / "stridewire"
