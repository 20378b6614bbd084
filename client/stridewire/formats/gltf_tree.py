"""Nodes of a glTF document: which of them are joints, who is below whom, how they stand at rest."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.formats.source_motion import FormatError
from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions, Vectors

_SCALAR_FIRST = [3, 0, 1, 2]
_UNEVEN = 1e-3
"""Scales whose axes differ by more are not one scale."""


@dataclass(frozen=True)
class Rest:
    """How a node stands relative to its parent when nothing moves."""

    translation: Vectors
    """`(3,)`."""
    rotation: Quaternions
    """`(4,)` w, x, y, z."""
    scale: float


@dataclass(frozen=True)
class Tree:
    """The nodes from the top of the scene down to the joints, parents first."""

    nodes: list[int]
    """Indices in the document: those above the first joint, then the joints, depth first."""
    parents: list[int]
    """For each of them the place of its parent in `nodes`; -1 at the top."""
    first_joint: int
    """Place of the first joint in `nodes`."""
    rest: dict[int, Rest]
    """By index in the document."""
    notes: tuple[str, ...]

    @classmethod
    def of(cls, path: Path, document: Any, moved: set[int]) -> "Tree":
        """Find the joints: those of the largest skin, else what an animation moves.

        Raises:
            FormatError: If nodes form no tree or nothing is a joint.
        """
        parent = _parents(path, document)
        skins = [set(skin.joints) for skin in document.skins]
        wanted = max(skins, key=len) if skins else moved
        wanted = {node for node in wanted if 0 <= node < len(document.nodes)}
        if not wanted:
            raise FormatError(path, "has neither a skin nor a moving node")
        tops = {node: _top(node, wanted, parent) for node in sorted(wanted)}
        top = max(tops.values(), key=lambda node: list(tops.values()).count(node))
        kept = {node for node, over in tops.items() if over == top}
        notes = [] if kept == wanted else [f"{len(wanted - kept)} joints beside the skeleton"]
        joints = _depth_first(document, top, _between(kept, top, parent))
        above = _above(top, parent)[::-1]
        nodes = [*above, *joints]
        rest = {node: _rest(document.nodes[node]) for node in nodes}
        if any(_uneven(document.nodes[node]) for node in nodes):
            notes.append("scales that differ by axis were taken for their mean")
        place = {node: i for i, node in enumerate(nodes)}
        parents = [place.get(parent.get(node, -1), -1) for node in nodes]
        return cls(nodes, parents, len(above), rest, tuple(notes))


def _parents(path: Path, document: Any) -> dict[int, int]:
    """Return the parent of each node that has one."""
    parent: dict[int, int] = {}
    for index, node in enumerate(document.nodes):
        for child in node.children or ():
            if child in parent or not 0 <= child < len(document.nodes):
                raise FormatError(path, f"node {child} has two parents or does not exist")
            parent[child] = index
    for node in range(len(document.nodes)):
        if node in _above(node, parent):
            raise FormatError(path, f"node {node} is below itself")
    return parent


def _above(node: int, parent: dict[int, int]) -> list[int]:
    """Return the nodes above one, nearest first; no more than there are, if they form a ring."""
    found: list[int] = []
    while node in parent and len(found) <= len(parent):
        node = parent[node]
        found.append(node)
    return found


def _top(node: int, joints: set[int], parent: dict[int, int]) -> int:
    """Return the highest joint above a joint, itself where there is none."""
    return next((n for n in reversed(_above(node, parent)) if n in joints), node)


def _between(joints: set[int], top: int, parent: dict[int, int]) -> set[int]:
    """Return the joints and what lies between them and the top."""
    nodes = {top}
    for joint in joints - {top}:
        above = _above(joint, parent)
        nodes |= {joint, *above[: above.index(top)]}
    return nodes


def _depth_first(document: Any, top: int, among: set[int]) -> list[int]:
    order, waiting = [], [top]
    while waiting:
        node = waiting.pop()
        order.append(node)
        waiting += [c for c in reversed(document.nodes[node].children or []) if c in among]
    return order


def _rest(node: Any) -> Rest:
    if node.matrix:
        matrix = np.array(node.matrix, np.float64).reshape(4, 4).T
        scales = np.linalg.norm(matrix[:3, :3], axis=0)
        turn = _from_matrix(matrix[:3, :3] / scales)
        return Rest(matrix[:3, 3], turn, float(scales.mean()))
    translation = np.array(node.translation or (0.0, 0.0, 0.0), np.float64).reshape(3)
    rotation = np.array(node.rotation or (0.0, 0.0, 0.0, 1.0), np.float64).reshape(4)
    scale = float(np.mean(node.scale or (1.0, 1.0, 1.0)))
    return Rest(translation, quaternion.normalize(rotation[_SCALAR_FIRST]), scale)


def _uneven(node: Any) -> bool:
    scales = np.array(node.scale or (1.0, 1.0, 1.0), np.float64)
    if node.matrix:
        scales = np.linalg.norm(np.array(node.matrix, np.float64).reshape(4, 4)[:3, :3], axis=1)
    return bool(np.ptp(scales) > _UNEVEN * np.abs(scales).max())


def _from_matrix(matrix: Vectors) -> Quaternions:
    """Return the quaternion of a rotation `(3, 3)`: the eigenvector of Bar-Itzhack (2000)."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = matrix
    k = np.array(
        [
            [xx + yy + zz, zy - yz, xz - zx, yx - xy],
            [zy - yz, xx - yy - zz, xy + yx, xz + zx],
            [xz - zx, xy + yx, yy - xx - zz, yz + zy],
            [yx - xy, xz + zx, yz + zy, zz - xx - yy],
        ]
    )
    return np.asarray(np.linalg.eigh(k)[1][:, -1])
