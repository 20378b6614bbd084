"""`stridewire train rmr-tables`: the trainings behind the tables of the paper's network."""

import json
from pathlib import Path

import click

from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.commands.split_import import clips_of, split_option


@click.command("rmr-tables")
@split_option
@click.option(
    "--out",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder of the runs; finished ones stay, an unfinished one goes on.",
)
@click.option(
    "--results",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="JSON file of rows, written as each run ends.",
)
@click.option(
    "--picture",
    type=click.Path(dir_okay=False, path_type=Path),
    help="PNG of how far roots stray.",
)
def rmr_tables(data: Path, out: Path, results: Path, picture: Path | None) -> None:
    """Train the paper's refiner with each cell, T_begin and loss, on one thread (needs torch)."""
    try:
        import torch

        from stridewire_models.rmr.paper_drift import draw_drift, drift_rows
        from stridewire_models.rmr.paper_tables import TRAININGS, is_done, row, train
        from stridewire_models.rmr.paper_task import PaperData
    except ModuleNotFoundError as error:
        raise click.ClickException(
            f"training needs {error.name}: pip install 'stridewire[server,train]'"
        ) from error
    torch.set_num_threads(1)
    pairs = PaperData(
        Takes.of(clips_of(data, "train", False)), Takes.of(clips_of(data, "validation", False))
    )
    plain = pairs.figures(pairs.x)
    about = {
        "command": "stridewire train rmr-tables --data DIR --out RUNS --results FILE",
        "validation_pairs": len(pairs.x),
        "spring": {name: round(value, 5) for name, value in plain.items()},
    }
    # the setting is the thread's, so that it must not outlive the training
    torch.set_flush_denormal(True)
    try:
        for name, recipe in TRAININGS.items():
            if not is_done(name, out / name):
                with click.progressbar(length=recipe.steps, label=name) as bar:
                    train(name, pairs, out / name, bar.update)
            rows = [row(done, out / done) for done in TRAININGS if is_done(done, out / done)]
            results.write_text(_table(about, rows))
    finally:
        torch.set_flush_denormal(False)
    drift = list(drift_rows(out, pairs.x, Takes.of(clips_of(data, "test", False))))
    results.write_text(_table(about, [*rows, *drift]))
    if picture is not None:
        draw_drift(drift, picture)


def _table(about: dict[str, object], rows: list[dict[str, object]]) -> str:
    lines = ",\n".join(json.dumps(row) for row in rows)
    return f'{{"settings": {json.dumps(about)},\n"rows": [\n{lines}\n]}}\n'
