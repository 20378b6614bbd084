"""Pictures of an evaluation: bars beside the captured motion, and contact sheets to look at."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from stridewire.drawing import contact_sheet
from stridewire_engine.evaluation.bench import Bench
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.evaluation.tuning import Trial

SHEETS = {
    "walk": "stroll",
    "run": "sprint",
    "stop": "stop-and-go",
    "u-turn": "u-turns",
    "strafe": "strafe",
}
"""Script of each contact sheet."""
_FIGURES = (
    "sliding_c_cm_s", "sliding_a_cm_s", "float_cm", "jerk_ratio", "knee_jerk_ratio", "jump_pct",
    "clip_lag_cm", "following_error_m",
)  # fmt: skip
_SECONDS = 6.0


def draw_sheets(bench: Bench, folder: Path, stitch: str = "") -> list[Path]:
    """Draw what the library's characters do in the scripts of `SHEETS`; return the PNGs."""
    paths = []
    for name, script in SHEETS.items():
        made = bench.run(Cell(script, stitch=stitch, seeds=(100,), seconds=_SECONDS))
        path = folder / f"{bench.library.name}-{name}.png"
        contact_sheet(made.clip(bench.library, 0, f"{bench.library.name}: {name}"), path)
        paths.append(path)
    return paths


def draw_table(table: Sequence[dict[str, Any]], path: Path) -> None:
    """Draw the figures pooled over scripts, one panel a figure, captured ones as dashed lines."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    scripts = {row["script"] for row in table if "script" in row}
    script = "all" if "all" in scripts else sorted(scripts)[0]
    chosen = [row for row in table if row.get("block") == "all" and row["script"] == script]
    figure = Figure(figsize=(16, 9), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, name in zip(figure.subplots(2, 4).flat, _FIGURES, strict=True):
        bars = [row for row in chosen if row.get(name) is not None and row["row"] == "streamed"]
        for x, row in enumerate(bars):
            low, high = row[f"{name}_low"], row[f"{name}_high"]
            reach = [[max(row[name] - low, 0.0)], [max(high - row[name], 0.0)]]
            colour = "#3b6ea5" if row["foot_lock"] else "#a5c4e5"
            axes.bar(x, row[name], yerr=reach, color=colour)
        captured = [r[name] for r in chosen if r["row"] == "captured" and r.get(name) is not None]
        for value in captured:
            axes.axhline(value, color="#555555", lw=0.8, ls="--")
        labels = [f"{row['library']} {row['stitch']}" for row in bars]
        axes.set_xticks(range(len(bars)), labels, rotation=70, ha="right", fontsize=6)
        axes.set_title(name, fontsize=9)
    figure.savefig(path, dpi=110)


def draw_front(trials: Sequence[Trial], best: Sequence[Trial], path: Path) -> None:
    """Draw a search: flaws over following error, the front as a line, where it began as a cross."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    axes.scatter(*_objectives(trials), s=14, color="#a5c4e5", label="tried")
    axes.plot(*_objectives(best), "o-", color="#3b6ea5", ms=5, label="front")
    axes.plot(*_objectives(trials[:1]), "X", color="#c0504d", ms=11, label="begun with")
    axes.set_xlabel("following error, m (response)")
    axes.set_ylabel("flaws (quality)")
    axes.legend()
    figure.savefig(path, dpi=110)


def _objectives(trials: Sequence[Trial]) -> tuple[list[float], list[float]]:
    return [trial.following_error_m for trial in trials], [trial.flaws for trial in trials]
