"""Root drift: how far the paper's network leaves its path (Kim et al. 2023, figure 9)."""

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation.paper_windows import sprung
from stridewire_engine.evaluation.seams import Windows
from stridewire_engine.networks.rmr.pairs import Pairs
from stridewire_engine.networks.rmr.paper_poses import ROOT, clips_path, root_path
from stridewire_engine.networks.rmr.plans import WINDOW
from stridewire_engine.networks.rmr.takes import Takes

_STRIDE = 10


def long_motions(takes: Takes, frames: int, count: int, seed: int) -> Floats:
    """Return motions `(count, frames, 191)` of seconds of takes, laid end to end, with springs.

    Args:
        takes: In which bodies walk and run.
        frames: A multiple of a window's.
        count: Motions.
        seed: Of the choice.
    """
    rng = np.random.default_rng(seed)
    first = rng.choice(takes.windows(_STRIDE), (count, frames // WINDOW))
    rows = (first[..., None] + np.arange(WINDOW)).reshape(count, -1)
    starts = np.broadcast_to(np.arange(frames) % WINDOW == 0, rows.shape).copy()
    starts[:, 0] = False
    pairs = Pairs(rows, rows, starts, np.zeros(rows.shape))
    return sprung(Windows(takes, pairs, *clips_path(takes, pairs)))


def root_distance(made: Floats, given: Floats) -> Floats:
    """Return how far roots `(N, T)` of motions `(N, T, 191)` are from those given, metres."""
    ours, theirs = (
        root_path(numbers[..., ROOT].astype(np.float64))[0] for numbers in (made, given)
    )
    return np.asarray(np.linalg.norm(ours - theirs, axis=-1))
