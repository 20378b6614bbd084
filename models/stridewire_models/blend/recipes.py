"""Recipes: how each variant is trained."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Phase:
    """A stretch of training with one batch size."""

    steps: int
    batch: int
    """Pairs."""
    between: int
    """Postures of each pair."""
    learning_rate: float
    warm: float
    """Share of the steps that the rate rises; it falls to 1 % after. 0 keeps it."""
    patience: int
    """Looks at the validation data without getting better that end the phase."""


@dataclass(frozen=True)
class Recipe:
    """All phases of a variant."""

    variant: str
    phases: tuple[Phase, ...]
    weight_decay: float
    averaging: float
    """Decay of the running mean of the weights that is judged and kept; 0 for the weights as is."""
    vary_rigs: bool
    """Whether pairs are also shown as other rigs would hold them."""

    @property
    def steps(self) -> int:
        """Steps of all phases."""
        return sum(phase.steps for phase in self.phases)


RECIPES = {
    "correction": Recipe("correction", (Phase(3_000, 256, 2, 1e-3, 0.1, 8),), 1e-2, 0.999, True),
    # two phases, the second to fine-tune (Gaisbauer et al. 2019, section 3.4)
    "paper": Recipe(
        "paper",
        (Phase(60_000, 32, 1, 1e-3, 0.0, 30), Phase(50, 30_000, 1, 1e-3, 0.0, 10)),
        0.0,
        0.0,
        False,
    ),
}
"""Each within 15 minutes of one thread."""
