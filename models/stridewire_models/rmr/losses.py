"""Losses: what toes and feet do under the network's guidance, against what the actor's did."""

from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor
from torch.nn.functional import binary_cross_entropy

from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.rmr.guidance import (
    LABEL_LOGIT,
    LOGIT_SCALE,
    OFFSET_SCALE,
    TURN_SCALE,
    basis,
    onset,
)
from stridewire_models.blend.rotations import from_scaled_axis, multiply, rotate
from stridewire_models.rmr.batches import Batch
from stridewire_models.rmr.footing import follow
from stridewire_models.rmr.networks import Steps

_POSITION, _VELOCITY, _ACCELERATION, _JERK = 1.0, 10.0, 20.0, 10.0
_ANKLE_VELOCITY, _ANKLE_ACCELERATION, _ANKLE_JERK = 5.0, 15.0, 10.0
_SLIDING, _TURN, _REACH, _CONTACT = 40.0, 1.0, 10.0, 0.1
_LEG_SHARE = 0.985
_LEG = float(np.linalg.norm(REFERENCE.offsets[2:4], axis=-1).sum())
_TOE_OFFSET = tuple(float(v) for v in REFERENCE.offsets[REFERENCE.index("LeftToe")])


class Guided(NamedTuple):
    """Feet as the network guides them, `(N, T, 2, …)`."""

    toes: Tensor
    feet: Tensor
    ankles: Tensor
    planted: Tensor


def guide(network: Steps, batch: Batch) -> Guided:
    """Return where feet go under the network's guidance."""
    curves, contacts, _ = network(batch.x)
    n, frames = batch.x.shape[:2]
    spline = torch.from_numpy(basis(frames).astype(np.float32))
    door = torch.from_numpy(onset(batch.since.numpy()).astype(np.float32))[..., None]
    smooth = (torch.einsum("tk,nkc->ntc", spline, curves) * door).reshape(n, frames, 4, 3)
    offset, turn = OFFSET_SCALE * smooth[:, :, :2], TURN_SCALE * smooth[:, :, 2:]
    logits = LOGIT_SCALE * contacts.reshape(n, frames, 2) + LABEL_LOGIT * (2.0 * batch.labels - 1.0)
    planted = torch.sigmoid(logits)
    planted = torch.where((batch.since < 0)[..., None], batch.labels, planted)
    target = batch.clip + offset
    earlier = torch.cat([offset[:, :1], offset[:, :-1]], dim=1)
    ground = follow(
        batch.head[..., [0, 2]],
        target[..., [0, 2]],
        (batch.before + earlier)[..., [0, 2]],
        planted,
        batch.since,
        batch.begins,
    )
    toes = torch.stack([ground[..., 0], target[..., 1], ground[..., 1]], dim=-1)
    feet = multiply(from_scaled_axis(turn), batch.feet)
    return Guided(toes, feet, toes - _foot(feet), planted)


def loss_of(network: Steps, batch: Batch) -> dict[str, Tensor]:
    """Return the parts of the loss; their sum is minimised."""
    guided = guide(network, batch)
    after = (batch.since >= 0).float()
    near = (after * batch.pull)[..., None, None]
    away = guided.toes - batch.true_toes
    speed = torch.diff(away, dim=1)
    second, third = torch.diff(speed, dim=1), torch.diff(speed, n=2, dim=1)
    down = batch.true_labels[:, 1:] * batch.true_labels[:, :-1] * after[:, 1:, None]
    ankle = guided.ankles - (batch.true_toes - _foot(batch.true_feet))
    turning = torch.diff(ankle, dim=1)
    slid = torch.diff(guided.toes[..., [0, 2]], dim=1)
    stretched = torch.linalg.vector_norm(batch.hips - guided.ankles, dim=-1)
    same = torch.sum(guided.feet * batch.true_feet, dim=-1) ** 2
    heard = binary_cross_entropy(
        guided.planted.clamp(1e-6, 1.0 - 1e-6), batch.true_labels, reduction="none"
    )
    return {
        "position": _POSITION * _mean(away, near),
        "velocity": _VELOCITY * _mean(speed, near[:, 1:]),
        "acceleration": _ACCELERATION * _mean(second, near[:, 2:]),
        "jerk": _JERK * _mean(third, near[:, 3:]),
        # knees jerk where ankles do
        "ankle": _ANKLE_VELOCITY * _mean(turning, near[:, 1:])
        + _ANKLE_ACCELERATION * _mean(torch.diff(turning, dim=1), near[:, 2:])
        + _ANKLE_JERK * _mean(torch.diff(turning, n=2, dim=1), near[:, 3:]),
        "sliding": _SLIDING * _mean(slid, down[..., None]),
        "turn": _TURN * _mean(1.0 - same, after[..., None]),
        "reach": _REACH * _mean(torch.relu(stretched - _LEG_SHARE * _LEG), after[..., None]),
        "contact": _CONTACT * _mean(heard, after[..., None]),
    }


def _foot(turns: Tensor) -> Tensor:
    """Return the way from ankle to toe of feet's rotations `(..., 4)`."""
    return rotate(turns, turns.new_tensor(_TOE_OFFSET).expand(*turns.shape[:-1], 3))


def _mean(values: Tensor, weight: Tensor) -> Tensor:
    weight = weight.expand_as(values)
    return torch.sum(torch.abs(values) * weight) / torch.clamp(weight.sum(), min=1.0)
