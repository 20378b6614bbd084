"""The default library: synthetic, built once into the user's cache."""

import hashlib
import os
from pathlib import Path

import stridewire.motion
import stridewire_engine
from stridewire_engine.building.build import build_library
from stridewire_engine.building.gait.model import gait_coefficients
from stridewire_engine.building.synthetic import CREDIT, synthetic_clips
from stridewire_engine.library import Library, LibraryError


def embedded_library() -> Library:
    """Open the default library, building it first where the cache lacks it or it is broken."""
    path = _cache() / f"synthetic-{_fingerprint()}"
    try:
        library = Library.open(path)
        library.verify()
        return library
    except LibraryError:
        return build_library(
            synthetic_clips(),
            path,
            name="synthetic",
            synthetic=True,
            licence="Apache-2.0",
            credit=CREDIT,
        )


def _fingerprint() -> str:
    """Hash the code and coefficients that the library is made by: a change makes another."""
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
