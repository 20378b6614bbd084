"""Synthetic motion beside captured: is it as near to people whom nobody trained on as capture is?

`STRIDEWIRE_DATA=DIR python tests/show/gait.py`; `make show-import` shows the same after its own.
Writes two pictures into `build/show`: 20 random windows, and cadence, step length, knees and jerk
against speed.
"""

import csv
import sys
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

import gait_pictures
import numpy as np
from capture import capture
from gait_figures import (
    distances,
    features,
    joint_angles,
    library_features,
    nearest_windows,
    stance_speeds,
    turning,
)
from points import ROOT, Point, show

from stridewire.motion.clip import Clip
from stridewire_engine.building.importing import import_files
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_models.gait.takes import load_takes, take_files

TEST_SUBJECTS = (6, 8, 16, 86)
CATEGORIES = ("walk", "run", "turn")
GAITS = {"walk": (0.3, 2.0), "run": (2.0, 8.0)}


def nearest_pose() -> Iterator[Point]:
    """Compare the distances from unseen people's frames to both libraries."""
    unseen = [features(clip) for clip in _unseen()]
    rows = np.concatenate([f.rows for f in unseen])[::3]
    speed = np.concatenate([f.speed for f in unseen])[::3]
    to_captured = distances(rows, library_features(_captured()))
    to_synthetic = distances(rows, library_features(_synthetic()))
    to_parts = [distances(rows, library_features(part)) for part in _parts(5)]
    for gait, (slow, fast) in GAITS.items():
        here = (speed >= slow) & (speed < fast)
        captured, synthetic, *parts = (
            100.0 * float(np.median(d[here])) for d in (to_captured, to_synthetic, *to_parts)
        )
        yield Point(
            f"nearest pose to unseen people's {gait} ({here.sum()} frames)",
            f"{synthetic:.2f} cm, captured {captured:.2f} cm, ratio {synthetic / captured:.2f}",
            "ratio at most 1.1",
            synthetic <= 1.1 * captured,
        )
        ratios = np.array(parts) / captured
        yield Point(
            f"the same with as many minutes as captured, five draws, {gait}",
            f"ratio {ratios.mean():.2f} ({ratios.min():.2f} to {ratios.max():.2f})",
            "ratio at most 1.1 on average",
            bool(ratios.mean() <= 1.1),
        )


def planted() -> Iterator[Point]:
    """Measure how fast toes move over the ground in recorded stance."""
    speeds = [float(stance_speeds(clip).mean()) for clip in _synthetic()]
    yield Point(
        "toe speed in stance, worst clip",
        f"{100.0 * max(speeds):.3f} cm/s",
        "below 0.3 cm/s",
        max(speeds) < 0.003,
    )


def coverage() -> Iterator[Point]:
    """Find which speeds and turning rates the library has."""
    speed = np.concatenate([features(clip).speed for clip in _synthetic()])
    seconds = np.histogram(speed, np.arange(0.0, 4.1, 0.5))[0] / 60.0
    yield Point(
        "speeds 0 to 4 m/s",
        f"least of 8 bands {seconds.min():.1f} s, fastest {speed.max():.2f} m/s",
        "each band has 2 s; 4 m/s reached",
        bool(seconds.min() >= 2.0 and speed.max() >= 3.9),
    )
    turn = np.degrees(np.concatenate([turning(clip) for clip in _synthetic()]))
    yield Point(
        "turns to 180 deg/s both ways",
        f"{turn.min():.0f} to {turn.max():.0f} deg/s",
        "-180 to 180 deg/s",
        bool(turn.max() >= 180.0 and turn.min() <= -180.0),
    )


def originality() -> Iterator[Point]:
    """Measure how near windows of half a second come to captured ones and to one another."""
    to_captured = nearest_windows(_synthetic(), _captured())
    yield Point(
        "nearest captured window of half a second",
        f"{100.0 * to_captured.mean():.1f} cm on average, {100.0 * to_captured.min():.1f} cm least",
        "at least 2 cm on average",
        bool(to_captured.mean() >= 0.02),
    )
    frames = {clip.pose.rotations[60].tobytes() for clip in (*_synthetic(), *synthetic_clips(1))}
    alike = 2 * len(_synthetic()) - len(frames)
    to_others = nearest_windows(synthetic_clips(1), _synthetic())
    yield Point(
        "clips of two seeds that are alike",
        f"{alike}; windows lie {100.0 * to_others.mean():.1f} cm apart on average",
        "0",
        alike == 0,
    )


def legs() -> Iterator[Point]:
    """Draw 20 random windows, and count crossed legs."""
    path = gait_pictures.random_windows(_synthetic(), ROOT / "build/show/gait-windows.png")
    ours, theirs = (gait_pictures.crossed(clips) for clips in (_synthetic(), _captured()))
    yield Point(
        f"frames with crossed ankles (look at {path.relative_to(ROOT)})",
        f"{100.0 * ours:.2f} %, captured {100.0 * theirs:.2f} %",
        "no more than captured",
        ours <= theirs,
    )


def joint_ranges() -> Iterator[Point]:
    """Compare how far joints turn, in the middle 98 % of frames."""
    sets = {"synthetic": _synthetic(), "captured": _captured()}
    for joint in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm"):
        ranges = {
            name: np.percentile(np.concatenate([joint_angles(c, joint) for c in clips]), (1, 99))
            for name, clips in sets.items()
        }
        (low, high), (least, most) = ranges["synthetic"], ranges["captured"]
        yield Point(
            f"turn of {joint} from the T-pose",
            f"{low:.0f} to {high:.0f} degrees, captured {least:.0f} to {most:.0f}",
            "printed",
            True,
        )


def against_speed() -> Iterator[Point]:
    """Draw cadence, step length, knees and jerk against speed, of both."""
    path = ROOT / "build/show/gait-against-speed.png"
    rows = gait_pictures.against_speed(_synthetic(), [*_captured()], _unseen(), path)
    for what, synthetic, captured in rows:
        yield Point(what, f"{synthetic}, captured {captured}", "printed", True)


@cache
def _synthetic() -> tuple[Clip, ...]:
    return tuple(synthetic_clips())


@cache
def _captured() -> tuple[Clip, ...]:
    return tuple(take.clip for take in load_takes(take_files(capture())))


@cache
def _unseen() -> tuple[Clip, ...]:
    """Import the walks, runs and turns of the test subjects."""
    root = capture() / "cmu"
    with (root / "index.csv").open(newline="") as file:
        files = [
            root / row["file"]
            for row in csv.DictReader(file)
            if int(row["subject"]) in TEST_SUBJECTS and row["category"] in CATEGORIES
        ]
    return tuple(o.clip for o in import_files(_whole(files)) if o.clip is not None)


def _parts(count: int) -> Iterator[list[Clip]]:
    """Choose synthetic clips at random that last as long as the captured ones."""
    rng = np.random.default_rng(0)
    for _ in range(count):
        left = sum(clip.seconds for clip in _captured())
        part = []
        for index in rng.permutation(len(_synthetic())):
            clip = _synthetic()[index]
            if clip.seconds <= left:
                part.append(clip)
                left -= clip.seconds
        yield part


def _whole(files: Sequence[Path]) -> list[Path]:
    return [file for file in files if "fragments" not in file.parts and file.exists()]


STAGES = (nearest_pose, planted, coverage, originality, legs, joint_ranges, against_speed)

if __name__ == "__main__":
    sys.exit(show("gait", STAGES))
