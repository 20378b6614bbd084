"""Compiled: hot passes of the tick as loops over characters, in machine code.

Each kernel here does what a function of numpy passes does elsewhere. That function is the
reference, which tests compare with, and what runs where numba is absent or
`STRIDEWIRE_COMPILED=0` is set. Kernels take arrays and named tuples of arrays, one row a character;
they let other threads run meanwhile. numba's own rule that only a function's own file counts would
keep stale code, so the cache's folder is named after the contents of all files here.
"""

import atexit
import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from contextlib import suppress
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar, cast

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

ENABLED = find_spec("numba") is not None and os.environ.get("STRIDEWIRE_COMPILED", "1") != "0"
"""Whether kernels run; callers ask each time, so that one process can compare both ways."""


def kernel(function: FunctionT) -> FunctionT:
    """Compile a function when it is first called; machine code is kept between processes."""
    if not ENABLED:
        return function
    import numba

    config: Any = numba.config
    before, config.CACHE_DIR = config.CACHE_DIR, str(_CACHE)
    # without inlining every call would count references to every array of its named tuples
    how: Any = {"cache": True, "nogil": True, "error_model": "numpy", "forceinline": True}
    try:
        compiled = numba.njit(**how)(function)
    finally:
        config.CACHE_DIR = before
    return cast(FunctionT, compiled)


def _cache() -> Path:
    """Return the folder of machine code made of these files by this numba; a copy if read-only.

    Like the embedded library's, it is below the user's cache folder.
    """
    digest = hashlib.sha256(version("numba").encode())
    for file in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(file.read_bytes())
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = Path(home) / "stridewire" / f"compiled-{digest.hexdigest()[:16]}"
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    if os.access(folder, os.W_OK):
        return folder
    temporary = tempfile.mkdtemp(prefix="stridewire-")
    atexit.register(shutil.rmtree, temporary, ignore_errors=True)
    copy = Path(temporary) / folder.name
    if folder.is_dir():
        # numba reads only where it could write
        shutil.copytree(folder, copy)
    return copy


_CACHE = _cache() if ENABLED else Path()
