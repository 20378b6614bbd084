"""The network: tokens of frames, an encoder, a layer that mixes moments, a decoder."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import torch
from torch import Tensor, nn

from stridewire.motion.array_types import Floats
from stridewire_engine.networks.rmr.features import INPUTS
from stridewire_engine.networks.rmr.guidance import CURVES, PLANTED
from stridewire_engine.networks.rmr.plans import TOKEN, WINDOW
from stridewire_models.blend.networks import Novelty

_STILL = 0.05
_FLAGS = 2
"""The last inputs are flags, which are not standardised."""
_DILATIONS = (1, 2, 4)
"""Of layers of three taps, which see fifteen tokens together."""
_OUTPUTS = CURVES + PLANTED
"""Of four frames, whatever a token has."""


@dataclass(frozen=True)
class Shape:
    """Size of a network."""

    width: int = 128
    """Of its layers."""
    token: int = 4
    """Frames that are read at once; a divisor or a multiple of four."""
    window: int = 60
    """Frames that are read; those after them are left to the clips."""
    mixing: Literal["both ways", "one way", "convolution"] = "both ways"
    """How moments hear of each other: a recurrent layer, or dilated convolutions."""


class Dilated(nn.Module):
    """Convolutions over tokens, each wider than the last, each added to what it read."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.layers = nn.ModuleList(
            nn.Conv1d(width, width, 3, padding=gap, dilation=gap) for gap in _DILATIONS
        )

    def forward(self, x: Tensor) -> Tensor:
        """Mix tokens `(N, T, W)`."""
        x = x.transpose(1, 2)
        for layer in self.layers:
            x = x + torch.relu(layer(x))
        return x.transpose(1, 2)


class Recurrent(nn.GRU):
    """A recurrent layer that returns no state."""

    def __init__(self, width: int, both_ways: bool) -> None:
        super().__init__(width, width, batch_first=True, bidirectional=both_ways)

    def forward(self, x: Tensor) -> Tensor:  # type: ignore[override]
        """Mix tokens `(N, T, W)` into `(N, T, W)`, both ways `(N, T, 2 W)`."""
        out: Tensor = super().forward(x)[0]
        return out


class Steps(nn.Module):
    """Says every four frames where curves' control points lie, and which toes are planted."""

    mean: Tensor
    deviation: Tensor

    def __init__(self, shape: Shape = Shape()) -> None:
        super().__init__()
        self.shape = shape
        width, both = shape.width, shape.mixing == "both ways"
        self.register_buffer("mean", torch.zeros(INPUTS))
        self.register_buffer("deviation", torch.ones(INPUTS))
        self.novelty = Novelty(TOKEN * INPUTS)
        self.encoder = nn.Sequential(
            nn.Linear(shape.token * INPUTS, width), nn.ReLU(), nn.Linear(width, width), nn.ReLU()
        )
        convolution = shape.mixing == "convolution"
        self.recurrent = Dilated(width) if convolution else Recurrent(width, both)
        # one output block has several short tokens, or one long token several blocks
        read = (1 + both) * width * max(1, TOKEN // shape.token)
        last = nn.Linear(width, _OUTPUTS * max(1, shape.token // TOKEN))
        self.decoder = nn.Sequential(nn.Linear(read, width), nn.ReLU(), last)
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
        n, blocks = z.shape[0], z.shape[1] // TOKEN
        distance = self.novelty(z.reshape(n * blocks, TOKEN * INPUTS)).reshape(n, blocks)
        read = z[:, : self.shape.window]
        told = read.reshape(n, read.shape[1] // self.shape.token, self.shape.token * INPUTS)
        passed = self.recurrent(self.encoder(told))
        out = self.decoder(passed.reshape(n, -1, self.decoder[0].in_features))
        out = out.reshape(n, -1, _OUTPUTS)
        if self.shape.window < WINDOW:
            out = nn.functional.pad(out, (0, 0, 0, blocks - out.shape[1]))
        return out[..., :CURVES], out[..., CURVES:], torch.mean(distance, dim=1)
