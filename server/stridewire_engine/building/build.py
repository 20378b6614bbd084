"""From cleaned clips to a library folder."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from stridewire import __version__
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.clip import Clip
from stridewire.motion.mirror import mirror_clip
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.library import ClipEntry, Library, LibraryError, Manifest, write_library
from stridewire_engine.matching import proof
from stridewire_engine.matching.candidates import EXACT_ROWS
from stridewire_engine.matching.features import (
    Normalisation,
    clip_features,
    normalisation,
    startable_frames,
)
from stridewire_engine.matching.inverted_lists import group_rows
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.matching.schema import Schema, SchemaError
from stridewire_engine.matching.search import Matcher, typical_cost

FRAME_RATE = 60.0
"""Frames per second of every library."""
_SEED = 20


@dataclass(frozen=True)
class MatchingOptions:
    """What is matched, and how a library's moments compare."""

    schema: Schema = LOCOMOTION
    custom: Mapping[str, Callable[[Clip], Floats]] = field(default_factory=dict)
    """For each custom channel by name, what gives its numbers `(T, size)`."""
    normalise_like: Library | None = None
    """Take mean and deviation from this library, so that costs compare across both."""
    bias_by_tag: Mapping[str, float] = field(default_factory=dict)
    """Cost of starting within a tag, in units of the typical cost; negative favours."""
    never_start: tuple[str, ...] = ()
    """Tags within which no search may start."""
    probe: Sequence[Clip] = ()
    """Motion of other people to try the index with; without any, generated motion."""


def build_library(
    clips: Sequence[Clip],
    out: Path | str,
    *,
    name: str,
    synthetic: bool = False,
    licence: str = "",
    credit: str = "",
    mirror: bool = True,
    matching: MatchingOptions | None = None,
    build_command: str = "",
) -> Library:
    """Compute features, index and prove them, and write a library folder, all or nothing.

    Args:
        clips: On the reference skeleton at 60 frames per second, names unique.
        out: The folder; an old library there is replaced.
        name: Name of the library.
        synthetic: True where the motion is generated, not captured.
        licence: Licence of the motion.
        credit: Credit line of the motion.
        mirror: Whether mirrored copies are added: twice the motion, left and right balanced.
        matching: What is matched; the preset `locomotion` by default.
        build_command: Command that builds it again; shown where it must be repaired.

    Raises:
        LibraryError: If clips are missing, alike in name, on another skeleton or rate, or too
            short.
        SchemaError: If the schema does not fit the clips.
    """
    _check(clips)
    matching = matching or MatchingOptions()
    every = [*clips, *(mirror_clip(clip) for clip in clips)] if mirror else list(clips)
    _check_tags(every, matching)
    raw = np.concatenate([clip_features(matching.schema, c, matching.custom) for c in every])
    normal = _normalisation(matching, raw)
    features = normal.apply(raw)
    startable = np.concatenate([_startable(clip, matching) for clip in every])
    if not startable.any():
        raise LibraryError(
            f"every clip is shorter than the horizon of {matching.schema.horizon:g} s or nothing "
            "else may be started, so no moment could be chosen; add longer clips"
        )
    clip_of = np.repeat(np.arange(len(every)), [len(clip) for clip in every])
    arrays = {**_pose_arrays(every), "features": features, "startable": startable}
    schema = {
        **matching.schema.to_data(),
        "mean": normal.mean.tolist(),
        "deviation": normal.deviation.tolist(),
        "typical_cost": typical_cost(matching.schema, features, startable, clip_of),
        "bias_by_tag": dict(matching.bias_by_tag),
        "never_start": list(matching.never_start),
    }
    if startable.sum() > EXACT_ROWS:
        grouping = group_rows(features[startable])
        arrays |= {"list_centroids": grouping.centroids, "lists": grouping.lists}
        schema["probes"] = 1
    manifest = Manifest(
        name=name,
        frame_rate=FRAME_RATE,
        synthetic=synthetic,
        licence=licence,
        credit=credit,
        skeleton=REFERENCE,
        schema=schema,
        clips=_entries(every),
        arrays={},
        built_by=__version__,
        build_command=build_command,
    )
    schema |= _prove(Library(Path(out), manifest, arrays), matching)
    write_library(out, manifest, arrays)
    return Library.open(out)


def _prove(library: Library, matching: MatchingOptions) -> dict[str, Any]:
    """Measure the index and return what goes into the schema: its proof, and how far it looks."""
    matcher = Matcher(library)
    if matcher.candidates.lists is None:
        return {"proof": proof.report(matcher, [])}
    others = matching.probe or synthetic_clips(seed=_SEED)
    raw = np.concatenate([clip_features(matcher.schema, c, matching.custom) for c in others])
    rng = np.random.default_rng(_SEED)
    queries = proof.probe_queries(matcher, matcher.normalisation.apply(raw), rng)
    cells = proof.tune_probes(matcher, queries, rng)
    return {
        "probes": matcher.candidates.lists.probes,
        "proof": proof.report(matcher, cells),
    }


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


def _check_tags(clips: Sequence[Clip], matching: MatchingOptions) -> None:
    known = {tag.name for clip in clips for tag in clip.tags}
    for tag in (*matching.bias_by_tag, *matching.never_start):
        if tag not in known:
            raise LibraryError(f"no clip has the tag {tag!r}; tags: {', '.join(sorted(known))}")


def _normalisation(matching: MatchingOptions, raw: Floats) -> Normalisation:
    if matching.normalise_like is None:
        return normalisation(matching.schema, raw)
    other = Matcher(matching.normalise_like)
    if [c.dimensions for c in other.schema.channels] != [
        c.dimensions for c in matching.schema.channels
    ]:
        raise SchemaError(
            f"library {other.library.name!r} has the schema {other.schema.name!r}; normalising "
            f"like it needs the same channels as {matching.schema.name!r}"
        )
    return other.normalisation


def _startable(clip: Clip, matching: MatchingOptions) -> Flags:
    flags = startable_frames(matching.schema, clip)
    for tag in clip.tags:
        if tag.name in matching.never_start:
            flags[tag.start : tag.end] = False
    return flags


def _entries(clips: Sequence[Clip]) -> tuple[ClipEntry, ...]:
    starts = np.cumsum([0, *(len(clip) for clip in clips[:-1])])
    return tuple(
        ClipEntry(clip.name, int(start), len(clip), clip.source, clip.tags, clip.loops)
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
