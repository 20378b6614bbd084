"""What the live refiner must show: `refine` beside `stance` and springs in the judge's streams.

Same library, controls and seeds for all three, foot lock off; characters are paired in intervals.
Rows go to `docs/results/refiner-live.json`.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from judge_results import QUOTED, library
from points import ROOT, Point

from stridewire import __version__
from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.bench import Bench, Measurement, default_cache, measure_cells
from stridewire_engine.evaluation.cell import REPORT_SEEDS, Cell
from stridewire_engine.evaluation.criticism import criticise
from stridewire_engine.evaluation.table import pooled, rows

RESULTS = ROOT / "docs" / "results" / "refiner-live.json"
SCRIPTS = ("stroll", "stop-and-go", "circle", "u-turns")
SEEDS = REPORT_SEEDS[:6]
STITCHERS = ("spring", "stance", "refine")
CONDITIONS: Mapping[str, Mapping[str, Any]] = {
    "natural": {},
    "every 20 frames": {"forced_interval_frames": 20},
    "every 40 frames": {"forced_interval_frames": 40},
    "100th match": {"forced_interval_frames": 20, "match_rank": 100},
    "root 0.8 times as fast": {"forced_interval_frames": 20, "root_scale": 0.8},
    "root 1.2 times as fast": {"forced_interval_frames": 20, "root_scale": 1.2},
}
_SLIDING = (("sliding_c_cm_s", 0.15), ("sliding_a_cm_s", 0.55))
_TO_WIN = ("truth_error_cm", "knee_jerk")
_CRITIC = (("lafan1-dev", "lafan1"), ("cmu-seen", "cmu-heldout"))
_CRITIC_SEEDS = REPORT_SEEDS[:5]
Parts = Sequence[Measurement]


def live() -> Iterator[Point]:
    """Feet, knees and lag under every condition, and whether anything is won."""
    table: list[dict[str, Any]] = []
    wins: dict[str, list[str]] = {}
    for name in QUOTED:
        for condition, changes in CONDITIONS.items():
            by_stitcher = measured(name, changes, table)
            yield from _bars(f"{condition}, {name}", by_stitcher)
            for figure, told in _won(by_stitcher):
                wins.setdefault(f"{figure}, {condition}", []).append(f"{name} {told}")
    _keep(table)
    both = {what: told for what, told in wins.items() if len(told) == len(QUOTED)}
    text = "; ".join(f"{what}: {', '.join(told)}" for what, told in both.items())
    yield Point(
        "better than stance on both libraries, intervals below 1",
        text or "nothing won: stance is the default",
        "truth error or knee jerk, under one condition at least",
        bool(both),
    )


def live_critic() -> Iterator[Point]:
    """Whether a critic tells the transitions of `refine` less surely than those of `stance`."""
    for train, name in _CRITIC:
        benches = Bench(library(train).path), Bench(library(name).path)
        told = criticise(*benches, ("stance", "refine"), seeds=_CRITIC_SEEDS)
        found = {
            row["stitch"]: row
            for row in told
            if row["row"] == "streamed" and row["joints"] == "all"
        }
        ours, theirs = found["refine"], found["stance"]
        yield Point(
            f"critic_auc of refine and of stance, {name}",
            f"{_auc(ours)}, {_auc(theirs)}: "
            + ("less sure" if ours["critic_auc_high"] < theirs["critic_auc_low"] else "no win"),
        )


def measured(
    name: str, changes: Mapping[str, Any], table: list[dict[str, Any]]
) -> dict[str, Parts]:
    """Measure the stitchers under a condition; their rows are added to the table."""
    # natural transitions are rarer
    seeds = SEEDS if changes else REPORT_SEEDS
    ways = [Cell("", stitch=s, foot_lock=False, seeds=seeds, **changes) for s in STITCHERS]
    cells = [replace(way, script=script) for way in ways for script in SCRIPTS]
    found = dict(measure_cells(library(name).path, cells, 1, default_cache()))
    table += rows(name, {cell: found[cell] for cell in cells}, by_script=False)
    return {way.stitch: [found[replace(way, script=script)] for script in SCRIPTS] for way in ways}


def _bars(where: str, found: Mapping[str, Parts]) -> Iterator[Point]:
    spring, stance, refine = (pooled(found[name], "all") for name in STITCHERS)
    for figure, most in _SLIDING:
        to_stance, to_spring = (tally.ratio(refine[figure], r[figure]) for r in (stance, spring))
        yield Point(
            f"{figure}, {where}",
            f"{_text(to_stance)} of stance's, {to_spring[0]:.3f} of the spring's",
            f"no worse than stance's by its interval, at most {most} of the spring's",
            to_stance[1] <= 1.0 and to_spring[0] <= most,
        )
    yield _by_block(where, found)
    for figure in ("knee_jerk", "clip_lag_cm"):
        value, low, high = tally.ratio(refine[figure], stance[figure])
        text = _text((value, low, high))
        yield Point(f"{figure}, {where}", text, "at most 1.05 of stance's", value <= 1.05)
    truth = tally.ratio(refine["truth_error_cm"], stance["truth_error_cm"])
    yield Point(f"truth_error_cm, {where}", f"{_text(truth)} of stance's")
    yield Point(f"refined, {where}", f"{tally.value(refine['refined_pct']):.1f} % of transitions")


def _by_block(where: str, found: Mapping[str, Parts]) -> Point:
    """Compare sliding by tens of frames after a transition; blocks that nobody reached are left."""
    told, highest = [], 0.0
    for block in ("0", "1", "2", "3"):
        ours, theirs = (pooled(found[s], block)["sliding_c_cm_s"] for s in ("refine", "stance"))
        if tally.value(theirs) > 0.0:
            value, _, high = tally.ratio(ours, theirs)
            told.append(f"{value:.2f} up to {high:.2f}")
            highest = max(highest, high)
    return Point(
        f"sliding C by ten frames after a transition, {where}",
        "; ".join(told),
        "upper bounds at most 1.1 of stance's",
        highest <= 1.1,
    )


def _won(found: Mapping[str, Parts]) -> Iterator[tuple[str, str]]:
    """Yield the figures in which `refine` is better than `stance`, the interval below 1."""
    stance, refine = (pooled(found[name], "all") for name in ("stance", "refine"))
    for figure in _TO_WIN:
        told = tally.ratio(refine[figure], stance[figure])
        if told[2] < 1.0:
            yield figure, _text(told)


def _keep(table: Sequence[Mapping[str, Any]]) -> None:
    settings = {
        "version": __version__,
        "command": "make show-refiner SHOW='--stage live'",
        "scripts": SCRIPTS,
        "seeds": f"{SEEDS[0]}-{SEEDS[-1]}; natural streams {REPORT_SEEDS[0]}-{REPORT_SEEDS[-1]}",
    }
    lines = ",\n".join(json.dumps(row) for row in table if row["script"] == "all")
    RESULTS.write_text(f'{{"settings": {json.dumps(settings)}, "rows": [\n{lines}\n]}}\n')


def _auc(row: Mapping[str, Any]) -> str:
    return f"{row['critic_auc']:.3f} [{row['critic_auc_low']:.3f}, {row['critic_auc_high']:.3f}]"


def _text(ratio: tuple[float, float, float]) -> str:
    value, low, high = ratio
    return f"{value:.3f} [{low:.3f}, {high:.3f}]"
