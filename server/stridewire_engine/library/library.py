"""An open library: memory-mapped arrays and the clips in them."""

import difflib
import hashlib
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stridewire._errors import NotFoundError
from stridewire._messages import LibraryInfo
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.mirror import MIRRORED
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.library.manifest import (
    ClipEntry,
    LibraryError,
    Manifest,
    read_manifest,
    repair,
)


class StoredGrouping(NamedTuple):
    """Startable rows grouped by nearness."""

    centroids: Floats
    """`(L, D)` float32 in normalised features."""
    lists: Indices
    """`(M,)` int32 list of each startable row."""
    probes: int
    """Number of lists that a search looks into, found by measurement."""


class Library:
    """Clips on one skeleton at one frame rate, read-only, one after the other in arrays."""

    def __init__(self, path: Path, manifest: Manifest, arrays: Mapping[str, Any]) -> None:
        self.path = path
        self.manifest = manifest
        self.root_position: Vectors = arrays["root_position"]
        """`(F, 3)` float32 on the ground, in each clip's own space, metres."""
        self.root_yaw: Floats = arrays["root_yaw"]
        """`(F,)` float32 radians, unrolled along each clip."""
        self.hips: Vectors = arrays["hips"]
        """`(F, 3)` float32 relative to the root, metres."""
        self.rotations: Quaternions = arrays["rotations"]
        """`(F, J, 4)` float32 local rotations, in one hemisphere along each clip."""
        self.contacts: Flags = arrays["contacts"].astype(np.bool_, copy=False)
        """`(F, 4)` bool: left foot, left toe, right foot, right toe."""
        self.features: Floats = arrays["features"]
        """`(F, D)` float32 normalised features; D and their meaning by the schema."""
        self.grouping: StoredGrouping | None = None
        """Rows grouped into lists, for libraries too large to be scanned."""
        if "list_centroids" in arrays:
            probes = int(manifest.schema["probes"])
            self.grouping = StoredGrouping(arrays["list_centroids"], arrays["lists"], probes)
        self.startable: Flags = arrays["startable"].astype(np.bool_, copy=False)
        """`(F,)` bool: may be chosen by a search; false where the future is not known."""

    @classmethod
    def open(cls, path: Path | str) -> "Library":
        """Open a library folder without reading its arrays.

        Raises:
            LibraryError: If it is missing, foreign, newer, stale, truncated or damaged; the message
                has the command that repairs it.
        """
        folder = Path(path)
        manifest = read_manifest(folder)
        arrays = {name: _map(folder, name, manifest) for name in manifest.arrays}
        missing = {
            "root_position",
            "root_yaw",
            "hips",
            "rotations",
            "contacts",
            "features",
            "startable",
        } - set(arrays)
        if missing:
            raise LibraryError(
                f"{folder} lacks the arrays {', '.join(sorted(missing))}. "
                f"{_repair(folder, manifest)}"
            )
        return cls(folder, manifest, arrays)

    def verify(self) -> None:
        """Read every array and compare it with its hash.

        Raises:
            LibraryError: If one differs.
        """
        for name, entry in self.manifest.arrays.items():
            if _sha256(self.path / f"{name}.npy") != entry.sha256:
                raise LibraryError(
                    f"{self.path / name}.npy was changed since it was built. "
                    f"{_repair(self.path, self.manifest)}"
                )

    @property
    def name(self) -> str:
        """Name of the library."""
        return self.manifest.name

    @property
    def skeleton(self) -> Skeleton:
        """Skeleton of all clips."""
        return self.manifest.skeleton

    @property
    def frame_rate(self) -> float:
        """Frames per second of all clips."""
        return self.manifest.frame_rate

    @property
    def clips(self) -> tuple[ClipEntry, ...]:
        """The clips, in the order of the arrays."""
        return self.manifest.clips

    @cached_property
    def clip_starts(self) -> Indices:
        """`(C,)` row of each clip's first frame."""
        return np.array([clip.start for clip in self.clips], np.int64)

    @cached_property
    def clip_frames(self) -> Indices:
        """`(C,)` number of frames of each clip."""
        return np.array([clip.frames for clip in self.clips], np.int64)

    @cached_property
    def loops(self) -> Flags:
        """`(C,)` clips that loop."""
        return np.array([clip.loops for clip in self.clips], np.bool_)

    @cached_property
    def laps(self) -> Floats:
        """`(C, 3)` x, z and yaw of a clip's last root as seen from its first, float64."""
        first, last = self.clip_starts, self.clip_starts + self.clip_frames - 1
        way = self.root_position[last].astype(np.float64) - self.root_position[first]
        yaw = self.root_yaw[first].astype(np.float64)
        sine, cosine = np.sin(yaw), np.cos(yaw)
        return np.stack(
            [
                way[:, 0] * cosine - way[:, 2] * sine,
                way[:, 0] * sine + way[:, 2] * cosine,
                self.root_yaw[last] - yaw,
            ],
            axis=-1,
        )

    @cached_property
    def twins(self) -> Indices:
        """`(C,)` index of each clip's mirrored copy or original; -1 where there is none."""
        index = self._index_by_name
        names = [clip.name for clip in self.clips]
        partners = [
            name.removesuffix(MIRRORED) if name.endswith(MIRRORED) else f"{name}{MIRRORED}"
            for name in names
        ]
        return np.array([index.get(partner, -1) for partner in partners], np.int64)

    @cached_property
    def clip_of(self) -> Indices:
        """`(F,)` index of the clip that each row belongs to."""
        return np.repeat(np.arange(len(self.clips)), self.clip_frames)

    @cached_property
    def tag_names(self) -> tuple[str, ...]:
        """All tags, sorted; the order of the bits in `tag_bits`."""
        return tuple(sorted({tag.name for clip in self.clips for tag in clip.tags}))

    @cached_property
    def tag_bits(self) -> Indices:
        """`(F,)` uint64 with a bit for each tag that holds."""
        bits = np.zeros(len(self.root_yaw), np.uint64)
        for clip in self.clips:
            for tag in clip.tags:
                bit = np.uint64(1 << self.tag_names.index(tag.name))
                bits[clip.start + tag.start : clip.start + tag.end] |= bit
        return bits

    def tags_at(self, row: int) -> tuple[str, ...]:
        """Return the tags that hold at a row."""
        bits = int(self.tag_bits[row])
        return tuple(name for i, name in enumerate(self.tag_names) if bits >> i & 1)

    def entry(self, name: str) -> ClipEntry:
        """Return where a clip lies.

        Raises:
            NotFoundError: If there is no such clip; the message names near ones.
        """
        index = self._index_by_name.get(name)
        if index is None:
            near = difflib.get_close_matches(name, self._index_by_name, 3, 0.4)
            hint = f"did you mean {', '.join(near)}?" if near else "list them with `library info`"
            raise NotFoundError(f"library {self.name!r} has no clip {name!r}; {hint}")
        return self.clips[index]

    def clip(self, name: str) -> Clip:
        """Return a clip as a view of the arrays.

        Raises:
            NotFoundError: If there is no such clip.
        """
        entry = self.entry(name)
        span = slice(entry.start, entry.start + entry.frames)
        pose = Pose(
            self.root_position[span],
            quaternion.from_yaw(self.root_yaw[span]),
            self.hips[span],
            self.rotations[span],
        )
        return Clip(
            entry.name,
            self.skeleton,
            self.frame_rate,
            pose,
            self.contacts[span],
            entry.tags,
            entry.source,
            entry.loops,
        )

    def info(self) -> LibraryInfo:
        """Return the library in a few words."""
        manifest = self.manifest
        return LibraryInfo(
            name=manifest.name,
            content_hash=manifest.content_hash,
            clips=len(manifest.clips),
            frames=manifest.frames,
            frame_rate_hz=manifest.frame_rate,
            synthetic=manifest.synthetic,
            licence=manifest.licence,
            credit=manifest.credit,
            schema=str(manifest.schema["name"]),
        )

    def seconds_by_tag(self) -> dict[str, float]:
        """Return how many seconds each tag holds, most first."""
        seconds = {
            name: float(np.count_nonzero(self.tag_bits >> np.uint64(i) & np.uint64(1)))
            / self.frame_rate
            for i, name in enumerate(self.tag_names)
        }
        return dict(sorted(seconds.items(), key=lambda item: -item[1]))

    @cached_property
    def _index_by_name(self) -> dict[str, int]:
        return {clip.name: i for i, clip in enumerate(self.clips)}


def _map(folder: Path, name: str, manifest: Manifest) -> Floats:
    entry = manifest.arrays[name]
    path = folder / f"{name}.npy"
    try:
        mapped = np.load(path, mmap_mode="r", allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise LibraryError(
            f"{path} is missing or truncated ({error}). {_repair(folder, manifest)}"
        ) from error
    if mapped.dtype.str != entry.dtype or mapped.shape != entry.shape:
        raise LibraryError(
            f"{path} holds {mapped.dtype.str} {mapped.shape}; the manifest says {entry.dtype} "
            f"{entry.shape}. {_repair(folder, manifest)}"
        )
    # the plain view indexes faster than numpy's memmap subclass and stays mapped
    return np.asarray(mapped)


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _repair(folder: Path, manifest: Manifest) -> str:
    return repair(folder, {"build_command": manifest.build_command})
