"""Supply: batches of pairs, made anew from the takes every so often."""

import numpy as np
import torch

from stridewire_engine.networks.rmr.assembly import assemble
from stridewire_engine.networks.rmr.pairs import PairMaker, Pairs
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.batches import Batch, batch_of

_TRAIN_STRIDE, _JUDGE_STRIDE = 5, 15
_AT_ONCE = 500


class Supply:
    """Training pairs of takes."""

    def __init__(self, takes: Takes, pool: int) -> None:
        """Find the windows.

        Args:
            takes: To make pairs of.
            pool: Pairs at once.
        """
        self._maker = PairMaker(takes)
        self._windows = takes.windows(_TRAIN_STRIDE)
        self._pool = pool

    def fresh(self, rng: np.random.Generator) -> Batch:
        """Make a pool of pairs."""
        first = rng.choice(self._windows, self._pool, replace=len(self._windows) < self._pool)
        return tensors(self._maker.takes, self._maker.make(first, rng))


def judged(takes: Takes) -> Batch:
    """Return the same pairs of takes every time, none of a mirrored copy's windows."""
    first = takes.windows(_JUDGE_STRIDE)
    first = first[takes.clip[first] < takes.originals]
    return tensors(takes, PairMaker(takes).make(first, np.random.default_rng(0)))


def tensors(takes: Takes, pairs: Pairs) -> Batch:
    """Return pairs as tensors."""
    parts = []
    for at in range(0, len(pairs), _AT_ONCE):
        some = pairs[at : at + _AT_ONCE]
        pull = np.ones(some.truth.shape)
        parts.append(batch_of(assemble(takes, some), some.starts, takes.contacts[some.truth], pull))
    return join(parts)


def join(parts: list[Batch]) -> Batch:
    """Return batches as one."""
    columns = zip(*(vars(part).values() for part in parts), strict=True)
    return Batch(*(torch.cat(column) for column in columns))
