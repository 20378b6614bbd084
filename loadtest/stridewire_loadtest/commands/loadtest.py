"""`stridewire loadtest`: how much a server holds, measured open loop."""

import json
import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stridewire import __version__
from stridewire.scripts import SCRIPT_NAMES
from stridewire_loadtest.scenarios import SCENARIO_NAMES

if TYPE_CHECKING:
    from stridewire_loadtest.measurement import Load, Measured

_COLUMNS = (
    "late_pct",
    "p50_ms",
    "p99_ms",
    "p999_ms",
    "max_ms",
    "tick_p50_ms",
    "tick_p99_ms",
    "transitions_per_s",
    "refined_pct",
    "search_interval_ms",
    "server_cpu_cores",
    "server_rss_mb",
    "generator_late_pct",
    "echo_cpu_ratio",
)


@click.command()
@click.argument("scenario", type=click.Choice(SCENARIO_NAMES))
@click.option("--characters", type=click.IntRange(1, 4096), default=64, show_default=True)
@click.option("--seconds", type=click.FloatRange(1.0), default=60.0, show_default=True)
@click.option(
    "--library",
    type=click.Path(exists=True, path_type=Path),
    help="Library folder to serve; the embedded synthetic one by default.",
)
@click.option(
    "--script", type=click.Choice(SCRIPT_NAMES), default="random-stick", show_default=True
)
@click.option("--stitch", default="auto", show_default=True, help="Stitcher of all characters.")
@click.option("--seed", default=0, show_default=True)
@click.option(
    "--processes",
    type=click.IntRange(1, 16),
    default=1,
    show_default=True,
    help="Of the generator.",
)
@click.option("--runs", type=click.IntRange(1), default=1, show_default=True)
@click.option("--find-capacity", is_flag=True, help="Look for the largest load that is held.")
@click.option("--echo", is_flag=True, help="Compare the CPU time with an empty gRPC echo's.")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder for a picture of each run.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def loadtest(
    scenario: str,
    characters: int,
    seconds: float,
    library: Path | None,
    script: str,
    stitch: str,
    seed: int,
    processes: int,
    runs: int,
    find_capacity: bool,
    echo: bool,
    out: Path | None,
    as_json: bool,
) -> None:
    """Start a server, put a load on it, and tell which frames came in time.

    Frames are due one sixtieth of a second after the time at which their control was scheduled;
    later ones, dropped ones and missing ones are late. Ends with 1 where a run is void.
    """
    from stridewire_loadtest.capacity import find_capacity as search
    from stridewire_loadtest.measurement import Load, measure
    from stridewire_loadtest.served import served

    load = Load(
        scenario,
        characters,
        seconds,
        script=script,
        seed=seed,
        stitcher=stitch,
        processes=processes,
    )
    made: list[Measured] = []

    def note(measured: "Measured") -> None:
        made.append(measured)
        if not as_json:
            _tell(measured)

    with served([library] if library else []) as server:
        ask = partial(measure, echo=echo)
        if find_capacity:
            search(server, load, ask, note)
        else:
            for _ in range(runs):
                note(ask(server, load))
    if out is not None:
        _draw(made, out)
    if as_json:
        rows = [measured.row() for measured in made]
        click.echo(json.dumps({"settings": _settings(load, library), "rows": rows}))
    if any(measured.void() for measured in made) and not find_capacity:
        raise click.ClickException("a run is void; see above")


def _tell(measured: "Measured") -> None:
    row = measured.row()
    click.echo(f"{row['scenario']}: {row['streams']} streams, {row['characters']} characters")
    for name in _COLUMNS:
        if name in row:
            click.echo(f"  {name:<20} {row[name]:.2f}")
    for reason in measured.void():
        click.echo(f"  VOID: {reason}")
    for example in measured.tally.examples:
        click.echo(f"  refused: {example}")


def _draw(made: "list[Measured]", out: Path) -> None:
    from stridewire_loadtest.report import draw_report

    out.mkdir(parents=True, exist_ok=True)
    for number, measured in enumerate(made, start=1):
        path = out / f"{measured.load.scenario}-{measured.load.characters}-{number}.png"
        draw_report(measured, path)
        click.echo(f"wrote {path}", err=True)


def _settings(load: "Load", library: Path | None) -> dict[str, Any]:
    return {
        "version": __version__,
        "command": f"stridewire loadtest {load.scenario} --characters {load.characters}",
        "library": str(library) if library else "embedded",
        "seed": load.seed,
        "warmup_s": load.warmup_s,
        "generators": load.processes,
        "cpus": os.cpu_count(),
    }
