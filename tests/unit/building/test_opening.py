"""Opening a library of any kind: built, motion files, the embedded default."""

from pathlib import Path

import pytest

from stridewire.formats.bvh_writing import write_bvh
from stridewire_engine.building import open_library
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.library import Library, LibraryError


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a test a cache of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_a_built_library_is_opened_where_it_is(small_library: Library, cache: Path) -> None:
    """Nothing is built for a folder that is a library."""
    assert open_library(small_library.path).path == small_library.path
    assert not cache.exists()


def test_motion_files_are_imported_once(tmp_path: Path, cache: Path) -> None:
    """A folder of motion files becomes a library in the cache, anew only when a file changes."""
    clip = next(clip for clip in synthetic_clips() if clip.name == "walk-1.4")
    folder = tmp_path / "walks"
    folder.mkdir()
    write_bvh(folder / "one.bvh", clip)
    library = open_library(folder)
    assert library.name == "walks"
    assert not library.info().synthetic
    assert open_library(folder).path == library.path
    write_bvh(folder / "two.bvh", clip.cut(0, 200))
    assert open_library(folder).path != library.path


def test_a_folder_of_nothing_is_refused_with_the_command(tmp_path: Path) -> None:
    """A folder without motion files is told how a library is built."""
    with pytest.raises(LibraryError, match="stridewire library build"):
        open_library(tmp_path)


def test_files_that_cannot_be_used_are_told(tmp_path: Path) -> None:
    """If every file is refused, the first reason is said."""
    (tmp_path / "broken.bvh").write_text("MOTION\n")
    with pytest.raises(LibraryError, match=r"none of the 1 motion files.*broken\.bvh"):
        open_library(tmp_path)
