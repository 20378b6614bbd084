"""What import claims, over every file of the capture.

`STRIDEWIRE_DATA=DIR python tests/show/importing.py`, with the archives or what is in them, and
`split.csv`. Writes the table of all files to `build/show/import-files.csv`, libraries and what was
streamed from them to `build/show/libraries`. The synthetic library's points (`gait.py`) follow.
"""

import csv
import os
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import gait
import numpy as np
from capture import BUILD, capture
from import_figures import Family, measure, outcomes
from import_libraries import libraries, own_file
from points import ROOT, Point, show

from stridewire.formats.bvh_writing import write_bvh, write_source_bvh
from stridewire.formats.reading import read_motion
from stridewire.motion import kinematics
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.importing import import_file, motion_files


def every_file() -> Iterator[Point]:
    """Each file becomes a clip or a sentence."""
    paths = motion_files([capture()])
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "import-files.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("file", "imported", "profile", "unit", "seconds", "notes or reason"))
        for outcome in outcomes():
            name = outcome.path.relative_to(capture())
            clip = outcome.clip
            seconds = f"{clip.seconds:.2f}" if clip else ""
            said = "; ".join(outcome.notes) if clip else outcome.problem
            row = (name, clip is not None, outcome.profile, outcome.unit, seconds, said)
            writer.writerow(row)
    refused = [outcome for outcome in outcomes() if outcome.clip is None]
    known = len(outcomes()) - len(refused)
    yield Point(
        "every file is imported or refused with a reason",
        f"{known} imported, {len(refused)} refused of {len(paths)}",
        "none crashes, none missing",
        len(outcomes()) == len(paths) and all(outcome.problem for outcome in refused),
    )
    units = Counter(outcome.unit for outcome in outcomes() if outcome.clip)
    yield Point(
        "every imported file's unit makes its hips as high as a human's",
        ", ".join(f"{unit} {count}" for unit, count in units.most_common()),
        "0.7 to 1.1 m, else refused",
        "" not in units,
    )
    finite = all(
        np.isfinite(outcome.clip.pose.rotations).all() for outcome in outcomes() if outcome.clip
    )
    yield Point("all numbers of all clips are finite", str(finite), "True", finite)


def families() -> Iterator[Point]:
    """Limbs point as the source's, planted toes stay as planted."""
    by_profile: dict[str, list[Family]] = defaultdict(list)
    for outcome in outcomes():
        if outcome.clip is not None:
            measured = measure(outcome.path)
            if measured is not None:
                by_profile[outcome.profile].append(measured)
    for profile, files in sorted(by_profile.items()):
        family = Family.together(files)
        yield Point(
            f"limb directions, {profile} ({len(files)} files)",
            f"{family.limbs:.2f} degrees",
            "within 1 degree, mean",
            family.limbs <= 1.0,
        )
        yield Point(
            f"planted toes, {profile} ({family.planted} frames)",
            f"{family.slide:.2f} cm/s, source {family.source_slide:.2f}",
            "at most 1.1 times the source's",
            family.slide <= 1.1 * family.source_slide + 0.05,
        )


def round_trips() -> Iterator[Point]:
    """BVH to library and back, and every file by conversion on its own skeleton."""
    walks = (o.clip for o in outcomes() if o.clip and "walk" in o.path.stem)
    clip = next(walk for walk in walks if walk.seconds > 5.0)
    path = BUILD / "round-trip.bvh"
    for rate in (30, 60, 120):
        times = np.arange(int(clip.seconds * rate)) / rate
        pose = clip.sample(times)
        contacts = np.zeros((len(times), 4), bool)
        resampled = replace(clip, pose=pose, frame_rate=float(rate), contacts=contacts, tags=())
        write_bvh(path, resampled)
        back = import_file(path).clip
        assert back is not None
        every, each = max(1, rate // 60), max(1, 60 // rate)
        was, _ = kinematics.forward_world(REFERENCE, pose[::every])
        now, _ = kinematics.forward_world(REFERENCE, back.pose[::each])
        count = min(len(was), len(now))
        worst = 1000.0 * float(np.abs(was[:count] - now[:count]).max())
        yield Point(
            f"BVH on the reference skeleton through the importer, {rate} frames/s",
            f"{worst:.3f} mm",
            "within 1 mm",
            worst <= 1.0,
        )
    yield _conversions(path)


def _conversions(path: Path) -> Point:
    worst, files = 0.0, 0
    for file in motion_files([capture()]):
        try:
            motion = read_motion(file)
        except ValueError:
            continue
        motion = replace(motion, frame_rate=motion.frame_rate or 120.0)
        write_source_bvh(path, motion)
        back = read_motion(path)
        was, now = motion.global_poses()[0], back.global_poses()[0]
        order = back.skeleton.indices(motion.skeleton.names)
        height = max(float(np.ptp(was, axis=1).max()), 1e-9)
        worst = max(worst, 1700.0 * float(np.abs(was - now[:, order]).max()) / height)
        files += 1
    return Point(
        f"every readable file written and read again ({files})",
        f"{worst:.3f} mm on a figure of 1.7 m",
        "within 1 mm",
        worst <= 1.0,
    )


def mutated_files() -> Iterator[Point]:
    """20,000 mutated files."""
    environment = {**os.environ, "STRIDEWIRE_FUZZ_FILES": "20000"}
    test = ROOT / "tests/property/test_mutated_files.py"
    command = [sys.executable, "-m", "pytest", "-q", str(test)]
    done = subprocess.run(
        command, env=environment, cwd=ROOT, capture_output=True, text=True, check=False
    )
    yield Point(
        "20,000 mutated files: a clear error or a finite clip",
        "none breaks them" if done.returncode == 0 else done.stdout.strip()[-300:],
        "no other exception, no hang, no NaN",
        done.returncode == 0,
    )


if __name__ == "__main__":
    capture()
    imported = [every_file, families, round_trips, libraries, own_file, mutated_files]
    sys.exit(show("import", [*imported, *gait.STAGES]))
