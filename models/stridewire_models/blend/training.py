"""Training: steps, looks at the validation data, checkpoints that a later run goes on from."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.correction import linear
from stridewire_engine.networks.blend.features import JOINTS
from stridewire_engine.networks.blend.pairs import Frames, Pairs
from stridewire_models.blend.losses import correction_loss, paper_loss
from stridewire_models.blend.networks import Correction, Paper, new_network
from stridewire_models.blend.recipes import Phase, Recipe
from stridewire_models.blend.rig_variation import vary_rigs
from stridewire_models.run_folder import RunFolder, running_mean

_SAVE_EVERY_S = 300.0
_EXAMPLES = 20_000
_VALIDATION_PAIRS = 4_000
_HIDE_TIME = 0.5


@dataclass
class Progress:
    """Where a run is; all of it is in the checkpoint."""

    step: int = 0
    phase: int = 0
    step_in_phase: int = 0
    best: float = float("inf")
    since_best: int = 0
    cpu_s: float = 0.0
    """Seconds that the thread has worked."""
    curve: list[dict[str, float]] = field(default_factory=list)


class Run:
    """One training run in a folder; made again, it goes on where its checkpoint is."""

    def __init__(
        self, folder: Path, recipe: Recipe, train: Frames, validation: Frames, seed: int
    ) -> None:
        torch.manual_seed(seed)
        self.folder = folder
        self._files = RunFolder(folder)
        self.recipe = recipe
        self.progress = Progress()
        self.network = new_network(recipe.variant)
        self._train = train
        self._rng = np.random.default_rng(seed)
        self._fit()
        self.average = running_mean(self.network, recipe.averaging)
        self._validation = validation.draw(np.random.default_rng(0), _VALIDATION_PAIRS, 2)
        self._begin_phase()
        if self._files.is_begun:
            self._load()
        else:
            self._files.begin({"seed": seed, **asdict(recipe)})

    @property
    def judged(self) -> Correction | Paper:
        """The weights that are judged and kept."""
        if not self.recipe.averaging:
            return self.network
        averaged = self.average.module
        assert isinstance(averaged, Correction | Paper)
        return averaged

    def train(self, advance: Callable[[int], None], look_every: int) -> None:
        """Train to the end.

        Args:
            advance: Told of the steps of the whole that are done, one by one or skipped together.
            look_every: Steps from one look at the validation data to the next.
        """
        advance(self.progress.step)
        began, saved = time.process_time() - self.progress.cpu_s, time.monotonic()
        while self.progress.phase < len(self.recipe.phases):
            self._step()
            self.progress.cpu_s = time.process_time() - began
            phase = self.recipe.phases[self.progress.phase]
            every = max(1, min(look_every, phase.steps // 10))
            if self.progress.step_in_phase % every == 0:
                self._look()
            advance(1)
            over = self.progress.step_in_phase >= phase.steps
            if over or self.progress.since_best >= phase.patience:
                advance(phase.steps - self.progress.step_in_phase)
                self._end_phase()
            if time.monotonic() - saved > _SAVE_EVERY_S:
                self._save()
                saved = time.monotonic()
        self._save()
        self._files.end()

    def _step(self) -> None:
        phase = self.recipe.phases[self.progress.phase]
        pairs = self._draw(self._rng, phase.batch, phase.between)
        loss = self._loss(self.network, pairs)
        self._optimiser.zero_grad(set_to_none=True)
        loss.backward()  # type: ignore[no-untyped-call]
        if self.recipe.variant == "correction":
            torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self._optimiser.step()
        self._schedule.step()
        self.average.update_parameters(self.network)
        self.progress.step += 1
        self.progress.step_in_phase += 1

    def _draw(self, rng: np.random.Generator, count: int, between: int) -> Pairs:
        pairs = self._train.draw(rng, count, between)
        return vary_rigs(pairs, rng) if self.recipe.vary_rigs else pairs

    def _loss(self, network: Correction | Paper, pairs: Pairs) -> Tensor:
        if isinstance(network, Paper):
            return paper_loss(network, pairs)
        hide = self._rng.random(len(pairs.duration)) < _HIDE_TIME
        return correction_loss(network, pairs, hide)

    @torch.no_grad()
    def _look(self) -> None:
        """Judge on the validation data; keep the weights where they are the best so far."""
        network = self.judged
        if isinstance(network, Paper):
            loss = float(paper_loss(network, self._validation))
        else:
            told = np.zeros(len(self._validation.duration), bool)
            loss = float(correction_loss(network, self._validation, told))
        self.progress.since_best += 1
        if loss < self.progress.best:
            self.progress.best, self.progress.since_best = loss, 0
            self._files.keep(network)
        now = {"step": self.progress.step, "validation": loss, "cpu_s": self.progress.cpu_s}
        self.progress.curve.append(now)
        self._files.draw(self.progress.curve)

    def _begin_phase(self) -> None:
        phase = self.recipe.phases[self.progress.phase]
        decay = self.recipe.weight_decay
        self._optimiser = torch.optim.AdamW(
            self.network.parameters(), lr=phase.learning_rate, weight_decay=decay, fused=True
        )
        self._schedule = _schedule(self._optimiser, phase)

    def _end_phase(self) -> None:
        self.progress.phase += 1
        self.progress.step_in_phase = self.progress.since_best = 0
        if self.progress.phase < len(self.recipe.phases):
            # the next one fine-tunes the best so far
            self.network.load_state_dict(self._files.best())
            self._begin_phase()

    def _save(self) -> None:
        self._files.save(
            {
                "progress": asdict(self.progress),
                "network": self.network.state_dict(),
                "average": self.average.state_dict(),
                "optimiser": self._optimiser.state_dict(),
                "schedule": self._schedule.state_dict(),
                "rng": self._rng.bit_generator.state,
            }
        )

    def _load(self) -> None:
        state = self._files.load()
        self.progress = Progress(**state["progress"])
        self.network.load_state_dict(state["network"])
        self.average.load_state_dict(state["average"])
        self._rng.bit_generator.state = state["rng"]
        if self.progress.phase < len(self.recipe.phases):
            self._begin_phase()
            self._optimiser.load_state_dict(state["optimiser"])
            self._schedule.load_state_dict(state["schedule"])

    def _fit(self) -> None:
        """Take statistics of the training data into the network."""
        pairs = self._draw(np.random.default_rng(0), _EXAMPLES, 1)
        if isinstance(self.network, Paper):
            x = features.paper_inputs(pairs.start, pairs.end, pairs.weights[:, 0])
            self.network.aim(features.write_postures(pairs.truth[:, 0]))
        else:
            told = np.random.default_rng(1).random(len(pairs)) >= _HIDE_TIME
            x = features.inputs(pairs.start, pairs.end, pairs.duration * told)
            self.network.bound(*_corrections(pairs, self.network.size(torch.from_numpy(x)).numpy()))
        self.network.fit(x)


def _corrections(pairs: Pairs, size: Floats) -> tuple[Floats, Floats]:
    """Return the corrections that the truth needs, `(CHANNELS,)`: the largest, and the usual ones.

    Args:
        pairs: `(N, 1)`.
        size: `(N, 1)` that a correction is apt to have; the usual one is that of size 1.
    """
    shares = np.repeat(pairs.weights[..., None], JOINTS, axis=-1)
    between = linear(pairs.start[:, None], pairs.end[:, None], shares)
    turn = quaternion.multiply(quaternion.conjugate(between.rotations), pairs.truth.rotations)
    turns = quaternion.to_scaled_axis(turn)
    moved = pairs.truth.hips - between.hips
    both = np.concatenate([moved, turns.reshape(*turns.shape[:-2], -1)], axis=-1)[:, 0]
    bounds = np.percentile(np.abs(both), 99.9, axis=0) * 1.25
    return np.maximum(bounds, 1e-3), np.maximum(both.std(0) / np.sqrt(np.mean(size**2)), 1e-4)


def _schedule(
    optimiser: torch.optim.Optimizer, phase: Phase
) -> torch.optim.lr_scheduler.LRScheduler:
    if not phase.warm:
        return torch.optim.lr_scheduler.ConstantLR(optimiser, factor=1.0)
    # it needs two steps to rise
    warm = min(max(phase.warm, 2.0 / phase.steps), 1.0)
    return torch.optim.lr_scheduler.OneCycleLR(
        optimiser, phase.learning_rate, phase.steps, pct_start=warm, final_div_factor=4.0
    )
