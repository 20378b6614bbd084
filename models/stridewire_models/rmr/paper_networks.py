"""The paper's network: encoder, two recurrent layers, decoder (Kim et al. 2023, section 5).

It says what is to be added to what springs make of the clips, where the paper's says poses, and
reads four frames at once, where the paper's reads one: so it learns within minutes of one thread.
"""

from typing import Literal

import numpy as np
import torch
from torch import Tensor, nn

from stridewire.motion.array_types import Floats
from stridewire_engine.networks.rmr.paper_poses import (
    CONTACTS,
    NUMBERS,
    POINTS,
    ROOT,
    ROTATIONS,
    VELOCITIES,
)
from stridewire_engine.networks.rmr.plans import TOKEN

Cell = Literal["bgru", "blstm", "gru", "lstm"]
CELLS: tuple[Cell, ...] = ("bgru", "blstm", "gru", "lstm")
_LAYERS = 2
_DROPOUT = 0.5
_LEAK = 0.1
_LABEL_LOGIT = 2.0
_LEAST = ((ROOT, 1e-3), (POINTS, 0.01), (ROTATIONS, 0.05), (VELOCITIES, 0.05))
"""Deviations below which numbers count as still, and are not blown up."""
_LEAST_ADDED = 0.1
"""Of these, what is added has at least."""


class PaperNetwork(nn.Module):
    """Reads and writes `(N, T, 191)`: poses as `paper_poses` has them, contacts out as logits."""

    mean: Tensor
    deviation: Tensor
    added: Tensor

    def __init__(self, cell: Cell, width: int) -> None:
        """Begin as what it reads.

        Args:
            cell: Of the recurrent layers; `b` for both ways.
            width: Of every hidden layer.
        """
        super().__init__()
        self.register_buffer("mean", torch.zeros(NUMBERS))
        self.register_buffer("deviation", torch.ones(NUMBERS))
        self.register_buffer("added", torch.ones(NUMBERS))
        self.encoder = nn.Sequential(
            nn.Linear(TOKEN * NUMBERS, width), nn.ReLU(), nn.Linear(width, width), nn.ReLU()
        )
        both = cell.startswith("b")
        kind = nn.GRU if cell.endswith("gru") else nn.LSTM
        self.recurrent = kind(
            width, width, _LAYERS, batch_first=True, bidirectional=both, dropout=_DROPOUT
        )
        last = nn.Linear(width, TOKEN * NUMBERS)
        # what is to be added is 0 before the seam: that would silence the paper's ReLU for good
        bent = nn.LeakyReLU(_LEAK)
        self.decoder = nn.Sequential(nn.Linear((1 + both) * width, width), bent, last)
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)

    def fit(self, examples: Floats, truth: Floats) -> None:
        """Take statistics of the training data, `(N, T, 191)` read and true."""
        mean, deviation = examples.mean(axis=(0, 1)), examples.std(axis=(0, 1))
        added = (truth - examples).std(axis=(0, 1))
        for part, least in _LEAST:
            deviation[part] = np.maximum(deviation[part], least)
            added[part] = np.maximum(added[part], _LEAST_ADDED * least)
        mean[CONTACTS], deviation[CONTACTS], added[CONTACTS] = 0.0, 1.0, 1.0
        for buffer, values in ((self.mean, mean), (self.deviation, deviation), (self.added, added)):
            buffer.copy_(torch.tensor(values))

    def forward(self, x: Tensor) -> Tensor:
        """Return poses `(N, T, 191)`; T is a multiple of four."""
        n, frames = x.shape[0], x.shape[1]
        z = ((x - self.mean) / self.deviation).reshape(n, frames // TOKEN, TOKEN * NUMBERS)
        passed, _ = self.recurrent(self.encoder(z))
        added = self.added * self.decoder(passed).reshape(n, frames, NUMBERS)
        poses = x[..., : CONTACTS.start] + added[..., : CONTACTS.start]
        logits = _LABEL_LOGIT * (2.0 * x[..., CONTACTS] - 1.0) + added[..., CONTACTS]
        return torch.cat([poses, logits], dim=-1)
