"""The paper's tables: which trainings they are made of, and their rows."""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import torch

from stridewire_engine.evaluation.training_runs import CONFIGURATION, CURVE
from stridewire_models.rmr.paper_task import PaperData, PaperTask
from stridewire_models.rmr.recipes import PAPER, PaperRecipe
from stridewire_models.rmr.training import Run

LOOK_EVERY = 200
SEED = 0
TRAININGS: Mapping[str, PaperRecipe] = {
    "bgru": PAPER,
    "gru": replace(PAPER, cell="gru"),
    "lstm": replace(PAPER, cell="lstm"),
    "no-trajectory": replace(PAPER, trajectory=0.0),
    "blstm": replace(PAPER, cell="blstm"),
    "begin-10": replace(PAPER, begin=10),
    "begin-3": replace(PAPER, begin=3),
}
"""By name; `bgru` is the paper's own."""


def train(name: str, data: PaperData, folder: Path, advance: Callable[[int], None]) -> None:
    """Run one of the trainings, or what is left of it.

    Args:
        name: Of `TRAININGS`.
        data: Pairs.
        folder: Of the run.
        advance: Told of the steps that are done.
    """
    recipe = TRAININGS[name]
    # made before, so that no training is charged for pairs that others use too
    for number in range(math.ceil(recipe.steps / recipe.fresh_every)):
        data.pool(recipe.pool, recipe.furthest, number)
    torch.manual_seed(SEED)
    run = Run(folder, recipe, PaperTask(recipe, data), SEED)
    run.train(advance, LOOK_EVERY)


def row(name: str, folder: Path) -> dict[str, Any]:
    """Return what a finished training is told by: recipe, commit, curve.

    Args:
        name: Of `TRAININGS`.
        folder: Of the run.
    """
    told = json.loads((folder / CONFIGURATION).read_text())
    curve = json.loads((folder / CURVE).read_text())
    last = curve[-1]
    return {
        "training": name,
        **{key: told[key] for key in ("seed", "commit", "cell", "width", "begin", "trajectory")},
        "steps": last["step"],
        "cpu_min": round(last["cpu_s"] / 60.0, 2),
        "curve": curve,
    }


def is_done(name: str, folder: Path) -> bool:
    """Tell whether a training has come to its end with this recipe.

    Args:
        name: Of `TRAININGS`.
        folder: Of the run.
    """
    path = folder / CONFIGURATION
    if not path.is_file() or not (folder / CURVE).is_file():
        return False
    told, recipe = json.loads(path.read_text()), asdict(TRAININGS[name])
    same = all(told[key] == value for key, value in recipe.items())
    return bool(same and row(name, folder)["steps"] >= recipe["steps"])
