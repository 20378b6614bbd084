"""The paper's own network beside the refiner that ships: recorded trainings, and its row again."""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
from points import ROOT, Point
from refiner_tables import evaluated, spread

RESULTS = ROOT / "docs" / "results"
RECORD = RESULTS / "refiner-paper.json"
ROW = RESULTS / "refiner-paper-row.json"
"""`evaluate stitch --network refine-paper=RUNS/bgru/rmr.onnx --json`, its own rows."""
CELLS = ("bgru", "blstm", "gru", "lstm")
BEGINS = ("begin-3", "bgru", "begin-10")
TRAININGS = (*CELLS, "begin-3", "begin-10", "no-trajectory")
FIGURES = (("sliding C", "sliding_c_cm_s"), ("position error", "position_error_cm"))


def paper() -> Iterator[Point]:
    """Table 1 at equal steps and at equal time, tables 2 and 3, figure 9, three seeds."""
    rows = json.loads(RECORD.read_text())["rows"] if RECORD.is_file() else []
    told = {row["training"]: row for row in rows if "training" in row}
    missing = [name for name in TRAININGS if name not in told]
    figure = f"recorded: {sorted(told)}; missing: {missing}"
    yield Point("trainings of the paper's network", figure, "all", not missing)
    cells = {name: told[name] for name in CELLS if name in told}
    if len(cells) == len(CELLS):
        steps = min(row["steps"] for row in cells.values())
        seconds = min(row["curve"][-1]["cpu_s"] for row in cells.values())
        yield from _order(cells, "step", steps, f"after {steps} steps each")
        yield from _order(cells, "cpu_s", seconds, f"after {seconds / 60.0:.1f} minutes each")
    yield from _begins(told)
    yield from _drifts([row for row in rows if "drift" in row])
    yield from _beside()
    records = (json.loads(path.read_text()) for path in RESULTS.glob("refiner-[0-9].json"))
    seeds = sorted(record["recipe"]["seed"] for record in records)
    yield Point("seeds of what ships", f"recorded: {seeds}", "three", len(seeds) == 3)


def at(row: dict[str, Any], clock: str, then: float, figure: str) -> float:
    """Return a figure of a training at a step or second, between looks along a straight line."""
    curve = row["curve"]
    return float(np.interp(then, [look[clock] for look in curve], [look[figure] for look in curve]))


def _order(cells: dict[str, dict[str, Any]], clock: str, then: float, when: str) -> Iterator[Point]:
    for title, figure in (("MSE", "mse"), ("NPSS", "npss")):
        values = {name: at(row, clock, then, figure) for name, row in cells.items()}
        ranked = sorted(values, key=lambda name: values[name])
        figures = ", ".join(f"{name} {values[name]:.4g}" for name in ranked)
        first = ranked[0] == "bgru"
        yield Point(f"table 1 {when}: {title}", f"recorded: {figures}", "BGRU first", first)


def _begins(told: dict[str, dict[str, Any]]) -> Iterator[Point]:
    for name in BEGINS:
        if name in told:
            row, last = told[name], told[name]["curve"][-1]
            figure = (
                f"recorded: MSE {last['mse']:.4g}, of the input {last['mse_of_input']:.3g}, of its "
                f"first 5 frames {last['mse_of_input_head']:.3g}"
            )
            yield Point(f"table 2: T_begin {row['begin']}", figure)


def _drifts(rows: list[dict[str, Any]]) -> Iterator[Point]:
    for row in rows:
        with_it, without = row["bgru_last_cm"], row["no-trajectory_last_cm"]
        figure = f"recorded: {with_it:.3g} cm, without the path's loss {without:.3g} cm"
        yield Point(f"figure 9: root after {row['frames']} frames ({row['drift']})", figure)


def _beside() -> Iterator[Point]:
    """Compare its recorded row with what ships, measured now."""
    ours = evaluated("cmu", "source")["refine"]
    recorded = json.loads(ROW.read_text())["rows"]
    theirs = next(row for row in recorded if row["path"] == "source")
    budget = theirs["budget_min"]
    figure = f"recorded: {budget} minutes"
    yield Point("table 3: budget of the paper's row", figure, "told", budget > 0.0)
    for title, figure in FIGURES:
        key = f"{figure}_of_spring"
        yield Point(
            f"table 3: {title}, of the spring's",
            f"the paper's, recorded, {spread(theirs, key)}, what ships {spread(ours, key)}",
            "what ships is lower",
            ours[figure] < theirs[figure],
        )
