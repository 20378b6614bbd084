"""The manifest: what a library folder says about itself, and how it is read back with suspicion."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.motion.clip import TagSpan
from stridewire.motion.skeleton import Skeleton, SkeletonError

FORMAT = "stridewire-library"
FORMAT_VERSION = 1
MANIFEST_NAME = "manifest.json"


class LibraryError(ValueError):
    """A library folder cannot be used; the message says why and which command repairs it."""


@dataclass(frozen=True)
class ClipEntry:
    """Where a clip lies in the library's arrays."""

    name: str
    start: int
    """Row of its first frame."""
    frames: int
    source: str
    """File or generator that it came from."""
    tags: tuple[TagSpan, ...]
    """Named spans, in frames of the clip."""
    loops: bool = False
    """Whether the last frame is the first pose again, one lap on."""


@dataclass(frozen=True)
class ArrayEntry:
    """What an array file must look like."""

    dtype: str
    shape: tuple[int, ...]
    sha256: str


@dataclass(frozen=True)
class Manifest:
    """What a library folder says about itself."""

    name: str
    frame_rate: float
    synthetic: bool
    """True where the motion is generated, not captured."""
    licence: str
    credit: str
    skeleton: Skeleton
    schema: Mapping[str, Any]
    """The feature schema as data, with its normalisation; matching gives it a meaning."""
    clips: tuple[ClipEntry, ...]
    arrays: Mapping[str, ArrayEntry]
    built_by: str
    """Version of Stridewire that built it."""
    build_command: str
    """Command that builds it again."""

    @cached_property
    def frames(self) -> int:
        """Number of frames of all clips."""
        return sum(clip.frames for clip in self.clips)

    @cached_property
    def content_hash(self) -> str:
        """Hash of everything that a stream depends on."""
        text = json.dumps(
            [
                {name: entry.sha256 for name, entry in sorted(self.arrays.items())},
                [asdict(clip) for clip in self.clips],
                self.skeleton.hash,
                dict(self.schema),
            ],
            sort_keys=True,
        )
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def to_json(self) -> str:
        """Return the text of the manifest file."""
        skeleton = self.skeleton
        return json.dumps(
            {
                "format": FORMAT,
                "format_version": FORMAT_VERSION,
                "content_hash": self.content_hash,
                "name": self.name,
                "frame_rate": self.frame_rate,
                "synthetic": self.synthetic,
                "licence": self.licence,
                "credit": self.credit,
                "skeleton": {
                    "names": skeleton.names,
                    "parents": skeleton.parents,
                    "offsets": skeleton.offsets.tolist(),
                    "hash": skeleton.hash,
                },
                "schema": dict(self.schema),
                "clips": [asdict(clip) for clip in self.clips],
                "arrays": {name: asdict(entry) for name, entry in self.arrays.items()},
                "built_by": self.built_by,
                "build_command": self.build_command,
            },
            indent=1,
        )


def read_manifest(folder: Path) -> Manifest:
    """Read and check the manifest of a library folder.

    Raises:
        LibraryError: If there is none, or it is foreign, newer, stale or damaged.
    """
    path = folder / MANIFEST_NAME
    if not path.is_file():
        raise LibraryError(
            f"{folder} is not a library: it has no {MANIFEST_NAME}. Build one with "
            f"`stridewire library build INPUT... --out {folder}`"
        )
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise LibraryError(
            f"{path} is damaged ({error}). Build the library again: "
            f"`stridewire library build INPUT... --out {folder}`"
        ) from error
    _check_format(path, data)
    try:
        return _parse(data)
    except (KeyError, TypeError, ValueError, SkeletonError) as error:
        raise LibraryError(
            f"{path} is damaged ({type(error).__name__}: {error}). {repair(folder, data)}"
        ) from error


def repair(folder: Path, data: Mapping[str, Any]) -> str:
    """Return the sentence that says how to build a library again."""
    command = data.get("build_command") or f"stridewire library build INPUT... --out {folder}"
    return f"Build it again: `{command}`"


def _check_format(path: Path, data: Any) -> None:
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise LibraryError(
            f"{path} belongs to something else: its format is "
            f"{data.get('format') if isinstance(data, dict) else type(data).__name__!r}, "
            f"expected {FORMAT!r}. Give a folder that `stridewire library build` made"
        )
    version = data.get("format_version")
    if not isinstance(version, int) or version < FORMAT_VERSION:
        raise LibraryError(
            f"{path} has format version {version}, which is no longer read; expected "
            f"{FORMAT_VERSION}. {repair(path.parent, data)}"
        )
    if version > FORMAT_VERSION:
        raise LibraryError(
            f"{path} has format version {version}, newer than the {FORMAT_VERSION} that this "
            "version reads. Upgrade: `pip install --upgrade stridewire`"
        )


def _parse(data: Mapping[str, Any]) -> Manifest:
    skeleton = Skeleton(
        tuple(data["skeleton"]["names"]),
        tuple(data["skeleton"]["parents"]),
        np.array(data["skeleton"]["offsets"], np.float64),
    )
    manifest = Manifest(
        name=str(data["name"]),
        frame_rate=float(data["frame_rate"]),
        synthetic=bool(data["synthetic"]),
        licence=str(data["licence"]),
        credit=str(data["credit"]),
        skeleton=skeleton,
        schema=data["schema"],
        clips=tuple(
            ClipEntry(
                clip["name"],
                int(clip["start"]),
                int(clip["frames"]),
                clip["source"],
                tuple(TagSpan(**tag) for tag in clip["tags"]),
                bool(clip["loops"]),
            )
            for clip in data["clips"]
        ),
        arrays={
            name: ArrayEntry(entry["dtype"], tuple(entry["shape"]), entry["sha256"])
            for name, entry in data["arrays"].items()
        },
        built_by=str(data["built_by"]),
        build_command=str(data["build_command"]),
    )
    if manifest.content_hash != data["content_hash"]:
        raise ValueError("its content hash does not fit its content")
    return manifest
