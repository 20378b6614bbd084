"""Variants of the refiner: the run that trains each."""

from dataclasses import replace
from pathlib import Path

import torch

from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.paper_networks import CELLS
from stridewire_models.rmr.paper_task import PaperData, PaperTask
from stridewire_models.rmr.recipes import PAPER, STEPS, StepsRecipe
from stridewire_models.rmr.steps_task import StepsTask
from stridewire_models.rmr.training import Run


def run_of(
    folder: Path,
    variant: str,
    cell: str,
    steps: int | None,
    train: Takes,
    validation: Takes,
    seed: int,
) -> Run:
    """Return the run of a variant, which goes on where its folder has a checkpoint.

    Args:
        folder: Of the run.
        variant: `steps` or `paper`.
        cell: Of the paper's recurrent layers.
        steps: Instead of the recipe's.
        train: Takes to train on.
        validation: Takes to judge on.
        seed: Of weights and pairs.
    """
    if variant == "paper":
        told = next(known for known in CELLS if known == cell)
        recipe = replace(PAPER, cell=told, steps=steps or PAPER.steps)
        torch.manual_seed(seed)
        return Run(folder, recipe, PaperTask(recipe, PaperData(train, validation, seed)), seed)
    return steps_run(folder, replace(STEPS, steps=steps or STEPS.steps), train, validation, seed)


def steps_run(folder: Path, recipe: StepsRecipe, train: Takes, validation: Takes, seed: int) -> Run:
    """Return a run of what ships.

    Args:
        folder: Of the run.
        recipe: How to train.
        train: Takes to train on.
        validation: Takes to judge on.
        seed: Of weights and pairs.
    """
    torch.manual_seed(seed)
    return Run(folder, recipe, StepsTask(recipe, train, validation, seed), seed)
