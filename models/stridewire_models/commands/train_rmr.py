"""`stridewire train rmr`: the recurrent motion refiner, from captured motion."""

import json
import time
from pathlib import Path

import click
import numpy as np

from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.commands.split_import import clips_of, split_option

_LOOK_EVERY = 200
VARIANTS = ("steps", "paper")
CELLS = ("bgru", "blstm", "gru", "lstm")


@click.command()
@split_option
@click.option(
    "--out",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder of the run; an unfinished one goes on where its checkpoint is.",
)
@click.option(
    "--variant", type=click.Choice(VARIANTS), default=VARIANTS[0], show_default=True,
    help="Guidance of feet, which ships, or whole poses as in the paper.",
)  # fmt: skip
@click.option(
    "--cell", type=click.Choice(CELLS), default=CELLS[0], show_default=True,
    help="Of the recurrent layers of the variant paper.",
)  # fmt: skip
@click.option("--seed", default=0, show_default=True, help="Seed of weights and pairs.")
@click.option("--steps", type=click.IntRange(1), help="Steps instead of the recipe's.")
@click.option(
    "--part", type=click.FloatRange(0.0, 1.0, min_open=True), default=1.0, show_default=True,
    help="Share of the training clips to use.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def rmr(
    data: Path,
    out: Path,
    variant: str,
    cell: str,
    seed: int,
    steps: int | None,
    part: float,
    as_json: bool,
) -> None:
    """Train the refiner on one thread (needs torch)."""
    try:
        import torch

        from stridewire_models.rmr.variants import run_of
    except ModuleNotFoundError as error:
        raise click.ClickException(
            f"training needs {error.name}: pip install 'stridewire[server,train]'"
        ) from error
    if variant != "paper" and cell != CELLS[0]:
        raise click.BadParameter("only the variant paper has a choice", param_hint="--cell")
    torch.set_num_threads(1)
    began = time.monotonic()
    clips = clips_of(data, "train", as_json)
    kept = np.sort(np.random.default_rng(0).permutation(len(clips))[: round(part * len(clips))])
    train = Takes.of(clips[i] for i in kept)
    validation = Takes.of(clips_of(data, "validation", as_json))
    run = run_of(out, variant, cell, steps, train, validation, seed)
    # the setting is the thread's, so that it must not outlive the training
    torch.set_flush_denormal(True)
    try:
        with click.progressbar(length=run.recipe.steps, label="training", hidden=as_json) as bar:
            run.train(bar.update, _LOOK_EVERY)
    finally:
        torch.set_flush_denormal(False)
    facts = {
        "out": str(out),
        "variant": variant,
        "seed": seed,
        "clips": len(kept),
        "steps": run.progress.step,
        "validation": round(run.progress.best, 5),
        "cpu_minutes": round(run.progress.cpu_s / 60.0, 1),
        "minutes": round((time.monotonic() - began) / 60.0, 1),
    }
    click.echo(json.dumps(facts) if as_json else _sentence(facts))


def _sentence(facts: dict[str, object]) -> str:
    return (
        "{out}: {variant}, seed {seed}, {steps} steps, validation loss {validation}, "
        "{cpu_minutes} minutes of one thread"
    ).format(**facts)
