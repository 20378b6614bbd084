"""What trains the refiner that ships: guidance of feet, from pairs and live plans."""

from collections.abc import Mapping

import numpy as np
import torch
from torch import Tensor, nn

from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.losses import loss_of
from stridewire_models.rmr.networks import Steps
from stridewire_models.rmr.recipes import StepsRecipe
from stridewire_models.rmr.supply import Supply, judged


class StepsTask:
    """Guidance, its pairs, its loss."""

    def __init__(self, recipe: StepsRecipe, train: Takes, validation: Takes, seed: int) -> None:
        """Make the first pairs; weights are of torch's generator."""
        self.network = Steps(recipe.shape)
        self._seed = seed
        self._batch = recipe.batch
        self._supply = Supply(train, recipe.pool, recipe.live, recipe.furthest)
        self._judged = judged(validation, recipe.live > 0.0)
        self.renew(0)
        self.network.fit(self._pool.x.numpy())

    def renew(self, number: int) -> None:
        """Make the pairs of that number."""
        self._pool = self._supply.fresh(np.random.default_rng((self._seed, 1, number)))

    def loss(self, rng: np.random.Generator) -> Tensor:
        """Return the loss of a batch that is drawn."""
        chosen = rng.integers(0, len(self._pool), self._batch)
        parts = loss_of(self.network, self._pool[torch.from_numpy(chosen)])
        return torch.stack(list(parts.values())).sum()

    def look(self, network: nn.Module) -> Mapping[str, float]:
        """Return the loss on the validation plans, and its parts."""
        assert isinstance(network, Steps)
        parts = {name: float(value) for name, value in loss_of(network, self._judged).items()}
        return {"validation": sum(parts.values()), **parts}
