"""The network: tokens of four frames, an encoder, a recurrent layer both ways, a decoder."""

import numpy as np
import torch
from torch import Tensor, nn

from stridewire.motion.array_types import Floats
from stridewire_engine.networks.rmr.features import INPUTS
from stridewire_engine.networks.rmr.guidance import CURVES, PLANTED
from stridewire_engine.networks.rmr.plans import TOKEN
from stridewire_models.blend.networks import Novelty

WIDTH = 128
_STILL = 0.05
_FLAGS = 2
"""The last inputs are flags, which are not standardised."""


class Steps(nn.Module):
    """Says once a token where curves' control points lie, and which toes are planted."""

    mean: Tensor
    deviation: Tensor

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(INPUTS))
        self.register_buffer("deviation", torch.ones(INPUTS))
        self.novelty = Novelty(TOKEN * INPUTS)
        self.encoder = nn.Sequential(
            nn.Linear(TOKEN * INPUTS, WIDTH), nn.ReLU(), nn.Linear(WIDTH, WIDTH), nn.ReLU()
        )
        self.recurrent = nn.GRU(WIDTH, WIDTH, batch_first=True, bidirectional=True)
        last = nn.Linear(WIDTH, CURVES + PLANTED)
        self.decoder = nn.Sequential(nn.Linear(2 * WIDTH, WIDTH), nn.ReLU(), last)
        # begin as the plain stitcher with the clips' labels
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)

    def fit(self, examples: Floats) -> None:
        """Take statistics of inputs `(N, T, D)` of the training data."""
        mean = examples.mean(axis=(0, 1))
        deviation = np.maximum(examples.std(axis=(0, 1)), _STILL)
        mean[-_FLAGS:], deviation[-_FLAGS:] = 0.0, 1.0
        self.mean.copy_(torch.tensor(mean))
        self.deviation.copy_(torch.tensor(deviation))
        z = (examples - mean) / deviation
        self.novelty.fit(z.reshape(-1, TOKEN * INPUTS).astype(np.float64))

    def forward(self, x: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Return curves, contact logits and distances of inputs `(N, T, D)`."""
        z = (x - self.mean) / self.deviation
        n, tokens = z.shape[0], z.shape[1] // TOKEN
        told = z.reshape(n, tokens, TOKEN * INPUTS)
        distance = self.novelty(told.reshape(n * tokens, TOKEN * INPUTS)).reshape(n, tokens)
        passed, _ = self.recurrent(self.encoder(told))
        out = self.decoder(passed)
        return out[..., :CURVES], out[..., CURVES:], torch.mean(distance, dim=1)
