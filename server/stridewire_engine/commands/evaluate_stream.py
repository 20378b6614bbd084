"""`stridewire evaluate stream`: how good streamed motion is, for any library."""

import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from stridewire import __version__
from stridewire.scripts import SCRIPT_NAMES
from stridewire_engine.commands.library_info import open_library
from stridewire_engine.evaluation.bench import Bench, default_cache, measure_cells
from stridewire_engine.evaluation.cell import NAIVE_SEEDS, REPORT_SEEDS, Cell
from stridewire_engine.evaluation.pictures import draw_sheets, draw_table
from stridewire_engine.evaluation.responses import measure_responses
from stridewire_engine.evaluation.table import rows
from stridewire_engine.runtime import TickSettings
from stridewire_engine.stitchers import DEFAULT_STITCHER, STITCHER_NAMES

SCRIPTS = tuple(name for name in SCRIPT_NAMES if name != "walk-turn-stop")
QUICK_SCRIPTS = ("stroll", "sprint", "u-turns", "idle")
_QUICK_SEEDS = REPORT_SEEDS[:2]
_COLUMNS = (
    ("C cm/s", "sliding_c_cm_s"), ("A cm/s", "sliding_a_cm_s"), ("lock cm", "lock_offset_cm"),
    ("locked %", "locked_pct"), ("float cm", "float_cm"), ("below cm", "penetration_cm"),
    ("jerk", "jerk_ratio"), ("toes", "toe_jerk_ratio"), ("knees", "knee_jerk_ratio"),
    ("jump %", "jump_pct"), ("lag cm", "clip_lag_cm"), ("truth cm", "truth_error_cm"),
    ("follow m", "following_error_m"), ("trans/s", "transitions_per_s"),
)  # fmt: skip


@click.command()
@click.option(
    "--library",
    "libraries",
    multiple=True,
    required=True,
    type=click.Path(path_type=Path),
    help="Folder of a library; may be given several times.",
)
@click.option(
    "--stitch",
    "stitchers",
    multiple=True,
    type=click.Choice(STITCHER_NAMES),
    help="Stitcher; may be given several times; all by default.",
)
@click.option("--script", "scripts", multiple=True, type=click.Choice(SCRIPTS), help="Script.")
@click.option(
    "--forced",
    "forced",
    multiple=True,
    type=click.IntRange(0, 600),
    default=(0,),
    show_default=True,
    help="Force a transition every so many frames; 0 for natural ones.",
)
@click.option("--quick", is_flag=True, help="Two seeds, four scripts, the default stitcher.")
@click.option("--jobs", default=2, show_default=True, type=click.IntRange(1, 64), help="Processes.")
@click.option("--out", type=click.Path(file_okay=False, path_type=Path), help="Draw into a folder.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def stream(
    libraries: tuple[Path, ...],
    stitchers: tuple[str, ...],
    scripts: tuple[str, ...],
    forced: tuple[int, ...],
    quick: bool,
    jobs: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """Measure streamed motion beside the captured and a naive baseline.

    Each figure comes with a 95 % bootstrap interval over characters; what was measured before by
    the same code is not measured again.
    """
    for path in libraries:
        open_library(path)
    if quick:
        scripts, stitchers = scripts or QUICK_SCRIPTS, stitchers or (DEFAULT_STITCHER,)
    cells = list(_cells(scripts or SCRIPTS, stitchers or STITCHER_NAMES, forced, quick))
    table: list[dict[str, Any]] = []
    for path in libraries:
        table += _measure(path, cells, jobs, quick)
    settings = {
        "version": __version__,
        "libraries": [str(path) for path in libraries],
        "seeds": list(_QUICK_SEEDS if quick else REPORT_SEEDS),
        "command": " ".join(sys.argv[1:]),
    }
    if out is not None:
        _draw(libraries, table, settings, out)
    if as_json:
        click.echo(json.dumps({"settings": settings, "rows": table}))
    else:
        _print(table)


def _cells(
    scripts: Sequence[str], stitchers: Sequence[str], forced: Sequence[int], quick: bool
) -> Iterator[Cell]:
    seeds = _QUICK_SEEDS if quick else REPORT_SEEDS
    for interval in forced:
        for script in scripts:
            for name in stitchers:
                for lock in (True, False):
                    yield Cell(
                        script,
                        stitch=name,
                        foot_lock=lock,
                        forced_interval_frames=interval,
                        seeds=seeds,
                    )
            if not interval:
                yield Cell(script, row="naive", foot_lock=False, seeds=seeds[:NAIVE_SEEDS])


def _measure(path: Path, cells: Sequence[Cell], jobs: int, quick: bool) -> list[dict[str, Any]]:
    name = open_library(path).name
    found = {}
    with click.progressbar(length=len(cells), label=name, file=sys.stderr) as bar:
        for cell, measurement in measure_cells(path, cells, jobs, default_cache()):
            found[cell] = measurement
            bar.update(1)
    ordered = {cell: found[cell] for cell in cells}
    seeds = _QUICK_SEEDS if quick else REPORT_SEEDS
    return [*rows(name, ordered), *measure_responses(Bench(path), TickSettings(), seeds)]


def _draw(
    libraries: Sequence[Path],
    table: Sequence[dict[str, Any]],
    settings: dict[str, Any],
    out: Path,
) -> None:
    out.mkdir(parents=True, exist_ok=True)
    (out / "evaluation.json").write_text(json.dumps({"settings": settings, "rows": list(table)}))
    draw_table(table, out / "evaluation.png")
    for path in libraries:
        draw_sheets(Bench(path), out)
    click.echo(f"drawn: {out}", err=True)


def _print(table: Sequence[dict[str, Any]]) -> None:
    head = f"{'library':<13}{'script':<13}{'motion':<22}{'forced':>7}"
    click.echo(head + "".join(f"{title:>16}" for title, _ in _COLUMNS))
    for row in table:
        if row.get("block") == "all":
            click.echo(_line(row))
    for row in table:
        if "change" in row:
            own = row["library_p25_s"]
            beside = f"the library's own {own:.2f} s" if own else "not in the library"
            click.echo(
                f"{row['library']:<13}{row['change']:<13}{row['response_s']:.2f} s to 90 % of the "
                f"change, median; {beside} ({row['events']} events)"
            )


def _line(row: dict[str, Any]) -> str:
    way = row["row"] if row["row"] != "streamed" else row["stitch"] or "default"
    if row["row"] == "streamed" and row["foot_lock"]:
        way += " + foot lock"
    text = f"{row['library']:<13}{row['script']:<13}{way:<22}{row['forced_interval_frames']:>7}"
    return text + "".join(f"{_cell(row, name):>16}" for _, name in _COLUMNS)


def _cell(row: dict[str, Any], name: str) -> str:
    if row.get(name) is None:
        return "-"
    spread = 0.5 * ((row[f"{name}_high"] or 0.0) - (row[f"{name}_low"] or 0.0))
    return f"{row[name]:.2f} ±{spread:.2f}"
