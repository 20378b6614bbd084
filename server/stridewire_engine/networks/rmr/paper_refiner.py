"""The paper's own network: whole poses in, whole poses out (Kim et al. 2023, sections 5 and 6).

It is measured beside the refiner that ships and serves nothing.
"""

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire_engine.networks.onnx_model import ModelError, OnnxModel
from stridewire_engine.networks.rmr.paper_poses import CONTACTS, NUMBERS
from stridewire_engine.networks.rmr.plans import WINDOW
from stridewire_engine.networks.rmr.refiner import facts

SHIFT = WINDOW // 2
"""Frames from one window to the next."""
_AT_ONCE = 100


class PaperRefiner:
    """Writes poses anew, window by window."""

    def __init__(self, model: OnnxModel) -> None:
        """Check a model.

        Raises:
            ModelError: If it was made for other poses, another skeleton or another network.
        """
        model.require(facts("paper"))
        if model.inputs != NUMBERS:
            raise ModelError(
                f"{model.name} reads {model.inputs} numbers, expected {NUMBERS}; export it again"
            )
        self.model = model
        self.budget_min = float(model.facts["budget_min"])
        """Minutes of one thread that it was trained for."""

    def refine(self, numbers: Floats) -> Floats:
        """Return windows `(N, T, 191)` as the network has them."""
        parts = [
            self.model.run(numbers[at : at + _AT_ONCE])[0]
            for at in range(0, len(numbers), _AT_ONCE)
        ]
        return np.concatenate(parts)

    def slide(self, numbers: Floats, shift: int = SHIFT) -> Floats:
        """Refine longer motions `(N, T, 191)` in windows, each from what the one before left.

        Args:
            numbers: Of a window's frames or more.
            shift: Frames from one window to the next.
        """
        made = numbers.copy()
        last = numbers.shape[1] - WINDOW
        for start in [*range(0, last, shift), last]:
            part = self.refine(made[:, start : start + WINDOW])
            part[..., CONTACTS] = part[..., CONTACTS] > 0.0
            made[:, start : start + WINDOW] = part
        return made
