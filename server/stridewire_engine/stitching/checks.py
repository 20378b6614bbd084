"""What may be wrong with a request to stitch, told by field."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from stridewire._errors import Violation
from stridewire._messages import ClipSpan, RootPath, StitchQuery
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import CONTACT_JOINTS, Skeleton
from stridewire_engine.stitching.methods import method_names

MIN_CLIPS, MAX_CLIPS = 2, 64
SHORTEST = 10
"""Frames at 60 frames/s that a clip has at least."""
SHORTEST_S = (SHORTEST - 1) / 60.0
"""The same in seconds from the first to the last frame."""
MAX_FRAMES = 200_000
"""Of all clips together."""
MAX_SEARCH = 60
_MAX_PASSES = 8
_MAX_COORDINATE = 1e6
_MAX_PATH = 100_000
_NORM_TOLERANCE = 1e-2
_LEGS = [f"{side}{part}" for side in ("Left", "Right") for part in ("UpLeg", "Leg", "Foot", "Toe")]


def check_query(query: StitchQuery) -> Iterator[Violation]:
    """Yield what is wrong with numbers and names, before any clip is looked up."""
    count = len(query.clips)
    if not MIN_CLIPS <= count <= MAX_CLIPS:
        yield Violation(
            "clips",
            f"{count} clips; allowed are {MIN_CLIPS} to {MAX_CLIPS}: stitch more in several calls",
        )
        return
    if query.stitcher not in method_names():
        yield Violation("stitcher", f"{query.stitcher!r}; there are {', '.join(method_names())}")
    yield from _check_windows(query)
    if not 0 <= query.search_frames <= MAX_SEARCH:
        yield Violation(
            "search_frames", f"{query.search_frames}; allowed are 0, no search, to {MAX_SEARCH}"
        )
    if not 0.0 <= query.strength <= 1.0:
        yield Violation("strength", f"{query.strength:g}; allowed are 0 to 1")
    for name, value in (("start_s", query.start_s), ("end_s", query.end_s)):
        if not 0.0 <= value < np.inf:
            yield Violation(name, f"{value:g}; allowed are seconds from 0")
    if query.end_s and query.end_s <= query.start_s:
        yield Violation("end_s", f"{query.end_s:g} is not after start_s, {query.start_s:g}")
    if query.path is not None:
        yield from _check_path("path", query.path)
    for i, source in enumerate(query.clips):
        if isinstance(source, Clip):
            yield from _check_inline(f"clips[{i}].inline", source)
        elif isinstance(source, ClipSpan) and not source.clip:
            yield Violation(f"clips[{i}].span.clip", "empty; give the name of a clip")


def check_clips(
    query: StitchQuery, paths: Sequence[str], clips: Sequence[Clip]
) -> Iterator[Violation]:
    """Yield what is wrong with clips of one skeleton at 60 frames/s, and with what names them.

    Args:
        query: The request.
        paths: Of the clips' fields.
        clips: As they were found.
    """
    skeleton = clips[0].skeleton
    yield from _check_legs(paths[0], skeleton)
    for path, clip in zip(paths, clips, strict=True):
        if len(clip) < SHORTEST:
            yield Violation(
                path,
                f"{len(clip)} frames at {clip.frame_rate:g} frames/s; expected at least {SHORTEST}",
            )
    frames = sum(map(len, clips))
    if frames > MAX_FRAMES:
        yield Violation("clips", f"{frames} frames in all; allowed are {MAX_FRAMES}")
    yield from _check_mask(query.joint_mask, skeleton)
    end_s = (frames - 1) / clips[0].frame_rate
    if query.path is not None and query.path.times_s[-1] < end_s - 1e-6:
        yield Violation(
            "path.times_s", f"ends at {query.path.times_s[-1]:g} s; the motion lasts {end_s:g} s"
        )


def _check_windows(query: StitchQuery) -> Iterator[Violation]:
    if not 0.1 <= query.window_s <= 2.0:
        yield Violation("window_s", f"{query.window_s:g}; allowed are 0.1 to 2 seconds")
    elif not 0.0 < query.shift <= query.window_s:
        yield Violation(
            "shift_s",
            f"{query.shift:g}; allowed are more than 0 to window_s, {query.window_s:g}: "
            "windows must follow each other without gaps",
        )
    if not 1 <= query.passes <= _MAX_PASSES:
        yield Violation("passes", f"{query.passes}; allowed are 1 to {_MAX_PASSES}")


def _check_path(field: str, path: RootPath) -> Iterator[Violation]:
    positions, times = np.asarray(path.positions_xz), np.asarray(path.times_s)
    count = times.size
    if not 2 <= count <= _MAX_PATH or positions.shape != (count, 2) or times.ndim != 1:
        yield Violation(
            f"{field}.positions_xz",
            f"shape {positions.shape} for {count} times; expected x and z for each, 2 to "
            f"{_MAX_PATH} points",
        )
        return
    if not np.all(np.abs(positions) <= _MAX_COORDINATE):
        yield Violation(f"{field}.positions_xz", "a value is not finite or above 1e6 metres")
    if not np.all(np.isfinite(times)) or times[0] != 0.0 or not np.all(np.diff(times) > 0.0):
        yield Violation(f"{field}.times_s", "expected ascending seconds from 0")
    if path.facings_yaw is not None:
        facings = np.asarray(path.facings_yaw)
        if facings.shape != (count,) or not np.all(np.isfinite(facings)):
            yield Violation(
                f"{field}.facings_yaw", f"expected none or {count} finite angles in radians"
            )


def _check_inline(field: str, clip: Clip) -> Iterator[Violation]:
    if not 1.0 <= clip.frame_rate <= 1000.0:
        yield Violation(
            f"{field}.frame_rate_hz", f"{clip.frame_rate:g}; allowed are 1 to 1000 frames/s"
        )
    yield from _check_legs(field, clip.skeleton)
    pose = clip.pose
    for name, values in (("root", pose.root_position), ("hips", pose.hips)):
        if not np.all(np.abs(values) <= _MAX_COORDINATE):
            yield Violation(f"{field}.poses.{name}", "a value is above 1e6 metres")
    for name, values in (("root", pose.root_rotation), ("rotations", pose.rotations)):
        length = np.linalg.norm(values, axis=-1)
        if not np.all(np.abs(length - 1.0) <= _NORM_TOLERANCE):
            yield Violation(f"{field}.poses.{name}", "a quaternion w x y z is not of unit length")


def _check_legs(field: str, skeleton: Skeleton) -> Iterator[Violation]:
    missing = sorted({*_LEGS, *CONTACT_JOINTS} - set(skeleton.names))
    if missing:
        yield Violation(field, f"its skeleton lacks {', '.join(missing)}; feet need them")


def _check_mask(mask: Mapping[str, float], skeleton: Skeleton) -> Iterator[Violation]:
    for name, share in mask.items():
        if name not in skeleton.names:
            yield Violation(
                f"joint_mask[{name}]", f"no such joint; there are {', '.join(skeleton.names)}"
            )
        elif not 0.0 <= share <= 1.0:
            yield Violation(f"joint_mask[{name}]", f"{share:g}; allowed are 0 to 1")
