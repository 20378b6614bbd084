"""Recipes: how each variant is trained."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Recipe:
    """One variant's training."""

    variant: str
    steps: int
    batch: int
    """Pairs a step."""
    learning_rate: float
    weight_decay: float
    averaging: float
    """Decay of the running mean of the weights that is judged and kept."""
    pool: int
    """Pairs that are made at once."""
    fresh_every: int
    """Steps after which other pairs are made."""
    live: float
    """Share of live plans."""
    furthest: int
    """Rank of the furthest segment that is set into pairs; near ones alone are too easy."""


RECIPES = {"steps": Recipe("steps", 4_000, 96, 1e-3, 1e-4, 0.998, 4_000, 400, 0.4, 40)}
"""Within an hour of one thread."""
