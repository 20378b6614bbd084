"""Machine code is kept between processes, also where nothing can be written beside it."""

import os
from pathlib import Path

import pytest

from stridewire_engine import compiled

pytest.importorskip("numba")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a cache folder of the test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


def test_it_lies_below_the_users_cache(home: Path) -> None:
    """The folder is named after the sources, so that it is the same every time."""
    folder = compiled._cache()
    assert folder.is_dir()
    assert folder.parent == home / "stridewire"
    assert folder == compiled._cache()


def test_what_cannot_be_written_is_copied(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A read-only folder, as in a container, is read from a copy elsewhere."""
    folder = compiled._cache()
    (folder / "kernel.nbi").write_bytes(b"machine code")
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    copy = compiled._cache()
    assert home not in copy.parents
    assert (copy / "kernel.nbi").read_bytes() == b"machine code"
