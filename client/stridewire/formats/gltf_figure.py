"""The body of a written glTF: a capsule for each bone and a ball for the head, bound to joints.

Metres. A vertex follows one joint: round ends meet at the joints, so that nothing gapes.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stridewire.drawing.body_shape import BREADTH, HEAD, TRUNK, limb_radii, trunk_joints
from stridewire.drawing.palette import side_colour
from stridewire.formats.units import longest_chain
from stridewire.motion.array_types import Floats, Indices, Vectors
from stridewire.motion.sides import head_joint, joint_sides
from stridewire.motion.skeleton import Skeleton

_AROUND = 12
"""Vertices around a capsule."""
_ALONG = 4
"""Rings of each of its round ends."""


@dataclass(frozen=True)
class Surface:
    """Triangles of one colour."""

    colour: str
    """As `#rrggbb`."""
    positions: npt.NDArray[np.float32]
    """`(V, 3)` where all local rotations are zero; metres."""
    normals: npt.NDArray[np.float32]
    """`(V, 3)` unit."""
    joints: npt.NDArray[np.uint16]
    """`(V,)` the joint that each vertex follows."""
    triangles: npt.NDArray[np.uint32]
    """`(F, 3)` vertices, counter-clockwise from outside."""


@dataclass(frozen=True)
class _Capsule:
    joint: int
    side: int
    start: Vectors
    end: Vectors
    radii: tuple[float, float]
    """At its start and end."""
    broader: Vectors | None = None
    """`(3,)` unit: the direction in which it is stretched; None where it is round."""


def figure(skeleton: Skeleton, rest: Vectors, tips: Mapping[int, Vectors]) -> list[Surface]:
    """Return a body for a skeleton, a surface for each side: left, middle, right.

    Args:
        skeleton: Offsets in metres.
        rest: `(J, 3)` joints where all local rotations are zero, metres.
        tips: Offsets of end sites by the index of their joint, metres.
    """
    capsules = [*_bones(skeleton, rest, tips), *_head(skeleton, rest, tips)]
    by_side = {side: [c for c in capsules if c.side == side] for side in (1, 0, -1)}
    return [_surface(side_colour(side), part) for side, part in by_side.items() if part]


def _bones(skeleton: Skeleton, rest: Vectors, tips: Mapping[int, Vectors]) -> list[_Capsule]:
    """Return a capsule for each bone, of the side of its lower joint."""
    size, sides = longest_chain(skeleton), joint_sides(skeleton.names)
    trunk, head = trunk_joints(skeleton.parents, sides), head_joint(skeleton.names)
    bones = np.linalg.norm(skeleton.offsets, axis=-1)
    radii = limb_radii(skeleton.parents, bones, trunk, size).tolist()
    across = _across(rest, sides)
    capsules = []
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        side, start, end = int(sides[joint]), rest[parent], rest[joint]
        if parent in trunk and side == 0:
            reach = end if joint in trunk else 0.5 * (start + end)
            thick = (TRUNK * size, TRUNK * size)
            capsules.append(_Capsule(parent, side, start, reach, thick, across))
        if joint not in trunk:
            ends = (radii[joint if parent in trunk else parent], radii[joint])
            capsules.append(_Capsule(parent, side, start, end, ends))
    for joint, tip in tips.items():
        if joint != head:
            thin = (radii[joint], radii[joint])
            capsules.append(
                _Capsule(joint, int(sides[joint]), rest[joint], rest[joint] + tip, thin)
            )
    return [c for c in capsules if np.linalg.norm(c.end - c.start) > 1e-4 * size]


def _across(rest: Vectors, sides: Indices) -> Vectors | None:
    """Return the direction from the right to the left; None without sides."""
    if not np.any(sides):
        return None
    way = rest[sides > 0].mean(axis=0) - rest[sides < 0].mean(axis=0)
    return np.asarray(way / max(float(np.linalg.norm(way)), 1e-9))


def _head(skeleton: Skeleton, rest: Vectors, tips: Mapping[int, Vectors]) -> list[_Capsule]:
    """Return a ball that goes on where the neck, or the head's end site, points."""
    joint = head_joint(skeleton.names)
    if joint is None:
        return []
    way = tips.get(joint, skeleton.offsets[joint])
    way = way / max(float(np.linalg.norm(way)), 1e-9)
    radius = HEAD * longest_chain(skeleton)
    low, high = rest[joint] + 0.6 * radius * way, rest[joint] + 0.95 * radius * way
    return [_Capsule(joint, 0, low, high, (radius, radius))]


def _surface(colour: str, capsules: list[_Capsule]) -> Surface:
    unit, triangles = _unit_capsule()
    count = len(unit)
    positions, normals = zip(*(_shaped(unit, capsule) for capsule in capsules), strict=True)
    return Surface(
        colour,
        np.concatenate(positions).astype(np.float32),
        np.concatenate(normals).astype(np.float32),
        np.repeat(np.array([c.joint for c in capsules], np.uint16), count),
        np.concatenate([triangles + i * count for i in range(len(capsules))]).astype(np.uint32),
    )


def _shaped(unit: Floats, capsule: _Capsule) -> tuple[Vectors, Vectors]:
    """Return vertices and normals `(V, 3)` of a capsule."""
    along = capsule.end - capsule.start
    axis = along / np.linalg.norm(along)
    least = np.eye(3)[np.argmin(np.abs(axis))]
    first = np.cross(axis, least)
    first /= np.linalg.norm(first)
    normals = unit[:, :3] @ np.stack([first, axis, np.cross(first, axis)])
    radii = np.interp(unit[:, 3], [0.0, 1.0], capsule.radii)
    around = radii[:, None] * normals
    if capsule.broader is not None:
        sideways = (normals @ capsule.broader)[:, None] * capsule.broader
        around = around + (BREADTH - 1.0) * radii[:, None] * sideways
        normals = normals - (1.0 - 1.0 / BREADTH) * sideways
        normals = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return capsule.start + around + unit[:, 3:] * along, normals


def _unit_capsule() -> tuple[Floats, Indices]:
    """Return `(V, 4)` normals, +Y along the capsule, with 0 at its start and 1 at its end.

    And `(F, 3)` triangles.
    """
    tilt = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * _ALONG + 1)
    tilt = np.concatenate([tilt[: _ALONG + 1], tilt[_ALONG:]])
    at_end = np.repeat([0.0, 1.0], _ALONG + 1)
    turn = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
    rings = np.empty((len(tilt), _AROUND, 4))
    rings[..., 0] = np.cos(tilt)[:, None] * np.cos(turn)
    rings[..., 1] = np.sin(tilt)[:, None]
    rings[..., 2] = np.cos(tilt)[:, None] * np.sin(turn)
    rings[..., 3] = at_end[:, None]
    ring, around = np.meshgrid(np.arange(len(tilt) - 1), np.arange(_AROUND), indexing="ij")
    a = ring * _AROUND + around
    b = ring * _AROUND + (around + 1) % _AROUND
    lower = np.stack([a, a + _AROUND, b], axis=-1)[1:]  # the first ring is one point
    upper = np.stack([b, a + _AROUND, b + _AROUND], axis=-1)[:-1]
    triangles = np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])
    return rings.reshape(-1, 4), triangles
