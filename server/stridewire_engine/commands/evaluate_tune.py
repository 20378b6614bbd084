"""`stridewire evaluate tune`: settings and weights found by a seeded search against the judge."""

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from stridewire import __version__
from stridewire_engine.commands.library_info import open_library
from stridewire_engine.evaluation.bench import Measurement, default_cache, measure_cells
from stridewire_engine.evaluation.cell import TUNING_SEEDS, Cell
from stridewire_engine.evaluation.pictures import draw_front
from stridewire_engine.evaluation.tuning import Candidate, Trial, decide, front, search, try_out
from stridewire_engine.runtime import TickSettings

_FOLDER = click.Path(file_okay=False, path_type=Path)


@click.command()
@click.option("--library", required=True, type=_FOLDER, help="Library that is searched on.")
@click.option("--decide", "deciding", type=_FOLDER, help="Library that decides between the best.")
@click.option("--trials", default=60, show_default=True, type=click.IntRange(1, 10_000))
@click.option("--seed", default=0, show_default=True, help="Of the search.")
@click.option("--out", type=_FOLDER, help="Write trials.json and draw front.png into a folder.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def tune(
    library: Path, deciding: Path | None, trials: int, seed: int, out: Path | None, as_json: bool
) -> None:
    """Search for settings and weights that are better than the defaults.

    Two objectives, both to be small: flaws (transitions a second + 5 x jump share in % + |log2
    jerk ratio| + lag in decimetres) and following error in metres. What none beats in both is the
    front; with --decide, its members are measured over another library, and the one whose two
    ratios to the defaults add up to the least is chosen. A search that was cut off goes on where
    it stopped.
    """
    for path in (library, deciding):
        if path is not None:
            open_library(path)
    found: list[Trial] = []
    with click.progressbar(length=trials + 1, label="trials", file=sys.stderr) as bar:
        for trial in search(_Measure(library), trials, seed):
            found.append(trial)
            bar.update(1)
    best = front(found)
    rows = [{**trial.data(), "front": trial in best} for trial in found]
    decision = None if deciding is None else _decide(deciding, best)
    settings = {
        "version": __version__,
        "library": library.name,
        "seed": seed,
        "seeds": list(TUNING_SEEDS[:3]),
        "command": " ".join(sys.argv[1:]),
    }
    result = {"settings": settings, "rows": rows, "decision": decision}
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        (out / "trials.json").write_text(json.dumps(result, indent=1))
        draw_front(found, best, out / "front.png")
        click.echo(f"drawn: {out / 'front.png'}", err=True)
    if as_json:
        click.echo(json.dumps(result))
    else:
        _print(found[0], best, decision)


class _Measure:
    """Measures cells of a library; what was measured before by the same code is read."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __call__(self, cells: Sequence[Cell]) -> Mapping[Cell, Measurement]:
        return dict(measure_cells(self._path, cells, 1, default_cache()))


def _decide(path: Path, best: Sequence[Trial]) -> dict[str, Any]:
    """Measure the front over another library, and choose."""
    measure = _Measure(path)
    begin = try_out(measure, Candidate(TickSettings()))
    there = []
    with click.progressbar(best, label="deciding", file=sys.stderr) as trials:
        there += [try_out(measure, trial.candidate) for trial in trials]
    chosen = decide(there, begin)
    return {
        "library": path.name,
        "defaults": begin.data(),
        "front": [trial.data() for trial in there],
        "chosen": chosen.data(),
        "defaults_stay": chosen is begin,
    }


def _print(begin: Trial, best: Sequence[Trial], decision: dict[str, Any] | None) -> None:
    click.echo(f"{'':<10}{'flaws':>8}{'following m':>13}  what differs from the defaults")
    for name, trial in [("defaults", begin), *(("front", trial) for trial in best)]:
        changed = {
            key: value
            for key, value in trial.candidate.data().items()
            if value != begin.candidate.data().get(key)
        }
        words = " ".join(f"{key}={value:g}" for key, value in changed.items())
        click.echo(f"{name:<10}{trial.flaws:>8.3f}{trial.following_error_m:>13.3f}  {words}")
    if decision is not None:
        told = "the defaults" if decision["defaults_stay"] else json.dumps(decision["chosen"])
        click.echo(f"chosen over {decision['library']}: {told}")
