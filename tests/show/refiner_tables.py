"""What the refiner must show: clips under a captured take's path, beside plain stitchers."""

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from capture import capture
from points import ROOT, Point

from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.evaluation.seams import Windows, stitched
from stridewire_engine.networks.rmr import Plans, shipped_refiner
from stridewire_engine.networks.rmr.assembly import assemble
from stridewire_engine.networks.rmr.features import inputs
from stridewire_engine.networks.rmr.pairs import PairMaker
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_engine.stitchers.stance import Stance

_STRIDES = {"cmu": 30, "lafan1": 60}
_RATIOS = (
    ("sliding C", "sliding_c_cm_s", "at most 0.30 of the spring's", 0.30),
    ("sliding A", "sliding_a_cm_s", "at most 0.35 of the spring's", 0.35),
    ("position error", "position_error_cm", "at most 0.90 of the spring's", 0.90),
    ("foot error", "foot_error_cm", "at most 0.75 of the spring's", 0.75),
    ("toe jerk", "toe_jerk", "below the spring's", 1.0),
    ("knee jerk", "knee_jerk", "at most 1.3 times the spring's", 1.3),
)
_BATCHES = (1, 8, 32)
_ROUNDS = 30
_QUARTER_CORE_US = 0.25e6 / (2 * 256)


def cmu() -> Iterator[Point]:
    """Test subjects of CMU, whom no network was trained on."""
    yield from _points("cmu", "source")


def cmu_smoothed() -> Iterator[Point]:
    """The same with a path that says nothing of its steps."""
    yield from _points("cmu", "smoothed")


def lafan1() -> Iterator[Point]:
    """Another data set, whose subjects no network was trained on."""
    yield from _points("lafan1", "source")


def lafan1_smoothed() -> Iterator[Point]:
    """The same with a path that says nothing of its steps."""
    yield from _points("lafan1", "smoothed")


def cost() -> Iterator[Point]:
    """What a window costs: the network alone, with its features, and with the feet."""
    windows, plans = _windows(max(_BATCHES))
    refiner = shipped_refiner()
    for batch in _BATCHES:
        some: Plans = plans[slice(0, batch)]
        numbers = inputs(some)
        part = Windows(
            windows.takes, windows.pairs[slice(0, batch)], windows.root[:batch], windows.yaw[:batch]
        )
        said = refiner.refine(some)
        alone = _microseconds(lambda x=numbers: refiner.model.run(x)) / batch
        told = _microseconds(lambda p=some: refiner.refine(p)) / batch
        whole = told + _microseconds(lambda w=part, g=said: stitched(w, Stance(), g), 3) / batch
        figure = (
            f"network {alone:.0f} us, with features {told:.0f} us, with 60 frames' feet and IK "
            f"{whole:.0f} us, of one thread"
        )
        if batch == 1:
            yield Point(f"a window at batch {batch}", figure)
        else:
            # what a live transition adds to the tick is the network and its features
            bar = "256 characters, two transitions a second each: a quarter of one core, 488 us"
            yield Point(f"a window at batch {batch}", figure, bar, told <= _QUARTER_CORE_US)


def _points(name: str, path: str) -> Iterator[Point]:
    table = evaluated(name, path)
    refine, quintic = table["refine"], table["quintic"]
    where = f"{name}, {path} path"
    for title, figure, bar, most in _RATIOS:
        value = refine[f"{figure}_of_spring"]
        passed = value < most if bar.startswith("below") else value <= most
        yield Point(f"{where}: {title}", spread(refine, f"{figure}_of_spring"), bar, passed)
    for title, figure in (("sliding C", "sliding_c_cm_s"), ("sliding A", "sliding_a_cm_s")):
        for other in ("stance", "spring-lock"):
            apart = refine[f"{figure}_high"] < table[other][f"{figure}_low"]
            told = f"{spread(refine, figure)} cm/s, {other} {spread(table[other], figure)}"
            yield Point(f"{where}: {title} beside {other}", told, "below, intervals apart", apart)
        of_stance = spread(refine, f"{figure}_of_stance")
        yield Point(f"{where}: {title}, of stance's on the same takes", of_stance)
    told = f"{refine['npss']:.3f}, quintic {quintic['npss']:.3f}"
    better = refine["npss"] <= quintic["npss"]
    yield Point(f"{where}: NPSS", told, "no worse than the quintic's", better)
    silent = table["refine-silent"]
    for title, figure in (("sliding C", "sliding_c_cm_s"), ("foot error", "foot_error_cm")):
        told = f"{silent[figure]:.2f}, with it {refine[figure]:.2f}"
        worse = silent[figure] > refine[figure]
        yield Point(f"{where}: {title} without the network's answer", told, "worse", worse)


@cache
def evaluated(name: str, path: str) -> dict[str, dict[str, Any]]:
    """Return the rows of `evaluate stitch` on test subjects, by method."""
    command = (
        sys.executable, "-m", "stridewire", "evaluate", "stitch", "--data", str(capture()),
        "--set", name, "--path", path, "--stride", str(_STRIDES[name]), "--json",
    )  # fmt: skip
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return {row["method"]: row for row in json.loads(done.stdout)["rows"]}


def spread(row: dict[str, Any], key: str) -> str:
    """Return a figure with its interval."""
    return f"{row[key]:.3g} ({row[f'{key}_low']:.3g} … {row[f'{key}_high']:.3g})"


def _windows(count: int) -> tuple[Windows, Plans]:
    takes = Takes.of(clip for clip in synthetic_clips() if len(clip) < 400)
    pairs = PairMaker(takes).make(takes.windows(10), np.random.default_rng(0))[slice(0, count)]
    root, yaw = takes.root_path(pairs.truth)
    return Windows(takes, pairs, root, yaw), assemble(takes, pairs).plans


def _microseconds(work: Any, rounds: int = _ROUNDS) -> float:
    times = []
    for _ in range(rounds):
        # time of the thread, which others on the machine do not change much
        began = time.thread_time()
        work()
        times.append(time.thread_time() - began)
    return 1e6 * float(np.median(times))
