"""From cleaned clips to a library folder."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from stridewire import __version__
from stridewire.motion import quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.mirror import mirror_clip
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import ClipEntry, Library, LibraryError, Manifest, write_library
from stridewire_engine.matching.features import clip_features, normalisation, startable_frames
from stridewire_engine.matching.schema import LOCOMOTION, Schema
from stridewire_engine.matching.search import typical_cost

FRAME_RATE = 60.0
"""Frames per second of every library."""


def build_library(
    clips: Sequence[Clip],
    out: Path | str,
    *,
    name: str,
    synthetic: bool = False,
    licence: str = "",
    credit: str = "",
    mirror: bool = True,
    schema: Schema = LOCOMOTION,
    build_command: str = "",
) -> Library:
    """Compute features and write a library folder, all or nothing.

    Args:
        clips: On the reference skeleton at 60 frames per second, names unique.
        out: The folder; an old library there is replaced.
        name: Name of the library.
        synthetic: True where the motion is generated, not captured.
        licence: Licence of the motion.
        credit: Credit line of the motion.
        mirror: Whether mirrored copies are added: twice the motion, left and right balanced.
        schema: What is matched.
        build_command: Command that builds it again; shown where it must be repaired.

    Raises:
        LibraryError: If clips are missing, alike in name, on another skeleton or rate, or all too
            short.
    """
    _check(clips)
    every = [*clips, *(mirror_clip(clip) for clip in clips)] if mirror else list(clips)
    entries = _entries(every)
    startable = np.concatenate([startable_frames(schema, clip) for clip in every])
    if not startable.any():
        raise LibraryError(
            f"every clip is shorter than the horizon of {schema.horizon:g} s, so no moment could "
            "be chosen; add longer clips"
        )
    raw = np.concatenate([clip_features(schema, clip) for clip in every])
    normal = normalisation(schema, raw)
    features = normal.apply(raw)
    clip_of = np.repeat(np.arange(len(every)), [len(clip) for clip in every])
    manifest = Manifest(
        name=name,
        frame_rate=FRAME_RATE,
        synthetic=synthetic,
        licence=licence,
        credit=credit,
        skeleton=REFERENCE,
        schema={
            **schema.to_data(),
            "mean": normal.mean.tolist(),
            "deviation": normal.deviation.tolist(),
            "typical_cost": typical_cost(schema, features, startable, clip_of),
        },
        clips=entries,
        arrays={},
        built_by=__version__,
        build_command=build_command,
    )
    arrays = {**_pose_arrays(every), "features": features, "startable": startable}
    write_library(out, manifest, arrays)
    return Library.open(out)


def _check(clips: Sequence[Clip]) -> None:
    if not clips:
        raise LibraryError("no clip was given; a library needs at least one")
    names = [clip.name for clip in clips]
    for clip in clips:
        if clip.skeleton != REFERENCE:
            raise LibraryError(
                f"clip {clip.name!r} is not on the reference skeleton; import it with "
                "`stridewire library build`, which retargets"
            )
        if clip.frame_rate != FRAME_RATE:
            raise LibraryError(
                f"clip {clip.name!r} has {clip.frame_rate:g} frames per second; expected "
                f"{FRAME_RATE:g}: resample it first"
            )
        if names.count(clip.name) > 1:
            raise LibraryError(f"two clips are called {clip.name!r}; names must be unique")


def _entries(clips: Sequence[Clip]) -> tuple[ClipEntry, ...]:
    starts = np.cumsum([0, *(len(clip) for clip in clips[:-1])])
    return tuple(
        ClipEntry(clip.name, int(start), len(clip), clip.source, clip.tags)
        for clip, start in zip(clips, starts, strict=True)
    )


def _pose_arrays(clips: Sequence[Clip]) -> dict[str, np.ndarray]:
    clips = [replace(clip, pose=clip.pose.astype(np.float64)) for clip in clips]
    yaws = [np.unwrap(quaternion.to_yaw(clip.pose.root_rotation)) for clip in clips]
    rotations = [quaternion.unroll(clip.pose.rotations) for clip in clips]
    return {
        "root_position": np.concatenate([c.pose.root_position for c in clips]).astype(np.float32),
        "root_yaw": np.concatenate(yaws).astype(np.float32),
        "hips": np.concatenate([clip.pose.hips for clip in clips]).astype(np.float32),
        "rotations": np.concatenate(rotations).astype(np.float32),
        "contacts": np.concatenate([clip.contacts for clip in clips]),
    }
