"""Rotations and forward kinematics in torch, as in `stridewire.motion`: w, x, y, z."""

import torch
from torch import Tensor

from stridewire.motion.skeleton import Skeleton


def multiply(a: Tensor, b: Tensor) -> Tensor:
    """Return the Hamilton product `(..., 4)`: turn by `b`, then by `a`."""
    aw, ax, ay, az = a.unbind(-1)
    bw, bx, by, bz = b.unbind(-1)
    return torch.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        dim=-1,
    )


def rotate(q: Tensor, v: Tensor) -> Tensor:
    """Turn vectors `(..., 3)` by unit quaternions `(..., 4)`."""
    u = q[..., 1:]
    t: Tensor = 2.0 * _cross(u, v)
    return v + q[..., :1] * t + _cross(u, t)


def _cross(a: Tensor, b: Tensor) -> Tensor:
    ax, ay, az = a.unbind(-1)
    bx, by, bz = b.unbind(-1)
    return torch.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], dim=-1)


def from_scaled_axis(v: Tensor) -> Tensor:
    """Return the exponential of rotation vectors `(..., 3)` in radians."""
    # the shift keeps the root's slope finite at 0
    angle = torch.sqrt(torch.sum(v * v, dim=-1, keepdim=True) + 1e-12)
    half = 0.5 * angle
    return torch.cat([torch.cos(half), v * (torch.sin(half) / angle)], dim=-1)


def forward(skeleton: Skeleton, hips: Tensor, rotations: Tensor) -> tuple[Tensor, Tensor]:
    """Return positions `(..., J, 3)` and rotations `(..., J, 4)` of the joints in the hips' space.

    Args:
        skeleton: J joints.
        hips: `(..., 3)`.
        rotations: `(..., J, 4)` local.
    """
    offsets = torch.tensor(skeleton.offsets, dtype=rotations.dtype)
    positions, turned = [hips.unsqueeze(-2)], [rotations[..., :1, :]]
    order, above = [0], [0]
    for joints, parents in skeleton.levels:
        # parents are all of the level before
        at = [above.index(parent) for parent in parents]
        parent_turn = turned[-1][..., at, :]
        positions.append(positions[-1][..., at, :] + rotate(parent_turn, offsets[joints]))
        turned.append(multiply(parent_turn, rotations[..., joints, :]))
        above = joints.tolist()
        order += above
    back = [order.index(joint) for joint in range(len(skeleton))]
    return torch.cat(positions, dim=-2)[..., back, :], torch.cat(turned, dim=-2)[..., back, :]
