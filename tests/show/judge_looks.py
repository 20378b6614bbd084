"""Stages of the judge's show that are looked at: contact sheets, the critic, the tuning."""

import json
from collections.abc import Iterator

from judge_results import ALL, QUOTED, keep, library
from points import ROOT, Point

from stridewire_engine.evaluation.bench import Bench, default_cache, measure_cells
from stridewire_engine.evaluation.criticism import criticise
from stridewire_engine.evaluation.pictures import draw_sheets
from stridewire_engine.evaluation.responses import CHANGES, fitted_halflife
from stridewire_engine.evaluation.tuning import Candidate, try_out
from stridewire_engine.runtime import TickSettings
from stridewire_engine.runtime.admission import STITCHER_NAMES

FOLDER = ROOT / "build" / "show" / "judge"
TUNING = ROOT / "docs" / "results" / "tuning.json"
_STEPS = (0.0, 0.25, 0.5, 0.75, 1.0)


def sheets() -> Iterator[Point]:
    """Contact sheets of walk, run, stop, U-turn and strafe."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name in ALL:
        paths = draw_sheets(Bench(library(name).path), FOLDER, "stance")
        where = FOLDER.relative_to(ROOT)
        yield Point(f"contact sheets of {name}", f"{len(paths)} in {where}, to be looked at")


def critics() -> Iterator[Point]:
    """What a critic, trained on other people, tells of each stitcher."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for train, name in (("lafan1-dev", "lafan1"), ("cmu-seen", "cmu-heldout")):
        assert name in QUOTED
        benches = Bench(library(train).path), Bench(library(name).path)
        for row in criticise(*benches, STITCHER_NAMES, FOLDER):
            keep(iter([{**row, "script": "all", "block": "all", "foot_lock": True}]))
            what = row["stitch"] or "takes against takes"
            yield Point(
                f"critic_auc, {name}, {row['row']}, {what}, {row['joints']} joints",
                f"{row['critic_auc']:.3f} [{row['critic_auc_low']:.3f}, "
                f"{row['critic_auc_high']:.3f}], {row['windows']} windows",
            )


def tuned() -> Iterator[Point]:
    """The search for settings, as recorded, and that responsiveness moves along its front."""
    found = json.loads(TUNING.read_text())
    best = [row for row in found["rows"] if row["front"]]
    decision = found["decision"]
    yield Point(
        "recorded search on cmu-seen",
        f"{len(found['rows'])} candidates, {len(best)} on the front; over {decision['library']} "
        + ("the defaults of then stay" if decision["defaults_stay"] else "one was chosen"),
    )
    for change in CHANGES:
        fit = fitted_halflife(library("cmu-seen"), change)
        text = "not in the library" if fit is None else f"{fit:.2f} s"
        yield Point(f"half-life that does a {change.name} as cmu-seen does", text)
    path = library("cmu-seen").path
    trials = [
        try_out(
            lambda cells: dict(measure_cells(path, cells, 1, default_cache())),
            Candidate(TickSettings(), responsiveness=step),
        )
        for step in _STEPS
    ]
    pairs = ", ".join(
        f"{step:g}: {t.following_error_m:.3f} m and {t.flaws:.2f}"
        for step, t in zip(_STEPS, trials, strict=True)
    )
    ends = trials[0], trials[-1]
    yield Point(
        "following error and flaws by responsiveness, cmu-seen",
        pairs,
        "from 0 to 1 the error falls and flaws rise",
        ends[1].following_error_m < ends[0].following_error_m and ends[1].flaws > ends[0].flaws,
    )
