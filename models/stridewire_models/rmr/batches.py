"""Batches: assembled pairs as tensors in the plans' frames."""

from dataclasses import dataclass, fields

import numpy as np
import torch
from torch import Tensor

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire_engine.networks.rmr import features
from stridewire_engine.networks.rmr.assembly import Assembled
from stridewire_engine.networks.rmr.features import PlanFrame
from stridewire_engine.networks.rmr.plans import FRAME_RATE

_HEIGHT_HALFLIFE = 0.05
_HEIGHT_RATE = 2.0 * float(np.log(2.0)) / _HEIGHT_HALFLIFE


@dataclass(frozen=True)
class Batch:
    """N plans of T frames."""

    x: Tensor
    """`(N, T, D)` features."""
    head: Tensor
    """`(N, T, 2, 3)` toes with springs; before the first seam as they were shown."""
    clip: Tensor
    """`(N, T, 2, 3)` toes of the clips; their heights with springs."""
    before: Tensor
    """`(N, T, 2, 3)` the same a frame earlier, across no seam."""
    feet: Tensor
    """`(N, T, 2, 4)` rotations with springs."""
    hips: Tensor
    """`(N, T, 2, 3)` hip joints with springs."""
    labels: Tensor
    """`(N, T, 2)` whether the clips have toes planted."""
    since: Tensor
    """`(N, T)` frames since the first seam."""
    begins: Tensor
    """`(N, T)` whether a clip begins."""
    true_toes: Tensor
    """`(N, T, 2, 3)`."""
    true_feet: Tensor
    """`(N, T, 2, 4)`."""
    true_labels: Tensor
    """`(N, T, 2)`."""
    pull: Tensor
    """`(N, T)` how much it matters to be where the truth is."""

    def __len__(self) -> int:
        return len(self.x)

    def __getitem__(self, index: Tensor | slice) -> "Batch":
        """Take some of the plans."""
        return Batch(*(getattr(self, field.name)[index] for field in fields(self)))


def batch_of(made: Assembled, begins: Flags, true_labels: Flags, pull: Floats) -> Batch:
    """Return tensors of assembled pairs."""
    plans = made.plans
    frame = PlanFrame.of(plans)
    clip, before = frame.enter(made.clip.toes), frame.enter(made.before)
    head = frame.enter(made.sprung.toes)
    height = _sprung_height(head[..., 1], clip[..., 1], before[..., 1], begins)
    clip = clip.copy()
    clip[..., 1] = height
    return Batch(
        torch.from_numpy(features.inputs(plans)),
        _tensor(head),
        _tensor(clip),
        _tensor(before),
        _tensor(_entered(made.sprung.feet, frame)),
        _tensor(frame.enter(made.sprung.hip_joints)),
        _tensor(plans.contacts),
        torch.from_numpy(plans.since_first),
        torch.from_numpy(begins),
        _tensor(frame.enter(made.truth.toes)),
        _tensor(_entered(made.truth.feet, frame)),
        _tensor(true_labels),
        _tensor(pull),
    )


def _sprung_height(shown: Floats, clip: Floats, before: Floats, begins: Flags) -> Floats:
    """Return heights of toes `(N, T, 2)` whose offsets at seams decay."""
    out = np.where(np.cumsum(begins, axis=1)[..., None] > 0, clip, shown)
    for at in np.unique(np.nonzero(begins)[1]):
        which = np.flatnonzero(begins[:, at])
        gap = out[which, at - 1] - before[which, at]
        rate = (out[which, at - 1] - out[which, at - 2]) - (clip[which, at] - before[which, at])
        time = ((np.arange(out.shape[1] - at) + 1) / FRAME_RATE)[:, None]
        e = np.exp(-_HEIGHT_RATE * time)
        gap, rate = gap[:, None], FRAME_RATE * rate[:, None]
        out[which, at:] = clip[which, at:] + e * (gap + (rate + gap * _HEIGHT_RATE) * time)
    return out


def _entered(turns: Quaternions, frame: PlanFrame) -> Vectors:
    back = quaternion.from_yaw(-frame.yaw)[:, None, None]
    return quaternion.multiply(np.broadcast_to(back, turns.shape), turns)


def _tensor(values: Floats | Flags) -> Tensor:
    return torch.from_numpy(values.astype(np.float32))
