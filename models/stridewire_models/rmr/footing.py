"""Footing in torch: the stance-aware stitcher's toes, so that losses reach what guides them.

The same sums as `stridewire_engine.stitchers.footing` and `stance`, without what legs cannot reach.
"""

import math

import torch
from torch import Tensor

from stridewire_engine.networks.rmr.plans import FRAME_RATE

_LN2 = math.log(2.0)
_DT = 1.0 / FRAME_RATE
_LANDING = 0.0125
_SHORTEST, _LONGEST = 0.06, 0.4
_STRONGEST = 50.0
_ONSET = 0.04
_BRAKE_FROM, _BRAKE, _BRAKE_HALFLIFE = 0.13, 0.1, 0.06
_AHEAD = (2, 4, 7, 11, 16)


def follow(
    head: Tensor, target: Tensor, before: Tensor, planted: Tensor, since: Tensor, begins: Tensor
) -> Tensor:
    """Return where toes go over the ground `(N, T, 2, 2)`; differentiable in target and planted.

    Args:
        head: `(N, T, 2, 2)` toes before the first seam.
        target: `(N, T, 2, 2)` where swings lead.
        before: `(N, T, 2, 2)` the same target a frame earlier, across no seam.
        planted: `(N, T, 2)` from 0 to 1.
        since: `(N, T)` frames since the first seam, negative before it.
        begins: `(N, T)` whether a clip begins.
    """
    settled = _settled(planted.detach())[..., None]
    speed = (target - before) / _DT
    pace = torch.linalg.vector_norm(speed.detach(), dim=-1, keepdim=True)
    quick = torch.clamp(_SHORTEST * (1.0 + 0.5 / torch.clamp(pace, min=1e-3)), max=_LONGEST)
    left = math.exp(-_LN2 * _DT / _LANDING)
    stop = (1.0 - left) * _LANDING / _LN2
    x, v = head[:, 0], (head[:, 1] - head[:, 0]) / _DT
    swing = torch.zeros_like(planted[:, 0])
    onset = 1.0 - 2.0 ** (-_DT / _ONSET)
    out = [x]
    for t in range(1, head.shape[1]):
        fresh = begins[:, t, None, None]
        gap = x - before[:, t]
        rate = v - torch.where(fresh, speed[:, t], speed[:, t - 1])
        share = planted[:, t, :, None]
        swing = torch.where(fresh[..., 0], torch.zeros_like(swing), swing)
        swing = swing + (1.0 - planted[:, t].detach() - swing) * onset
        far = torch.linalg.vector_norm(gap.detach(), dim=-1, keepdim=True)
        half = torch.maximum(quick[:, t], 2.0 * _LN2 * torch.sqrt(far / _STRONGEST))
        half = half / torch.clamp(swing, min=0.1)[..., None]
        half = half + settled[:, t] * (_BRAKE_HALFLIFE - half)
        y = 2.0 * _LN2 / half
        stays = settled[:, t] * gap
        offset = gap - stays
        j = rate + offset * y
        e = torch.exp(-y * _DT)
        swung = target[:, t] + stays + e * (offset + j * _DT)
        swung_v = speed[:, t] + e * (rate - j * y * _DT)
        moved = share * (x + v * stop) + (1.0 - share) * swung
        moved_v = share * (v * left) + (1.0 - share) * swung_v
        old = (since[:, t] < 0)[:, None, None]
        v = torch.where(old, (head[:, t] - head[:, t - 1]) / _DT, moved_v)
        x = torch.where(old, head[:, t], moved)
        out.append(x)
    return torch.stack(out, dim=1)


def _settled(planted: Tensor) -> Tensor:
    """Return to which share `(N, T, 2)` swings are over, since toes land soon."""
    down = planted > 0.5
    nearest = torch.full_like(planted, math.inf)
    frames = planted.shape[1]
    for ahead in reversed(_AHEAD):
        later = torch.zeros_like(down)
        later[:, : max(frames - ahead, 0)] = down[:, ahead:]
        nearest = torch.where(later, torch.full_like(planted, ahead * _DT), nearest)
    return torch.clamp((_BRAKE_FROM - nearest) / _BRAKE, 0.0, 1.0)
