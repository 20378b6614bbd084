"""Training: steps, looks at the validation pairs, checkpoints that a later run goes on from."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np
import torch
from torch import Tensor, nn

from stridewire_models.rmr.recipes import Recipe
from stridewire_models.run_folder import RunFolder, running_mean

_SAVE_EVERY_S = 300.0


class Task(Protocol):
    """What is trained: a network with its data and its loss."""

    @property
    def network(self) -> nn.Module:
        """It."""

    def renew(self, number: int) -> None:
        """Make the pairs of that number."""

    def loss(self, rng: np.random.Generator) -> Tensor:
        """Return the loss of a batch that is drawn."""

    def look(self, network: nn.Module) -> Mapping[str, float]:
        """Judge a network on validation pairs; `validation` is the less the better it is."""


@dataclass
class Progress:
    """Where a run is; all of it is in the checkpoint."""

    step: int = 0
    best: float = math.inf
    cpu_s: float = 0.0
    """Seconds that the thread has worked."""
    curve: list[dict[str, float]] = field(default_factory=list)


class Run:
    """One training run in a folder; made again, it goes on where its checkpoint is."""

    def __init__(self, folder: Path, recipe: Recipe, task: Task, seed: int) -> None:
        """Begin, or go on.

        Args:
            folder: Of the run.
            recipe: How to train.
            task: What.
            seed: Of the batches.
        """
        self.folder = folder
        self._files = RunFolder(folder)
        self.recipe = recipe
        self.progress = Progress()
        self._task = task
        self._seed = seed
        self.average = running_mean(task.network, recipe.averaging)
        self._optimiser = torch.optim.AdamW(
            task.network.parameters(),
            lr=recipe.learning_rate,
            weight_decay=recipe.weight_decay,
            fused=True,
        )
        self._schedule = torch.optim.lr_scheduler.LambdaLR(self._optimiser, self._rate)
        if self._files.is_begun:
            self._load()
        else:
            self._files.begin({"seed": seed, **asdict(recipe)})

    def train(self, advance: Callable[[int], None], look_every: int) -> None:
        """Train to the end.

        Args:
            advance: Told of the steps that are done.
            look_every: Steps from one look at the validation pairs to the next.
        """
        advance(self.progress.step)
        began, saved = time.process_time() - self.progress.cpu_s, time.monotonic()
        while self.progress.step < self.recipe.steps:
            self._step()
            self.progress.cpu_s = time.process_time() - began
            if self.progress.step % look_every == 0 or self.progress.step == self.recipe.steps:
                self._look()
            advance(1)
            if time.monotonic() - saved > _SAVE_EVERY_S:
                self._save()
                saved = time.monotonic()
        self._save()
        self._files.end()

    def _step(self) -> None:
        step, every = self.progress.step, self.recipe.fresh_every
        if step and step % every == 0:
            self._task.renew(step // every)
        loss = self._task.loss(np.random.default_rng((self._seed, 2, step)))
        self._optimiser.zero_grad(set_to_none=True)
        loss.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(self._task.network.parameters(), 1.0)
        self._optimiser.step()
        self._schedule.step()
        self.average.update_parameters(self._task.network)
        self.progress.step += 1

    @torch.no_grad()
    def _look(self) -> None:
        """Judge on the validation pairs; keep the weights where they are the best so far."""
        network = self.average.module
        network.eval()
        figures = self._task.look(network)
        if figures["validation"] < self.progress.best:
            self.progress.best = figures["validation"]
            self._files.keep(network)
        now = {"step": self.progress.step, "cpu_s": round(self.progress.cpu_s, 1)}
        now |= {name: float(f"{value:.6g}") for name, value in figures.items()}
        self.progress.curve.append(now)
        self._files.draw(self.progress.curve)

    def _rate(self, step: int) -> float:
        part = step / self.recipe.steps
        last = self.recipe.last_rate
        fall = last + (1.0 - last) * 0.5 * (1.0 + math.cos(math.pi * min(part, 1.0)))
        return min(part / self.recipe.warm, 1.0) * fall

    def _save(self) -> None:
        self._files.save(
            {
                "progress": asdict(self.progress),
                "network": self._task.network.state_dict(),
                "average": self.average.state_dict(),
                "optimiser": self._optimiser.state_dict(),
                "schedule": self._schedule.state_dict(),
            }
        )

    def _load(self) -> None:
        state = self._files.load()
        self.progress = Progress(**state["progress"])
        self._task.network.load_state_dict(state["network"])
        self.average.load_state_dict(state["average"])
        self._optimiser.load_state_dict(state["optimiser"])
        self._schedule.load_state_dict(state["schedule"])
        self._task.renew(self.progress.step // self.recipe.fresh_every)
