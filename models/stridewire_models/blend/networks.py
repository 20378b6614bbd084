"""The networks: the paper's, and the bounded correction to a linear blend."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor, nn

from stridewire.motion.array_types import Floats
from stridewire_engine.networks.blend.correction import CHANNELS, ORDER
from stridewire_engine.networks.blend.features import (
    END_PLACES,
    INPUTS,
    JOINTS,
    LOG_TIME,
    PAPER_INPUTS,
    POSTURE_SIZE,
    START_PLACES,
)

WIDTH = 512
_LAYERS = 3
_COMPONENTS = 64
_STILL = 0.05
"""Inputs that vary less are not blown up: some people's joints do what these never do."""
VARIANTS = ("correction", "paper")
"""The first is what ships."""


class Novelty(nn.Module):
    """How far inputs are from the training data: the Mahalanobis length in principal components.

    The mean square of the whitened components and of what they leave over; about 1 for pairs like
    those trained on.
    """

    axes: Tensor
    deviation: Tensor
    rest: Tensor

    def __init__(self, inputs: int) -> None:
        super().__init__()
        self.register_buffer("axes", torch.zeros(inputs, _COMPONENTS))
        self.register_buffer("deviation", torch.ones(_COMPONENTS))
        self.register_buffer("rest", torch.ones(()))

    def fit(self, z: Floats) -> None:
        """Fit on standardised inputs `(N, D)` of the training data."""
        _, vectors = np.linalg.eigh(z.T @ z / len(z))
        axes = vectors[:, ::-1][:, :_COMPONENTS].copy()
        along = z @ axes
        rest = np.mean((z - along @ axes.T) ** 2)
        self.axes.copy_(torch.tensor(axes))
        self.deviation.copy_(torch.tensor(along.std(0)))
        self.rest.copy_(torch.tensor(rest))

    def forward(self, z: Tensor) -> Tensor:
        """Return the distance `(N,)` of standardised inputs `(N, D)`."""
        along = z @ self.axes
        left = z - along @ self.axes.T
        inside = torch.mean((along / self.deviation) ** 2, dim=-1)
        outside = torch.mean(left * left, dim=-1) / self.rest
        return torch.sqrt(0.5 * (inside + outside))


class Blend(nn.Module):
    """Standardise, three hidden layers of SELU, scale; and tell how novel the input is."""

    mean: Tensor
    deviation: Tensor
    offset: Tensor
    scale: Tensor

    def __init__(self, inputs: int, outputs: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(inputs))
        self.register_buffer("deviation", torch.ones(inputs))
        self.register_buffer("offset", torch.zeros(outputs))
        self.register_buffer("scale", torch.ones(outputs))
        sizes = [inputs, *[WIDTH] * _LAYERS]
        hidden: list[nn.Module] = []
        for a, b in pairwise(sizes):
            layer = nn.Linear(a, b)
            nn.init.kaiming_normal_(layer.weight, nonlinearity="linear")
            nn.init.zeros_(layer.bias)
            hidden += [layer, nn.SELU()]
        self.hidden = nn.Sequential(*hidden)
        self.last = nn.Linear(WIDTH, outputs)
        self.novelty = Novelty(inputs)

    def fit(self, examples: Floats) -> None:
        """Take statistics of inputs `(N, D)` of the training data."""
        mean, deviation = examples.mean(0), np.maximum(examples.std(0), _STILL)
        self.mean.copy_(torch.tensor(mean))
        self.deviation.copy_(torch.tensor(deviation))
        self.novelty.fit(((examples - mean) / deviation).astype(np.float64))

    def forward(self, x: Tensor) -> tuple[Tensor, Tensor]:
        """Return outputs `(N, O)` and distances `(N,)` of inputs `(N, D)`."""
        z = (x - self.mean) / self.deviation
        return self.offset + self.scale * self.last(self.hidden(z)), self.novelty(z)


class Correction(Blend):
    """Coefficients of the correction to a linear blend, `(N, ORDER, CHANNELS)`."""

    bounds: Tensor

    def __init__(self) -> None:
        super().__init__(INPUTS, ORDER * CHANNELS)
        self.register_buffer("bounds", torch.ones(CHANNELS))
        # begin as the linear blend
        nn.init.zeros_(self.last.weight)
        nn.init.zeros_(self.last.bias)

    def size(self, x: Tensor) -> Tensor:
        """Return how large corrections of pairs `(N, INPUTS)` are apt to be, `(N, 1)`.

        The root of the way of the joints times the duration: in proportion to it grows what linear
        blends of training data lack, over ways of 1 cm to 1 m and durations of 0.1 to 1 s. Postures
        that are one are blended to that one.
        """
        ways = (x[:, END_PLACES] - x[:, START_PLACES]).reshape(-1, JOINTS - 1, 3)
        way = torch.sqrt(torch.sum(ways * ways, dim=-1)).mean(dim=-1, keepdim=True)
        return torch.sqrt(way * torch.exp(x[:, LOG_TIME : LOG_TIME + 1]))

    def bound(self, bounds: Floats, scale: Floats) -> None:
        """Set the largest correction of each channel and the usual one at size 1 `(CHANNELS,)`."""
        self.bounds.copy_(torch.tensor(bounds))
        self.scale.copy_(torch.tensor(np.tile(scale, ORDER)))

    def forward(self, x: Tensor) -> tuple[Tensor, Tensor]:
        """Return coefficients and distances `(N,)` of inputs `(N, 398)`."""
        flat, distance = super().forward(x)
        return (self.size(x) * flat).reshape(-1, ORDER, CHANNELS), distance


class Paper(Blend):
    """The paper's network: the posture itself, as 135 numbers."""

    def __init__(self) -> None:
        super().__init__(PAPER_INPUTS, POSTURE_SIZE)

    def aim(self, examples: Floats) -> None:
        """Take statistics of outputs `(N, 135)` of the training data."""
        self.offset.copy_(torch.tensor(examples.mean(0)))
        self.scale.copy_(torch.tensor(np.maximum(examples.std(0), 1e-3)))


class Shapes(NamedTuple):
    """What a variant reads and gives, for export."""

    inputs: int
    output: str


SHAPES = {
    "correction": Shapes(INPUTS, "coefficients"),
    "paper": Shapes(PAPER_INPUTS, "posture"),
}


def new_network(variant: str) -> Correction | Paper:
    """Return an untrained network."""
    return Correction() if variant == "correction" else Paper()
