"""What the judge says of streamed motion.

`STRIDEWIRE_DATA=DIR python tests/show/judge.py`. Builds the libraries where they are missing
and writes every row to `docs/results/judge.json`.
"""

import os
import resource
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from tempfile import TemporaryDirectory

from judge_looks import critics, sheets, tuned
from judge_results import ALL, QUOTED, RESULTS, keep, library
from points import ROOT, Point, show

from stridewire_engine.commands.evaluate_stream import SCRIPTS
from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.bench import Bench, Measurement, default_cache, measure_cells
from stridewire_engine.evaluation.cell import NAIVE_SEEDS, REPORT_SEEDS, Cell
from stridewire_engine.evaluation.figures import Figures
from stridewire_engine.evaluation.responses import measure_responses
from stridewire_engine.evaluation.table import pooled, rows
from stridewire_engine.runtime import TickSettings
from stridewire_engine.runtime.admission import STITCHER_NAMES

STANCE = Cell("", stitch="stance", foot_lock=False)
SPRING = Cell("", stitch="spring", foot_lock=False)
LOCKED = Cell("", stitch="spring", foot_lock=True)
NAIVE = Cell("", row="naive", foot_lock=False, seeds=REPORT_SEEDS[:NAIVE_SEEDS])
HARD = {
    "100th match": {"match_rank": 100},
    "root 0.8 times as fast": {"root_scale": 0.8},
    "root 1.2 times as fast": {"root_scale": 1.2},
    "labels 3 frames late": {"label_shift_frames": 3},
    "labels 3 frames early": {"label_shift_frames": -3},
}
REASONS = {
    "float_cm": (
        "a toe in the air that the new clip calls planted comes down within some frames; without a "
        "transition in the last half second float is the captured (block 3)"
    ),
    "truth_error_cm": (
        "planted toes stay where they are for a while, so feet are elsewhere than in either clip; "
        "the naive row also jumps twice as often, and so between nearer moments"
    ),
}
"""Why a figure may be no better than the naive row's."""


@dataclass(frozen=True)
class Pooled:
    """Figures over all scripts of one way of making motion."""

    figures: Figures
    captured: Figures

    def value(self, name: str) -> float:
        """Return a figure."""
        return tally.interval(self.figures[name])[0]

    def source(self, name: str) -> float:
        """Return the captured figure."""
        return tally.interval(self.captured[name])[0]


def run(name: str, ways: Sequence[Cell], scripts: Sequence[str] = SCRIPTS) -> list[Pooled]:
    """Measure ways on all scripts, keep their rows, return them pooled."""
    cells = [replace(way, script=script) for way in ways for script in scripts]
    found: dict[Cell, Measurement] = {}
    for cell, measurement in measure_cells(library(name).path, cells, 2, default_cache()):
        found[cell] = measurement
    keep(rows(name, {cell: found[cell] for cell in cells}, by_script=len(scripts) == 1))
    out = []
    for way in ways:
        parts = [found[replace(way, script=script)] for script in scripts]
        out.append(Pooled(pooled(parts, "all"), pooled(parts, "captured")))
    return out


def forced() -> Iterator[Point]:
    """Planted feet stay through transitions that are forced on characters."""
    for name in QUOTED:
        for interval, knees in ((20, 1.4), (40, 1.3)):
            ways = [replace(w, forced_interval_frames=interval) for w in (SPRING, LOCKED, STANCE)]
            spring, locked, stance = run(name, ways)
            where = f"{name}, every {interval} frames"
            for figure, label, most in (
                ("sliding_c_cm_s", "sliding C", 0.15),
                ("sliding_a_cm_s", "sliding A", 0.55),
                ("toe_jerk", "toe jerk", 1.0),
                ("knee_jerk", "knee jerk", knees),
            ):
                value, low, high = tally.ratio(stance.figures[figure], spring.figures[figure])
                text = f"{value:.3f} [{low:.3f}, {high:.3f}]"
                bar = f"at most {most} of the spring's"
                yield Point(f"{label} of stance, {where}", text, bar, value <= most)
            ours = tally.interval(stance.figures["sliding_c_cm_s"])
            theirs = tally.interval(locked.figures["sliding_c_cm_s"])
            yield Point(
                f"sliding C of stance and of spring + lock, {where}",
                f"{ours[0]:.2f} and {theirs[0]:.2f} cm/s",
                "below, intervals apart",
                ours[2] < theirs[1],
            )
            source = stance.source("sliding_c_cm_s")
            yield Point(
                f"sliding C of stance, {where}",
                f"{ours[0]:.2f}, captured {source:.2f} cm/s",
                "at most 1.1 times the captured",
                ours[0] <= 1.1 * source,
            )


def hard() -> Iterator[Point]:
    """The same with bad matches, roots driven otherwise and late or early labels."""
    for name in QUOTED:
        for label, changes in HARD.items():
            ways = [replace(w, forced_interval_frames=20, **changes) for w in (SPRING, STANCE)]
            spring, stance = run(name, ways, ("stroll", "stop-and-go", "circle"))
            for figure, most in (("sliding_c_cm_s", 0.15), ("sliding_a_cm_s", 0.55)):
                value, low, high = tally.ratio(stance.figures[figure], spring.figures[figure])
                yield Point(
                    f"{figure} of stance, {label}, {name}",
                    f"{value:.3f} [{low:.3f}, {high:.3f}]",
                    f"at most {most} of the spring's",
                    value <= most,
                )


def natural() -> Iterator[Point]:
    """The best stitcher in natural streams."""
    for name in QUOTED:
        (stance,) = run(name, [replace(STANCE, foot_lock=True)])
        value, source = stance.value, stance.source
        bars = (
            ("sliding_c_cm_s", "at most 1.1 times the captured", 1.1 * source("sliding_c_cm_s")),
            ("lock_offset_cm", "at most 4", 4.0),
            ("float_cm", "no worse than captured", source("float_cm")),
            ("penetration_cm", "no worse than captured", source("penetration_cm")),
            ("jump_pct", "at most 0.2", 0.2),
            ("knee_extension_p99", "no further than captured", source("knee_extension_p99")),
        )
        for figure, bar, most in bars:
            got = value(figure)
            text = f"{got:.3f}"
            if "captured" in bar:
                text += f", captured {source(figure):.3f}"
            yield Point(f"{figure}, {name}", text, bar, got <= most)
        yield Point(
            f"locked_pct, {name}", f"{value('locked_pct'):.1f}", "at least 90",
            value("locked_pct") >= 90.0,
        )  # fmt: skip
        ratio = value("jerk_ratio")
        yield Point(f"jerk_ratio, {name}", f"{ratio:.2f}", "0.8 to 1.3", 0.8 <= ratio <= 1.3)
        (idle,) = run(name, [replace(STANCE, foot_lock=True)], ("idle",))
        jumps = idle.value("transitions_per_s")
        yield Point(f"transitions on idle, {name}", f"{jumps:.2f} /s", "at most 0.1", jumps <= 0.1)


def naive() -> Iterator[Point]:
    """Every metric is better than the naive row's."""
    for name in QUOTED:
        stance, naive = run(name, [replace(STANCE, foot_lock=True), NAIVE])
        for figure in (
            "sliding_c_cm_s", "sliding_a_cm_s", "sliding_b_cm_s", "float_cm", "penetration_cm",
            "jump_pct", "jerk_ratio", "truth_error_cm", "following_error_m", "transitions_per_s",
        ):  # fmt: skip
            ours, theirs = stance.value(figure), naive.value(figure)
            what = f"{figure} beside the naive row, {name}"
            text = f"{ours:.3f}, naive {theirs:.3f}"
            if ours > theirs and figure in REASONS:
                yield Point(what, f"{text}: {REASONS[figure]}")
            else:
                yield Point(what, text, "better, or the reason", ours <= theirs)


def responses() -> Iterator[Point]:
    """A commanded change comes about as fast as the library's own."""
    for name in QUOTED:
        for row in measure_responses(Bench(library(name).path), TickSettings()):
            keep(iter([row]))
            own = row["library_p25_s"]
            theirs = "not in the library" if own is None else f"the library's own {own:.2f} s"
            yield Point(
                f"{row['change']}, {name}",
                f"{row['response_s']:.2f} s, {theirs} ({row['events']} events)",
                "within 1.15 times the library's 25th percentile",
                own is None or row["response_s"] <= 1.15 * own,
            )
        for row in measure_responses(Bench(library(name).path), TickSettings(), responsiveness=1.0):
            keep(iter([row]))
            yield Point(
                f"{row['change']} at responsiveness 1, {name}", f"{row['response_s']:.2f} s"
            )


def table() -> Iterator[Point]:
    """All libraries and stitchers, with foot lock off and on."""
    ways = [Cell("", stitch=n, foot_lock=lock) for n in STITCHER_NAMES for lock in (False, True)]
    for name in ALL:
        before, began = _processor_s(), time.monotonic()
        run(name, [*ways, NAIVE])
        used, passed = _processor_s() - before, time.monotonic() - began
        yield Point(
            f"table of {name}", f"{len(ways)} ways, captured, naive; in {RESULTS.relative_to(ROOT)}"
        )
        yield Point(
            f"natural streams of {name}",
            f"{used:.0f} s of processors, {passed:.0f} s passed; what was cached costs nothing",
            "under 5 minutes of two processors",
            used < 2 * 300.0,
        )


def quick() -> Iterator[Point]:
    """`--quick` is quick."""
    command = [sys.executable, "-m", "stridewire", "evaluate", "stream", "--quick", "--json"]
    before, began = _processor_s(), time.monotonic()
    with TemporaryDirectory() as fresh:
        environment = {**os.environ, "XDG_CACHE_HOME": fresh}
        words = [*command, "--library", str(library("cmu-heldout").path)]
        subprocess.run(words, check=True, capture_output=True, env=environment)
    used, passed = _processor_s() - before, time.monotonic() - began
    yield Point(
        "evaluate stream --quick, cmu-heldout",
        f"{used:.0f} s of processors, {passed:.0f} s passed",
        "under 30 s of one processor",
        used < 30.0,
    )


def _processor_s() -> float:
    """Return the processor seconds of this process and of its children that have ended."""
    return sum(
        getattr(resource.getrusage(who), part)
        for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        for part in ("ru_utime", "ru_stime")
    )


if __name__ == "__main__":
    if not os.environ.get("STRIDEWIRE_DATA"):
        sys.exit("STRIDEWIRE_DATA names no capture; name the folder of its archives")
    stages = [natural, naive, responses, forced, sheets, tuned, hard, critics, quick, table]
    sys.exit(show("judge", stages))
