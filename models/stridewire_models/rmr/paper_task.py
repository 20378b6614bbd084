"""What trains the paper's network: pairs alone, and how it is judged."""

from collections.abc import Mapping

import numpy as np
import torch
from torch import Tensor, nn

from stridewire.motion.array_types import Floats, Indices, Vectors
from stridewire_engine.evaluation.paper_windows import sprung, true
from stridewire_engine.evaluation.root_drift import root_distance
from stridewire_engine.evaluation.seams import Poses, Windows
from stridewire_engine.evaluation.stitch_figures import Judge, written
from stridewire_engine.networks.rmr.pairs import PairMaker, Pairs
from stridewire_engine.networks.rmr.paper_poses import clips_path, read
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.paper_losses import paper_loss
from stridewire_models.rmr.paper_networks import PaperNetwork
from stridewire_models.rmr.recipes import PaperRecipe

TRAIN_STRIDE, JUDGE_STRIDE = 5, 15
_AT_ONCE = 500
_OWN_PATH = 0.25
"""Share of pairs whose clips keep their own paths."""
_HEAD = 5
"""First frames whose distance from the input is told; no seam is among them."""


class PaperData:
    """Pairs of takes, as the network reads and writes them; one for many trainings."""

    def __init__(self, train: Takes, validation: Takes, seed: int = 0) -> None:
        """Find the windows; make the validation pairs, which no seed changes."""
        self._seed = seed
        self._maker = PairMaker(train)
        self._first = train.windows(TRAIN_STRIDE)
        self._pools: dict[tuple[int, int, int], tuple[Tensor, Tensor]] = {}
        self.judge = Judge(validation, JUDGE_STRIDE)
        self.x = np.concatenate([sprung(windows) for windows in self.judge.windows()])
        self.truth = np.concatenate([true(windows) for windows in self.judge.windows()])

    def pool(self, count: int, furthest: int, number: int) -> tuple[Tensor, Tensor]:
        """Return pairs to train on, `(N, T, 191)` read and true; the same for the same number."""
        key = count, furthest, number
        if key not in self._pools:
            rng = np.random.default_rng((self._seed, 1, number))
            first = rng.choice(self._first, count, replace=len(self._first) < count)
            self._pools[key] = self._made(first, rng, furthest)
        return self._pools[key]

    def _made(
        self, first: Indices, rng: np.random.Generator, furthest: int
    ) -> tuple[Tensor, Tensor]:
        takes = self._maker.takes
        pairs = self._maker.make(first, rng, furthest=furthest)
        read_, true_ = [], []
        for at in range(0, len(pairs), _AT_ONCE):
            some = pairs[at : at + _AT_ONCE]
            path = _path(takes, some, rng)
            windows = Windows(takes, some, *path)
            read_.append(torch.from_numpy(sprung(windows)))
            true_.append(torch.from_numpy(true(windows)))
        return torch.cat(read_), torch.cat(true_)

    def figures(self, made: Floats) -> Mapping[str, float]:
        """Return what is told of the validation pairs as a network writes them `(N, T, 191)`."""
        shown, own, before = (Poses(*read(part)) for part in (made, self.truth, self.x))
        away = (written(shown) - written(own)) ** 2
        moved = (written(shown) - written(before)) ** 2
        return {
            "mse": float(away.mean()),
            "npss": self._npss(shown),
            "mse_of_input": float(moved.mean()),
            "mse_of_input_head": float(moved[:, :_HEAD].mean()),
            "root_cm": float(100.0 * root_distance(made, self.x).mean()),
        }

    def _npss(self, shown: Poses) -> float:
        """Return the judge's NPSS of the pairs in their order."""
        ends = np.cumsum([len(windows) for windows in self.judge.windows()])[:-1]
        parts = zip(np.split(shown.hips, ends), np.split(shown.rotations, ends), strict=True)
        left = (Poses(*part) for part in parts)
        npss = self.judge.measure(lambda windows: next(left))["npss"]
        return float(npss.value(np.ones((1, npss.units)))[0])


def _path(takes: Takes, pairs: Pairs, rng: np.random.Generator) -> tuple[Vectors, Floats]:
    """Return the take's paths, and for some pairs the clips' own, as stitching aligns them."""
    root, yaw = takes.root_path(pairs.truth)
    own = rng.random(len(pairs)) < _OWN_PATH
    aligned, turned = clips_path(takes, pairs)
    return (
        np.where(own[:, None, None], aligned, root),
        np.where(own[:, None], turned, yaw),
    )


class PaperTask:
    """The network, its pairs, its loss."""

    def __init__(self, recipe: PaperRecipe, data: PaperData) -> None:
        """Take the first pairs; weights are of torch's generator."""
        self.network = PaperNetwork(recipe.cell, recipe.width)
        self._recipe = recipe
        self._data = data
        self.renew(0)
        self.network.fit(self._x.numpy(), self._truth.numpy())

    def renew(self, number: int) -> None:
        """Take the pairs of that number."""
        recipe = self._recipe
        self._x, self._truth = self._data.pool(recipe.pool, recipe.furthest, number)

    def loss(self, rng: np.random.Generator) -> Tensor:
        """Return the loss of a batch that is drawn."""
        chosen = torch.from_numpy(rng.integers(0, len(self._x), self._recipe.batch))
        # dropout is drawn anew, but the same where a run goes on
        torch.manual_seed(int(rng.integers(2**31)))
        parts = paper_loss(
            self.network,
            self._x[chosen],
            self._truth[chosen],
            self._recipe.begin,
            self._recipe.trajectory,
        )
        return torch.stack(list(parts.values())).sum()

    def look(self, network: nn.Module) -> Mapping[str, float]:
        """Return figures of the validation pairs; the one that counts is the MSE."""
        made = refine(network, self._data.x)
        figures = self._data.figures(made)
        return {"validation": figures["mse"], **figures}


@torch.no_grad()
def refine(network: nn.Module, numbers: Floats) -> Floats:
    """Return windows `(N, T, 191)` as a network writes them."""
    parts = [
        network(torch.from_numpy(numbers[at : at + _AT_ONCE])).numpy()
        for at in range(0, len(numbers), _AT_ONCE)
    ]
    return np.concatenate(parts)
