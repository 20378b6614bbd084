"""`stridewire evaluate critic`: can a classifier tell seams from captured motion?"""

import json
import sys
from pathlib import Path
from typing import Any

import click

from stridewire import __version__
from stridewire_engine.commands.library_info import open_library
from stridewire_engine.evaluation.bench import Bench
from stridewire_engine.evaluation.cell import REPORT_SEEDS
from stridewire_engine.evaluation.criticism import SCRIPTS, criticise
from stridewire_engine.stitchers import STITCHER_NAMES

_FOLDER = click.Path(file_okay=False, path_type=Path)
_KINDS = {"streamed": "transitions", "quiet": "streamed, none", "captured": "captured halves"}


@click.command()
@click.option("--train", required=True, type=_FOLDER, help="Library of the people it learns from.")
@click.option("--library", required=True, type=_FOLDER, help="Library of other people, quoted.")
@click.option(
    "--stitch",
    "stitchers",
    multiple=True,
    type=click.Choice(STITCHER_NAMES),
    help="Stitcher; may be given several times; all by default.",
)
@click.option(
    "--seeds", default=10, show_default=True, type=click.IntRange(1, len(REPORT_SEEDS)),
    help="So many, two characters each.",
)  # fmt: skip
@click.option("--out", type=_FOLDER, help="Draw the windows that it is surest about.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def critic(
    train: Path,
    library: Path,
    stitchers: tuple[str, ...],
    seeds: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """Train a classifier to tell half-second windows around transitions from captured ones.

    It learns from one library and is quoted on another, which must hold other people. An AUC of 0.5
    means that it cannot tell. Beside each stitcher stand what it makes of the legs alone and of the
    other joints alone, and of streamed windows without a transition; one row tells captured takes
    from other captured takes. Intervals draw takes.
    """
    for path in (train, library):
        open_library(path)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    names = stitchers or STITCHER_NAMES
    for row in criticise(Bench(train), Bench(library), names, out, REPORT_SEEDS[:seeds]):
        rows.append(row)
        if not as_json:
            click.echo(_line(row))
    if as_json:
        settings = {
            "version": __version__,
            "seeds": list(REPORT_SEEDS[:seeds]),
            "scripts": SCRIPTS,
            "command": " ".join(sys.argv[1:]),
        }
        click.echo(json.dumps({"settings": settings, "rows": rows}))


def _line(row: dict[str, Any]) -> str:
    return (
        f"{row['library']:<14}{row['stitch'] or 'captured':<12}{_KINDS[row['row']]:<16}"
        f"{row['joints']:<8}{row['critic_auc']:.3f} [{row['critic_auc_low']:.3f}, "
        f"{row['critic_auc_high']:.3f}]  {row['windows']} windows of {row['takes']} takes"
    )
