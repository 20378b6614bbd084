"""What stitching as a service and as a command must show: pace, memory, what is refused."""

import resource
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from points import Point

from stridewire import Client, ClipSpan, InvalidRequestError, StitchHeader, StitchQuery
from stridewire._messages import BvhText, StitchReport
from stridewire.motion.clip import Clip, ClipError, Pose
from stridewire_engine.building import open_library
from stridewire_engine.library import Library
from stridewire_engine.networks.onnx_model import ModelError, OnnxModel
from stridewire_engine.networks.rmr import Refiner

_CLIPS, _FRAMES = 30, 1000
_RATE = 60.0


def pace() -> Iterator[Point]:
    """Thirty clips of a thousand frames: faster than real time, in bounded memory.

    It works in one thread, so that the processor's time is what it takes on a core that is free.
    """
    clips = _long_clips(open_library())
    with Client.in_process() as client:
        for stitcher in ("stance", "refine"):
            before, wall, busy = _peak_mb(), time.perf_counter(), time.process_time()
            header, *poses, report = client.stitch_parts(StitchQuery(clips, stitcher))
            wall, busy = time.perf_counter() - wall, time.process_time() - busy
            assert isinstance(header, StitchHeader)
            assert isinstance(report, StitchReport)
            seconds = header.frames / _RATE
            used = ", ".join(sorted({seam.method for seam in report.seams}))
            what = f"{_CLIPS} clips, {header.frames} frames, {stitcher} (by {used})"
            times = seconds / busy
            yield Point(
                f"Stitch of {what}", f"{times:.0f} times real time", "at least 100", times >= 100.0
            )
            yield Point(f"the same by the clock on the wall: {what}", f"{seconds / wall:.0f} times")
            longest = max(len(part.hips) for part in poses if isinstance(part, Pose))
            yield Point("frames of the longest part", str(longest), "at most 2000", longest <= 2000)
            yield Point("memory beside what was there", f"{_peak_mb() - before:.0f} MB")


def untouched() -> Iterator[Point]:
    """Poses away from seams, bit by bit, for every stitcher."""
    library = open_library()
    clips = [library.clip(name).cut(60, 260) for name in ("walk-1.4", "run-3.0", "walk-0.8")]
    rotations = np.concatenate([clip.pose.rotations for clip in clips])
    with Client.in_process() as client:
        for stitcher in ("spring", "quintic", "dead-blend", "stance", "refine"):
            made = client.stitch(clips, stitcher=stitcher)
            frames = np.arange(len(rotations))
            seams = [seam.frame for seam in made.report.seams]
            far = np.all([(frames < seam) | (frames >= seam + 90) for seam in seams], axis=0)
            wrong = np.count_nonzero(made.clip.pose.rotations[far] != rotations[far])
            yield Point(f"numbers changed more than 1.5 s from a seam, {stitcher}", str(wrong), "0",
                        wrong == 0)  # fmt: skip


def refused() -> Iterator[Point]:
    """Bad input gives a sentence that names the field."""
    library = open_library()
    good = ClipSpan("walk-1.4", 1.0, 3.0)
    walk = library.clip("walk-1.4")
    cases: list[tuple[str, Sequence[ClipSpan | Clip | BvhText], dict[str, object], str]] = [
        (f"a clip of {n} frames", [good, walk.cut(0, n)], {}, "clips[1]") for n in range(1, 10)
    ]
    cases += [
        ("10,000 clips", [good] * 10_000, {}, "clips"),
        ("one clip", [good], {}, "clips"),
        ("text that is no BVH", [good, BvhText("nothing")], {}, "clips[1].bvh"),
        (
            "a window shorter than the shift",
            [good] * 2,
            {"window_s": 0.3, "shift_s": 0.5},
            "shift_s",
        ),
        ("zero passes", [good] * 2, {"passes": 0}, "passes"),
    ]
    with Client.in_process() as client:
        for what, clips, given, field in cases:
            query = StitchQuery(clips, **given)  # type: ignore[arg-type]
            yield Point(f"{what} is refused by name", said := _refusal(client, query), field,
                        said == field)  # fmt: skip
    try:
        Clip("bad", walk.skeleton, _RATE, _with_nan(walk.pose[:20]), walk.contacts[:20])
        said = "accepted"
    except ClipError as error:
        said = str(error)
    yield Point("a clip with NaN", said, "refused", "not finite" in said)


def models() -> Iterator[Point]:
    """A model file that is broken or foreign gives a clear error when it is opened."""
    with tempfile.TemporaryDirectory() as folder:
        broken = Path(folder) / "rmr.onnx"
        broken.write_bytes(b"not a model")
        foreign = Path(__file__).parents[2] / "models/stridewire_models/weights/blend.onnx"
        for what, path in (("corrupt", broken), ("foreign", foreign)):
            try:
                Refiner(OnnxModel(path.name, path.read_bytes()))
                said = "accepted"
            except ModelError as error:
                said = str(error)
            yield Point(f"a {what} model", said[:90], "refused, saying what to do",
                        "export it again" in said or "train and export" in said)  # fmt: skip


def _long_clips(library: Library) -> list[Clip]:
    """Return thirty clips of a thousand frames, made of the library's longest ones."""
    found = sorted(library.clips, key=lambda c: -c.frames)[:_CLIPS]
    clips = []
    for entry in found:
        clip = library.clip(entry.name)
        there = np.abs((np.arange(_FRAMES) % (2 * len(clip) - 2)) - (len(clip) - 1))
        clips.append(Clip(entry.name, clip.skeleton, _RATE, clip.pose[there], clip.contacts[there]))
    return clips


def _with_nan(pose: Pose) -> Pose:
    hips = pose.hips.copy()
    hips[3, 0] = np.nan
    return Pose(pose.root_position, pose.root_rotation, hips, pose.rotations)


def _refusal(client: Client, query: StitchQuery) -> str:
    try:
        list(client.stitch_parts(query))
    except InvalidRequestError as error:
        return ", ".join(violation.field for violation in error.violations)
    return "accepted"


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
