"""Boxes: the body as 15 oriented boxes, and which of them run into each other.

The layout of Gaisbauer et al. 2019, section 4.2: three boxes a limb, two for the torso, one for the
head. Two boxes collide where they overlap by more than 5 mm along every separating axis.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.skeleton import HEAD_TOP, REFERENCE
from stridewire_engine.networks.blend.postures import Postures

DEPTH = 0.005
"""Boxes that overlap by less do not count; metres."""
_STATURE = 1.75
_LIMB_SHARE = 0.46
_AT_ONCE = 4096


@dataclass(frozen=True)
class Box:
    """A box on a joint: axes at rest and half sizes."""

    name: str
    segment: str
    joint: str
    """Whose rotation it has."""
    middle: Vectors
    """`(3,)` of its centre, from the joint at rest, metres."""
    axes: Vectors
    """`(3, 3)` rows: along, across, through; unit, at rest."""
    half: Vectors
    """`(3,)` half sizes along the axes, metres."""


def _box(
    name: str, segment: str, joint: str, along: Vectors, sizes: tuple[float, float], half: float
) -> Box:
    """Lay a box of half sizes in statures along a vector from a joint, about its middle."""
    length = np.linalg.norm(along)
    forward = along / length
    # arms lie along x at rest, palms down; all else has its width there
    across = np.array([0.0, 0.0, 1.0] if abs(forward[0]) > 0.9 else [1.0, 0.0, 0.0])
    axes = np.stack([forward, across, np.cross(forward, across)])
    return Box(
        name,
        segment,
        joint,
        0.5 * along,
        axes,
        np.array([half * length, sizes[0] * _STATURE, sizes[1] * _STATURE]),
    )


def _offset(joint: str) -> Vectors:
    return np.asarray(REFERENCE.offsets[REFERENCE.index(joint)])


def _boxes() -> tuple[Box, ...]:
    boxes = []
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        arm, leg = f"{side} arm", f"{side} leg"
        hand = np.array([sign * 0.1 * _STATURE, 0.0, 0.0])
        for name, segment, joint, along, sizes in (
            ("upper arm", arm, "Arm", _offset(f"{side}ForeArm"), (0.026, 0.026)),
            ("forearm", arm, "ForeArm", _offset(f"{side}Hand"), (0.022, 0.022)),
            ("hand", arm, "Hand", hand, (0.024, 0.012)),
            ("thigh", leg, "UpLeg", _offset(f"{side}Leg"), (0.042, 0.042)),
            ("shank", leg, "Leg", _offset(f"{side}Foot"), (0.030, 0.030)),
            ("foot", leg, "Foot", _offset(f"{side}Toe"), (0.026, 0.020)),
        ):
            boxes.append(
                _box(f"{side} {name}", segment, f"{side}{joint}", along, sizes, _LIMB_SHARE)
            )
    lower = _offset("Spine") + _offset("Spine1")
    upper = _offset("Spine2") + _offset("Neck")
    head = np.array([0.0, HEAD_TOP, 0.0])
    boxes.append(_box("lower torso", "torso", "Hips", lower, (0.085, 0.055), 0.5))
    boxes.append(_box("upper torso", "torso", "Spine1", upper, (0.090, 0.062), 0.5))
    boxes.append(_box("head", "head", "Head", head, (0.045, 0.055), 0.5))
    return tuple(boxes)


BOXES = _boxes()
_NEIGHBOURS = {
    frozenset(pair)
    for pair in (
        ("Left upper arm", "upper torso"), ("Right upper arm", "upper torso"),
        ("head", "upper torso"), ("Left thigh", "lower torso"), ("Right thigh", "lower torso"),
        ("Left thigh", "Right thigh"),
    )
}  # fmt: skip
# overlap in 1.5 % to 24 % of the captured training frames: boxes are thicker than bodies
_USUAL = {
    frozenset(pair)
    for side in ("Left", "Right")
    for pair in (
        (f"{side} forearm", "lower torso"), (f"{side} forearm", "upper torso"),
        (f"{side} upper arm", "lower torso"), (f"{side} hand", "lower torso"),
        (f"{side} hand", f"{side} thigh"), (f"{side} forearm", f"{side} thigh"),
        ("Left shank", "Right shank"),
    )
}  # fmt: skip


def admissible_pairs() -> Indices:
    """Return the pairs of boxes `(P, 2)` whose overlap is a collision.

    Left out are boxes of one segment, neighbours, and pairs that overlap in more than 1 % of the
    captured training frames.
    """
    return np.array(
        [
            (a, b)
            for a, b in combinations(range(len(BOXES)), 2)
            if BOXES[a].segment != BOXES[b].segment
            and frozenset((BOXES[a].name, BOXES[b].name)) not in _NEIGHBOURS | _USUAL
        ],
        np.intp,
    )


def collisions(postures: Postures) -> Flags:
    """Return which admissible pairs `(N, P)` of boxes collide in postures `(N,)`."""
    parts = [
        _collisions(postures[i : i + _AT_ONCE]) for i in range(0, len(postures.hips), _AT_ONCE)
    ]
    return np.concatenate(parts)


def _collisions(postures: Postures) -> Flags:
    centres, axes = _place(postures)
    half = np.stack([box.half for box in BOXES])
    pairs = admissible_pairs()
    radius = np.linalg.norm(half, axis=-1)
    away = np.linalg.norm(centres[:, pairs[:, 0]] - centres[:, pairs[:, 1]], axis=-1)
    near = away < radius[pairs[:, 0]] + radius[pairs[:, 1]] - DEPTH
    which, pair = np.nonzero(near)
    a, b = pairs[pair, 0], pairs[pair, 1]
    depth = overlap(
        centres[which, b] - centres[which, a], axes[which, a], axes[which, b], half[a], half[b]
    )
    near[which, pair] = depth > DEPTH
    return np.asarray(near)


def overlap(
    between: Vectors, axes_a: Vectors, axes_b: Vectors, half_a: Vectors, half_b: Vectors
) -> Floats:
    """Return by how much boxes overlap `(K,)` along the axis where they do least; metres.

    The separating axes of two boxes: three faces each and nine cross products of edges (Gottschalk,
    Lin and Manocha 1996). Below 0 they are apart.

    Args:
        between: `(K, 3)` from the centre of a to that of b.
        axes_a: `(K, 3, 3)` rows: unit axes.
        axes_b: `(K, 3, 3)`.
        half_a: `(K, 3)` half sizes.
        half_b: `(K, 3)`.
    """
    edges = np.cross(axes_a[:, :, None], axes_b[:, None, :]).reshape(-1, 9, 3)
    candidates = np.concatenate([axes_a, axes_b, edges], axis=1)
    length = np.linalg.norm(candidates, axis=-1)
    parallel = length < 1e-6
    candidates = candidates / np.where(parallel, 1.0, length)[..., None]
    reach = sum(
        np.einsum("kac,kbc->kab", candidates, axes).__abs__() @ half[..., None]
        for axes, half in ((axes_a, half_a), (axes_b, half_b))
    )[..., 0]
    gap = np.abs(np.einsum("kac,kc->ka", candidates, between))
    return np.asarray(np.min(np.where(parallel, np.inf, reach - gap), axis=1))


def _place(postures: Postures) -> tuple[Vectors, Vectors]:
    """Return centres `(N, 15, 3)` and axes `(N, 15, 3, 3)` of the boxes in the world."""
    positions, turned = kinematics.forward(REFERENCE, postures.hips, postures.rotations)
    joints = REFERENCE.indices([box.joint for box in BOXES])
    turn = turned[:, joints]
    middle = np.stack([box.middle for box in BOXES]).astype(turn.dtype)
    axes = np.stack([box.axes for box in BOXES]).astype(turn.dtype)
    centres = positions[:, joints] + quaternion.rotate(
        turn, np.broadcast_to(middle, (*turn.shape[:-1], 3))
    )
    return centres, quaternion.rotate(
        np.broadcast_to(turn[..., None, :], (*turn.shape[:-1], 3, 4)),
        np.broadcast_to(axes, (*turn.shape[:-1], 3, 3)),
    )
