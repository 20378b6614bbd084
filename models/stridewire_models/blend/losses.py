"""Losses, and how a batch of pairs becomes tensors."""

import numpy as np
import torch
from torch import Tensor

from stridewire.motion.array_types import Flags
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.correction import curve, gate, linear
from stridewire_engine.networks.blend.features import JOINTS
from stridewire_engine.networks.blend.pairs import Pairs
from stridewire_engine.networks.blend.postures import Postures
from stridewire_models.blend.capsules import penetration
from stridewire_models.blend.networks import Correction, Paper
from stridewire_models.blend.rotations import forward, from_scaled_axis, multiply

_TURN_WEIGHT = 4.0
"""Hands, toes and the head move no other joint: only this holds their turns."""
_POSITION_WEIGHT = 10.0
_END_WEIGHT = 3.0
_COLLISION_WEIGHT = 20.0
_ENDS = ("LeftFoot", "LeftToe", "RightFoot", "RightToe", "LeftHand", "RightHand")
_END_JOINTS = [REFERENCE.index(name) for name in _ENDS]


def correction_loss(network: Correction, pairs: Pairs, hidden_time: Flags) -> Tensor:
    """Return the loss of a batch: rotations and places of joints, L1, and self-collisions.

    Args:
        network: Being trained.
        pairs: `(N, W)`.
        hidden_time: `(N,)` true where the duration is not told.
    """
    duration = np.where(hidden_time, np.float32(0.0), pairs.duration)
    x = torch.from_numpy(features.inputs(pairs.start, pairs.end, duration))
    coefficients, _ = network(x)
    shares = np.repeat(pairs.weights[..., None], JOINTS, axis=-1)
    between = linear(pairs.start[:, None], pairs.end[:, None], shares)
    basis = torch.from_numpy(curve(pairs.weights).astype(np.float32))
    raw = torch.einsum("nwk,nkc->nwc", basis, coefficients)
    door = torch.from_numpy(gate(pairs.weights))[..., None]
    bounded = door * network.bounds * torch.tanh(raw / network.bounds)
    hips = torch.from_numpy(between.hips) + bounded[..., :3]
    turns = from_scaled_axis(bounded[..., 3:].reshape(*bounded.shape[:-1], JOINTS, 3))
    rotations = multiply(torch.from_numpy(between.rotations), turns)
    return _distance(hips, rotations, pairs.truth)


def paper_loss(network: Paper, pairs: Pairs) -> Tensor:
    """Return the mean squared error in standard deviations of each number."""
    flat = flatten(pairs)
    x = features.paper_inputs(flat.start, flat.end, flat.weights[:, 0])
    written, _ = network(torch.from_numpy(x))
    truth = torch.from_numpy(features.write_postures(flat.truth[:, 0]).astype(np.float32))
    return torch.mean(((written - truth) / network.scale) ** 2)


def flatten(pairs: Pairs) -> Pairs:
    """Return N W pairs with one posture between each."""
    count = pairs.weights.shape[1]
    of = np.arange(len(pairs.duration)).repeat(count)
    flat = pairs.truth.rotations.reshape(-1, 1, JOINTS, 4)
    return Pairs(
        pairs.start[of],
        pairs.end[of],
        pairs.duration[of],
        pairs.weights.reshape(-1, 1),
        Postures(pairs.truth.hips.reshape(-1, 1, 3), flat),
        pairs.rows.reshape(-1, 1),
        pairs.clip[of],
    )


def _distance(hips: Tensor, rotations: Tensor, truth: Postures) -> Tensor:
    true_rotations = torch.from_numpy(truth.rotations)
    # q and -q turn alike
    sign = torch.sign(torch.sum(rotations.detach() * true_rotations, dim=-1, keepdim=True))
    turned = torch.mean(torch.abs(rotations - sign * true_rotations))
    joints, turns = forward(REFERENCE, hips, rotations)
    with torch.no_grad():
        true_joints, true_turns = forward(REFERENCE, torch.from_numpy(truth.hips), true_rotations)
    away = torch.abs(joints - true_joints)
    # one posture in two is enough of what is rare
    half = joints.shape[1] // 2
    deeper = torch.relu(
        penetration(joints[:, :half], turns[:, :half])
        - penetration(true_joints[:, :half], true_turns[:, :half])
    )
    return (
        _TURN_WEIGHT * turned
        + _POSITION_WEIGHT
        * (torch.mean(away) + _END_WEIGHT * torch.mean(away[..., _END_JOINTS, :]))
        + _COLLISION_WEIGHT * torch.mean(deeper.sum(dim=-1))
    )
