"""A built library: what it holds, and how it refuses what it cannot trust."""

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stridewire._errors import NotFoundError
from stridewire.motion.clip import Clip
from stridewire_engine.building import build_library
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.library.manifest import MANIFEST_NAME

FLOAT32 = 1e-6


@pytest.fixture
def copy(small_library: Library, tmp_path: Path) -> Path:
    """Return a copy of a library that a test may spoil."""
    return Path(shutil.copytree(small_library.path, tmp_path / "copy"))


def change(folder: Path, edit: Callable[[dict], None]) -> None:
    """Edit a manifest on disk."""
    path = folder / MANIFEST_NAME
    data = json.loads(path.read_text())
    edit(data)
    path.write_text(json.dumps(data))


def test_a_clip_comes_back_as_it_went_in(swaying_clip: Clip, tmp_path: Path) -> None:
    """Poses, contacts, tags and source of a clip survive the way to disk and back."""
    library = build_library([swaying_clip], tmp_path / "one", name="one", mirror=False)
    clip = library.clip("sway")
    assert clip.tags == swaying_clip.tags
    assert clip.source == "test"
    assert np.array_equal(clip.contacts, swaying_clip.contacts)
    assert np.allclose(clip.pose.hips, swaying_clip.pose.hips, atol=FLOAT32)
    aligned = np.abs(np.sum(clip.pose.rotations * swaying_clip.pose.rotations, axis=-1))
    assert np.allclose(aligned, 1.0, atol=FLOAT32)


def test_mirrored_copies_double_the_motion(small_library: Library) -> None:
    """Each clip has a mirrored copy of the same length."""
    frames = {clip.name: clip.frames for clip in small_library.clips}
    plain = [name for name in frames if not name.endswith("-mirrored")]
    assert len(frames) == 2 * len(plain)
    assert all(frames[f"{name}-mirrored"] == frames[name] for name in plain)


def test_arrays_are_mapped_not_read(small_library: Library) -> None:
    """Opening a library does not copy its poses into memory."""
    library = Library.open(small_library.path)
    assert not library.rotations.flags.owndata
    assert not library.rotations.flags.writeable


def test_tags_at_a_row_are_those_of_its_spans(small_library: Library) -> None:
    """Tag bits say for each row which spans hold there."""
    entry = next(clip for clip in small_library.clips if clip.tags)
    tag = entry.tags[0]
    assert tag.name in small_library.tags_at(entry.start + tag.start)
    seconds = small_library.seconds_by_tag()
    assert set(seconds) == set(small_library.tag_names)
    assert list(seconds.values()) == sorted(seconds.values(), reverse=True)


def test_an_unknown_clip_is_answered_with_near_names(small_library: Library) -> None:
    """A mistyped clip name is refused with the names that it may have meant."""
    name = small_library.clips[0].name
    with pytest.raises(NotFoundError, match=name):
        small_library.clip(name[:-1] + "x")


def test_content_hash_depends_on_content(swaying_clip: Clip, tmp_path: Path) -> None:
    """Equal content gives equal hashes, other content others."""
    first, again, shorter = (
        build_library([clip], tmp_path / folder, name=folder)
        for folder, clip in (
            ("a", swaying_clip),
            ("b", swaying_clip),
            ("c", swaying_clip.cut(0, 110)),
        )
    )
    assert first.manifest.content_hash == again.manifest.content_hash
    assert first.manifest.content_hash != shorter.manifest.content_hash


def test_a_folder_without_manifest_is_refused(tmp_path: Path) -> None:
    """A folder that is no library is refused with the command that builds one."""
    with pytest.raises(LibraryError, match="stridewire library build"):
        Library.open(tmp_path)


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (lambda data: data.update(format="something"), "belongs to something else"),
        (lambda data: data.update(format_version=0), "no longer read"),
        (lambda data: data.update(format_version=99), "pip install --upgrade"),
        (lambda data: data.pop("clips"), "damaged"),
        (lambda data: data["clips"].pop(), "content hash"),
        (lambda data: data["skeleton"]["parents"].__setitem__(1, 7), "damaged"),
        (lambda data: data["arrays"].pop("hips"), "content hash"),
    ],
)
def test_a_manifest_that_lies_is_refused(
    copy: Path, edit: Callable[[dict], None], said: str
) -> None:
    """Foreign, stale, newer and damaged manifests are told apart."""
    change(copy, edit)
    with pytest.raises(LibraryError, match=said):
        Library.open(copy)


def test_a_manifest_that_is_no_json_is_refused(copy: Path) -> None:
    """A manifest cut in the middle is refused with the command that repairs."""
    path = copy / MANIFEST_NAME
    path.write_text(path.read_text()[:200])
    with pytest.raises(LibraryError, match="stridewire library build"):
        Library.open(copy)


def test_a_truncated_array_is_refused(copy: Path) -> None:
    """An array file that is shorter than its header says is refused when opened."""
    path = copy / "rotations.npy"
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(LibraryError, match="truncated"):
        Library.open(copy)


def test_a_missing_array_is_refused(copy: Path) -> None:
    """A missing array file is refused when opened."""
    (copy / "features.npy").unlink()
    with pytest.raises(LibraryError, match="missing or truncated"):
        Library.open(copy)


def test_an_array_of_another_shape_is_refused(copy: Path) -> None:
    """An array that was exchanged for another one is refused when opened."""
    np.save(copy / "hips.npy", np.zeros((3, 3), np.float32))
    with pytest.raises(LibraryError, match="manifest says"):
        Library.open(copy)


def test_verifying_finds_a_changed_number(copy: Path) -> None:
    """A number changed in place passes the opening and fails the verification."""
    path = copy / "hips.npy"
    data = bytearray(path.read_bytes())
    data[-1] ^= 1
    path.write_bytes(data)
    library = Library.open(copy)
    with pytest.raises(LibraryError, match="was changed"):
        library.verify()


def test_building_never_replaces_what_is_no_library(swaying_clip: Clip, tmp_path: Path) -> None:
    """A folder with other things in it is left alone."""
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(LibraryError, match="not a library"):
        build_library([swaying_clip], tmp_path, name="x")
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_building_replaces_an_old_library_whole(swaying_clip: Clip, tmp_path: Path) -> None:
    """Building again over a library leaves the new one and nothing beside it."""
    build_library([swaying_clip], tmp_path / "lib", name="old")
    library = build_library([swaying_clip], tmp_path / "lib", name="new", mirror=False)
    assert library.name == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["lib"]


def test_a_failed_build_leaves_nothing(
    swaying_clip: Clip, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If writing fails half way, neither a library nor a half of one is left."""
    calls = iter([None, None])

    def save(*args: object, **kwargs: object) -> None:
        if next(calls, "full") == "full":
            raise OSError("No space left on device")
        Path(str(args[0])).write_bytes(b"half")

    monkeypatch.setattr(np, "save", save)
    with pytest.raises(OSError, match="No space"):
        build_library([swaying_clip], tmp_path / "lib", name="x")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("twist", ["none", "names", "rate", "short"])
def test_unusable_clips_are_refused(swaying_clip: Clip, tmp_path: Path, twist: str) -> None:
    """No clips, equal names, another rate and clips below the horizon are refused by name."""
    clips, said = {
        "none": ([], "at least one"),
        "names": ([swaying_clip, swaying_clip], "two clips"),
        "rate": ([replace(swaying_clip, frame_rate=30.0)], "resample"),
        "short": ([swaying_clip.cut(0, 40)], "shorter than the horizon"),
    }[twist]
    with pytest.raises(LibraryError, match=said):
        build_library(clips, tmp_path / "lib", name="x")
