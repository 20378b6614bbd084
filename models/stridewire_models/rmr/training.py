"""Training: steps, looks at the validation pairs, checkpoints that a later run goes on from."""

import json
import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import torch

from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.batches import Batch
from stridewire_models.rmr.losses import loss_of
from stridewire_models.rmr.networks import Steps
from stridewire_models.rmr.recipes import Recipe
from stridewire_models.rmr.supply import Supply, judged

CHECKPOINT, BEST, CURVE, CONFIGURATION = "checkpoint.pt", "best.pt", "curve.json", "run.json"
_SAVE_EVERY_S = 300.0
_WARM = 0.02
_LAST_RATE = 0.02


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

    def __init__(
        self, folder: Path, recipe: Recipe, train: Takes, validation: Takes, seed: int
    ) -> None:
        torch.manual_seed(seed)
        self.folder = folder
        self.recipe = recipe
        self.progress = Progress()
        self.network = Steps()
        self._seed = seed
        self._supply = Supply(train, recipe.pool, recipe.live, recipe.furthest)
        self._judged = judged(validation, recipe.live > 0.0)
        self._pool = self._fresh(0)
        self.network.fit(self._pool.x.numpy())
        self.average = torch.optim.swa_utils.AveragedModel(
            self.network,
            multi_avg_fn=torch.optim.swa_utils.get_ema_multi_avg_fn(recipe.averaging),  # type: ignore[no-untyped-call]
        )
        self._optimiser = torch.optim.AdamW(
            self.network.parameters(),
            lr=recipe.learning_rate,
            weight_decay=recipe.weight_decay,
            fused=True,
        )
        self._schedule = torch.optim.lr_scheduler.LambdaLR(self._optimiser, self._rate)
        folder.mkdir(parents=True, exist_ok=True)
        facts = {"seed": seed, **asdict(recipe)}
        (folder / CONFIGURATION).write_text(json.dumps(facts, indent=1) + "\n")
        if (folder / CHECKPOINT).is_file():
            self._load()

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

    def _step(self) -> None:
        step, every = self.progress.step, self.recipe.fresh_every
        if step and step % every == 0:
            self._pool = self._fresh(step // every)
        chosen = self._rng(step).integers(0, len(self._pool), self.recipe.batch)
        loss = sum(loss_of(self.network, self._pool[torch.from_numpy(chosen)]).values())
        assert isinstance(loss, torch.Tensor)
        self._optimiser.zero_grad(set_to_none=True)
        loss.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self._optimiser.step()
        self._schedule.step()
        self.average.update_parameters(self.network)
        self.progress.step += 1

    @torch.no_grad()
    def _look(self) -> None:
        """Judge on the validation pairs; keep the weights where they are the best so far."""
        network = self.average.module
        assert isinstance(network, Steps)
        parts = {name: float(value) for name, value in loss_of(network, self._judged).items()}
        loss = sum(parts.values())
        if loss < self.progress.best:
            self.progress.best = loss
            torch.save(network.state_dict(), self.folder / BEST)
        now = {"step": self.progress.step, "cpu_s": round(self.progress.cpu_s, 1)}
        now |= {name: round(value, 5) for name, value in {"validation": loss, **parts}.items()}
        self.progress.curve.append(now)
        (self.folder / CURVE).write_text(json.dumps(self.progress.curve) + "\n")

    def _fresh(self, number: int) -> Batch:
        return self._supply.fresh(np.random.default_rng((self._seed, 1, number)))

    def _rng(self, step: int) -> np.random.Generator:
        return np.random.default_rng((self._seed, 2, step))

    def _rate(self, step: int) -> float:
        part = step / self.recipe.steps
        fall = _LAST_RATE + (1.0 - _LAST_RATE) * 0.5 * (1.0 + math.cos(math.pi * min(part, 1.0)))
        return min(part / _WARM, 1.0) * fall if part < _WARM else fall

    def _save(self) -> None:
        state = {
            "progress": asdict(self.progress),
            "network": self.network.state_dict(),
            "average": self.average.state_dict(),
            "optimiser": self._optimiser.state_dict(),
            "schedule": self._schedule.state_dict(),
        }
        fresh = self.folder / f"{CHECKPOINT}.new"
        torch.save(state, fresh)
        fresh.replace(self.folder / CHECKPOINT)

    def _load(self) -> None:
        state: dict[str, Any] = torch.load(self.folder / CHECKPOINT, weights_only=False)
        self.progress = Progress(**state["progress"])
        self.network.load_state_dict(state["network"])
        self.average.load_state_dict(state["average"])
        self._optimiser.load_state_dict(state["optimiser"])
        self._schedule.load_state_dict(state["schedule"])
        self._pool = self._fresh(self.progress.step // self.recipe.fresh_every)
