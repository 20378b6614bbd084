"""Writing a library: all or nothing."""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire_engine.library.manifest import (
    MANIFEST_NAME,
    ArrayEntry,
    LibraryError,
    Manifest,
)


def write_library(path: Path | str, manifest: Manifest, arrays: Mapping[str, Floats]) -> None:
    """Write a library folder under a temporary name and then rename it.

    A reader sees the old folder or the new one, never a half; a library that was there is replaced,
    anything else is refused.

    Args:
        path: The folder.
        manifest: What it says about itself; its `arrays` are filled in here.
        arrays: `(F, …)` arrays by name.

    Raises:
        LibraryError: If `path` exists and is no library.
    """
    target = Path(path).absolute()
    if target.exists() and not (target / MANIFEST_NAME).is_file() and not _is_empty(target):
        raise LibraryError(
            f"{target} exists and is not a library; give --out a new folder or an old library"
        )
    target.parent.mkdir(parents=True, exist_ok=True)
    part = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        entries = {name: _write_array(part, name, array) for name, array in arrays.items()}
        text = replace(manifest, arrays=entries).to_json()
        (part / MANIFEST_NAME).write_text(text, encoding="utf-8")
        _put_in_place(part, target)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        raise


def _write_array(folder: Path, name: str, array: Floats) -> ArrayEntry:
    path = folder / f"{name}.npy"
    np.save(path, np.ascontiguousarray(array), allow_pickle=False)
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return ArrayEntry(array.dtype.str, tuple(array.shape), digest)


def _put_in_place(part: Path, target: Path) -> None:
    part.chmod(0o755)
    if not target.exists():
        os.rename(part, target)
        return
    old = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    os.rename(target, old / "old")
    os.rename(part, target)
    shutil.rmtree(old)


def _is_empty(folder: Path) -> bool:
    return folder.is_dir() and not any(folder.iterdir())
