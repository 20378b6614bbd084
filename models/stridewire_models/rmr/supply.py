"""Supply: batches of pairs, made anew from the takes every so often."""

import numpy as np
import torch

from stridewire_engine.networks.rmr.assembly import assemble
from stridewire_engine.networks.rmr.live import LiveMaker, pull
from stridewire_engine.networks.rmr.pairs import PairMaker, Pairs
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.batches import Batch, batch_of

_TRAIN_STRIDE, _JUDGE_STRIDE = 5, 15
_AT_ONCE = 500


class Supply:
    """Training pairs of takes."""

    def __init__(self, takes: Takes, pool: int, live: float, furthest: int) -> None:
        """Find the windows.

        Args:
            takes: To make pairs of.
            pool: Plans at once.
            live: Share of them that are live plans.
            furthest: Rank of the furthest segment that is set into pairs.
        """
        self._maker = PairMaker(takes)
        self._live = LiveMaker(takes) if live else None
        self._live_share = live
        self._furthest = furthest
        self._windows = takes.windows(_TRAIN_STRIDE)
        self._pool = pool

    def fresh(self, rng: np.random.Generator) -> Batch:
        """Make a pool of pairs."""
        count = round(self._pool * (1.0 - self._live_share))
        first = rng.choice(self._windows, count, replace=len(self._windows) < count)
        pairs = tensors(self._maker.takes, self._maker.make(first, rng, furthest=self._furthest))
        if self._live is None:
            return pairs
        return join([pairs, live_tensors(self._live, self._pool - count, rng)])


def judged(takes: Takes, live: bool) -> Batch:
    """Return the same plans every time, no pair of a mirrored copy's window.

    Args:
        takes: To make plans of.
        live: Whether as many live plans are among them as pairs.
    """
    first = takes.windows(_JUDGE_STRIDE)
    first = first[takes.clip[first] < takes.originals]
    pairs = tensors(takes, PairMaker(takes).make(first, np.random.default_rng(0)))
    if not live:
        return pairs
    plans = live_tensors(LiveMaker(takes), len(pairs), np.random.default_rng(0))
    return join([pairs, plans])


def live_tensors(maker: LiveMaker, count: int, rng: np.random.Generator) -> Batch:
    """Return live plans as tensors."""
    parts = []
    for at in range(0, count, _AT_ONCE):
        made, starts = maker.make(min(_AT_ONCE, count - at), rng)
        aim = pull(made.plans.since_first)
        parts.append(batch_of(made, starts, made.plans.contacts, aim))
    return join(parts)


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
