"""Recipes: how each variant is trained."""

from dataclasses import dataclass

from stridewire_models.rmr.networks import Shape
from stridewire_models.rmr.paper_networks import Cell


@dataclass(frozen=True)
class Recipe:
    """What trainings of all variants have."""

    variant: str
    steps: int
    batch: int
    """Pairs a step."""
    learning_rate: float
    warm: float
    """Share of the steps that the rate rises."""
    last_rate: float
    """Share of the learning rate at the end, to which a cosine falls; 1 keeps it."""
    weight_decay: float
    averaging: float
    """Decay of the running mean of the weights that is judged and kept."""
    pool: int
    """Pairs that are made at once."""
    fresh_every: int
    """Steps after which other pairs are made."""
    furthest: int
    """Rank of the furthest segment that is set into pairs; near ones alone are too easy."""


@dataclass(frozen=True)
class StepsRecipe(Recipe):
    """Training of what ships."""

    live: float
    """Share of live plans."""
    shape: Shape
    """Of the network."""


@dataclass(frozen=True)
class PaperRecipe(Recipe):
    """Training of the paper's network."""

    cell: Cell
    width: int
    """Of every hidden layer; the paper's is 256."""
    begin: int
    """T_begin, frames that are to stay as they were read."""
    trajectory: float
    """Weight of the loss of the root's path; the paper's is 1."""


STEPS = StepsRecipe("steps", 4_000, 96, 1e-3, 0.02, 0.02, 1e-4, 0.998, 4_000, 400, 40, 0.4, Shape())
"""Within an hour of one thread."""
# a rate that stays makes networks comparable at any step; one that rises fast stops all learning
PAPER = PaperRecipe(
    "paper", 3_200, 32, 1e-3, 0.3, 1.0, 0.0, 0.99, 3_400, 600, 10, "bgru", 128, 5, 1.0
)  # fmt: skip
"""Three minutes of one thread, where the paper has 5,000 rounds of 3,435 pairs."""
