"""The paper's four losses (Kim et al. 2023, section 5.1), in numbers that are standardised.

Read otherwise than printed: the lower body is also compared where rotations lead it, and contacts
are by cross entropy.
"""

import math

import torch
from torch import Tensor
from torch.nn.functional import binary_cross_entropy_with_logits, normalize

from stridewire_engine.networks.rmr.paper_poses import (
    CONTACTS,
    POINTS,
    POINTS_COUNT,
    ROOT,
    ROTATIONS,
)
from stridewire_engine.networks.rmr.takes import LOWER
from stridewire_models.rmr.paper_networks import PaperNetwork

_POSE, _FOOT, _BEGIN = 1.0, 0.5, 1.0


def paper_loss(
    network: PaperNetwork, x: Tensor, truth: Tensor, begin: int, trajectory: float
) -> dict[str, Tensor]:
    """Return the parts of the loss; their sum is minimised.

    Args:
        network: In training.
        x: `(N, T, 191)` read.
        truth: `(N, T, 191)`.
        begin: T_begin, frames that are to stay as read, the first the most.
        trajectory: Weight of the root's path.
    """
    made = network(x)
    away = (made - truth) / network.deviation
    kept = (made - x)[:, :begin] / network.deviation
    share = torch.tensor([1.0 - _sigmoid(10.0 * (t + 1) / begin - 5.0) for t in range(begin)])
    heard = binary_cross_entropy_with_logits(
        made[..., CONTACTS], truth[..., CONTACTS], reduction="none"
    )
    led = lower_body(made[..., POINTS][..., :3], made[..., ROTATIONS]).flatten(-2)
    bent = (led - truth[..., POINTS]) / network.deviation[POINTS]
    return {
        "pose": _POSE * (torch.mean(_pose(away)) + torch.mean(torch.abs(bent).sum(-1))),
        "trajectory": trajectory * torch.mean(_apart(made, truth)),
        "foot": _FOOT * torch.mean(heard.sum(-1)),
        "begin": _BEGIN * torch.mean(_pose(kept) * share),
    }


def root_path(motion: Tensor) -> Tensor:
    """Return `(N, T, 3)`: x, z and yaw that root motion `(N, T, 3)` leads to."""
    yaw = torch.cumsum(motion[..., 2], dim=1)
    before = yaw - motion[..., 2]
    sine, cosine = torch.sin(before), torch.cos(before)
    x = motion[..., 0] * cosine + motion[..., 1] * sine
    z = motion[..., 1] * cosine - motion[..., 0] * sine
    return torch.stack([torch.cumsum(x, 1), torch.cumsum(z, 1), yaw], dim=-1)


def lower_body(hips: Tensor, six: Tensor) -> Tensor:
    """Return joints `(N, T, 9, 3)` of hips `(N, T, 3)` and two axes of all local rotations."""
    axes = six.unflatten(-1, (-1, 6))[..., :POINTS_COUNT, :]
    forward = normalize(axes[..., :3], dim=-1)
    across = normalize(torch.linalg.cross(axes[..., 3:], forward), dim=-1)
    up = torch.linalg.cross(forward, across)
    local = torch.stack([across, up, forward], dim=-1)
    offsets = torch.tensor(LOWER.offsets, dtype=six.dtype)
    turned, points = [local[..., 0, :, :]], [hips]
    for joint in range(1, POINTS_COUNT):
        parent = int(LOWER.parents[joint])
        points.append(points[parent] + turned[parent] @ offsets[joint])
        turned.append(turned[parent] @ local[..., joint, :, :])
    return torch.stack(points, dim=-2)


def _pose(away: Tensor) -> Tensor:
    """Return the distance `(N, T)` of poses without contacts, over all numbers (L1)."""
    return torch.abs(away[..., : CONTACTS.start]).sum(-1)


def _apart(made: Tensor, truth: Tensor) -> Tensor:
    """Return how far roots are apart `(N, T)`, metres and radians together."""
    ours, theirs = root_path(made[..., ROOT]), root_path(truth[..., ROOT])
    return torch.abs(ours - theirs).sum(-1)


def _sigmoid(x: float) -> float:
    return 1.0 / (1.0 + math.exp(-x))
