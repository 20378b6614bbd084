"""What import claims, over every file of the capture.

`STRIDEWIRE_DATA=DIR python tests/show/importing.py`, with the archives or what is in them, and
`split.csv`. Writes the table of all files to `build/show/import-files.csv` and libraries to
`build/show/libraries`.
"""

import csv
import os
import subprocess
import sys
import tarfile
import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from import_figures import Family, measure
from points import ROOT, Point, show

from stridewire.formats.bvh_writing import write_bvh, write_source_bvh
from stridewire.formats.reading import read_motion
from stridewire.motion import kinematics
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building import embedded_library
from stridewire_engine.building.importing import Outcome, import_file, import_files, motion_files
from stridewire_engine.library import Library

GIVEN = Path(os.environ.get("STRIDEWIRE_DATA", ""))
BUILD = ROOT / "build" / "show"
DATA = GIVEN if (GIVEN / "lafan1").is_dir() else BUILD / "capture"
LOCOMOTION = ("idle", "walk", "jog", "run", "turn", "start", "stop")


@dataclass(frozen=True)
class Recipe:
    """How a library of the judge is built."""

    name: str
    inputs: tuple[str, ...]
    split: tuple[str, ...]
    tagged: tuple[str, ...]


LIBRARIES = (
    Recipe("cmu-seen", ("cmu", "cmu-more"), ("train",), LOCOMOTION),
    Recipe("cmu-heldout", ("cmu", "cmu-more"), ("test",), LOCOMOTION),
    Recipe("lafan1-dev", ("lafan1",), ("train", "validation"), ()),
    Recipe("lafan1", ("lafan1",), ("test",), ()),
)


def unpack() -> None:
    """Unpack the archives where the folders are not there already."""
    if not (GIVEN / "split.csv").is_file():
        sys.exit(f"STRIDEWIRE_DATA={GIVEN} holds no capture; name the folder of its archives")
    for archive in [] if GIVEN == DATA else sorted(GIVEN.glob("*.tar.xz")):
        if not (DATA / archive.name.removesuffix(".tar.xz")).is_dir():
            with tarfile.open(archive) as tar:
                tar.extractall(DATA, filter="data")


@cache
def outcomes() -> tuple[Outcome, ...]:
    """Import every motion file once."""
    return tuple(import_files(motion_files([DATA]), jobs=2))


def every_file() -> Iterator[Point]:
    """Each file becomes a clip or a sentence."""
    paths = motion_files([DATA])
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "import-files.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("file", "imported", "profile", "seconds", "notes or reason"))
        for outcome in outcomes():
            name = outcome.path.relative_to(DATA)
            clip = outcome.clip
            row = (name, True, outcome.profile, f"{clip.seconds:.2f}") if clip else (name, False)
            said = "; ".join(outcome.notes) if clip else outcome.problem
            writer.writerow((*row, *("",) * (4 - len(row)), said))
    refused = [outcome for outcome in outcomes() if outcome.clip is None]
    known = len(outcomes()) - len(refused)
    yield Point(
        "every file is imported or refused with a reason",
        f"{known} imported, {len(refused)} refused of {len(paths)}",
        "none crashes, none missing",
        len(outcomes()) == len(paths) and all(outcome.problem for outcome in refused),
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
    for file in motion_files([DATA]):
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


def libraries() -> Iterator[Point]:
    """The judge's libraries, one command each."""
    for recipe in LIBRARIES:
        out = BUILD / "libraries" / recipe.name
        command = [Path(sys.executable).with_name("stridewire"), "library", "build"]
        command += [DATA / part for part in recipe.inputs]
        command += ["--out", out, "--split-file", GIVEN / "split.csv"]
        command += [word for split in recipe.split for word in ("--split", split)]
        command += [word for tag in recipe.tagged for word in ("--tagged", tag)]
        start = time.monotonic()
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        seconds = time.monotonic() - start
        if done.returncode != 0:
            yield Point(f"library {recipe.name} is built", done.stderr[-200:], "it is", False)
            continue
        library = Library.open(out)
        minutes = sum(clip.frames for clip in library.clips) / library.frame_rate / 60.0
        yield Point(
            f"library {recipe.name} by one command",
            f"{len(library.clips)} clips, {minutes:.1f} min with mirrored copies, {seconds:.0f} s, "
            f"{seconds / max(minutes / 2.0, 1e-9):.2f} s of building per minute of capture",
            "it opens",
            True,
        )
    embedded = embedded_library()
    yield Point(
        "the synthetic library",
        f"{len(embedded.clips)} clips",
        "marked synthetic",
        embedded.info().synthetic,
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
        done.stdout.strip().split("\n")[-1],
        "no other exception, no hang, no NaN",
        done.returncode == 0,
    )


if __name__ == "__main__":
    unpack()
    sys.exit(show("import", [every_file, families, round_trips, libraries, mutated_files]))
