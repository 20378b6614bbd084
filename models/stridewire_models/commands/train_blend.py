"""`stridewire train blend`: the posture-blending network, from captured motion."""

import json
import time
from dataclasses import replace
from pathlib import Path

import click

from stridewire_engine.networks.blend.pairs import Frames
from stridewire_models.commands.split_import import clips_of, split_option

VARIANTS = ("correction", "paper")
_LOOK_EVERY = 500


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
    help="A correction to the linear blend, or the posture itself as in the paper.",
)  # fmt: skip
@click.option("--seed", default=0, show_default=True, help="Seed of weights and pairs.")
@click.option(
    "--steps", type=click.IntRange(1), help="Steps of each phase instead of the recipe's."
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def blend(data: Path, out: Path, variant: str, seed: int, steps: int | None, as_json: bool) -> None:
    """Train the posture-blending network on one thread (needs torch)."""
    try:
        import torch

        from stridewire_models.blend.recipes import RECIPES
        from stridewire_models.blend.training import Run
    except ModuleNotFoundError as error:
        raise click.ClickException(
            f"training needs {error.name}: pip install 'stridewire[server,train]'"
        ) from error
    torch.set_num_threads(1)
    recipe = RECIPES[variant]
    if steps is not None:
        phases = tuple(replace(phase, steps=min(steps, phase.steps)) for phase in recipe.phases)
        recipe = replace(recipe, phases=phases)
    began = time.monotonic()
    train = Frames.of(clips_of(data, "train", as_json), mirror=True)
    validation = Frames.of(clips_of(data, "validation", as_json))
    run = Run(out, recipe, train, validation, seed)
    # the setting is the thread's, so that it must not outlive the training
    torch.set_flush_denormal(True)
    try:
        with click.progressbar(length=recipe.steps, label="training", hidden=as_json) as bar:
            run.train(bar.update, _LOOK_EVERY)
    finally:
        torch.set_flush_denormal(False)
    facts = {
        "out": str(out),
        "variant": variant,
        "seed": seed,
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
