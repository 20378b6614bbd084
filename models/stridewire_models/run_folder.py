"""The folder of a training run: what it is, its curve, its best weights, where it goes on from."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import torch
from torch import nn
from torch.optim.swa_utils import AveragedModel, get_ema_multi_avg_fn

from stridewire_engine.evaluation.checkout import commit
from stridewire_engine.evaluation.training_runs import CONFIGURATION, CURVE, ENDED, configuration

CHECKPOINT, BEST = "checkpoint.pt", "best.pt"


class RunFolder:
    """Files of one run."""

    def __init__(self, path: Path) -> None:
        """Make the folder where there is none."""
        self.path = path
        path.mkdir(parents=True, exist_ok=True)

    @property
    def is_begun(self) -> bool:
        """Whether there is a checkpoint to go on from."""
        return (self.path / CHECKPOINT).is_file()

    def begin(self, facts: Mapping[str, Any]) -> None:
        """Write what the run is, and the commit of the code."""
        self._tell({"commit": commit(), **facts, ENDED: False})

    def end(self) -> None:
        """Note that the run has come to its end."""
        self._tell({**configuration(self.path), ENDED: True})

    def keep(self, network: nn.Module) -> None:
        """Keep weights as the best so far."""
        torch.save(network.state_dict(), self.path / BEST)

    def best(self) -> Mapping[str, Any]:
        """Return the best weights so far."""
        weights: Mapping[str, Any] = torch.load(self.path / BEST)
        return weights

    def draw(self, curve: Sequence[Mapping[str, float]]) -> None:
        """Write the looks at the validation data so far."""
        (self.path / CURVE).write_text(json.dumps(curve) + "\n")

    def save(self, state: Mapping[str, Any]) -> None:
        """Write a checkpoint in place of the last one, whole or not at all."""
        fresh = self.path / f"{CHECKPOINT}.new"
        torch.save(dict(state), fresh)
        fresh.replace(self.path / CHECKPOINT)

    def load(self) -> dict[str, Any]:
        """Return the last checkpoint."""
        state: dict[str, Any] = torch.load(self.path / CHECKPOINT, weights_only=False)
        return state

    def _tell(self, facts: Mapping[str, Any]) -> None:
        (self.path / CONFIGURATION).write_text(json.dumps(facts, indent=1) + "\n")


def running_mean(network: nn.Module, decay: float) -> AveragedModel:
    """Return a network whose weights follow another's as a running mean.

    Args:
        network: In training.
        decay: Share that stays of the mean at each step; 0 for the weights as they are.
    """
    average = get_ema_multi_avg_fn(decay)  # type: ignore[no-untyped-call]
    return AveragedModel(network, multi_avg_fn=average)
