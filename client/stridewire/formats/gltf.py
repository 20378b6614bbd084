"""Reading glTF: the animation of a skeleton in a `.glb` or `.gltf` file.

glTF joints may be turned at rest in any way. What is read has the skeleton's rest pose, the nodes'
own transforms, where all local rotations are zero, as in BVH; places in the world are the file's.
"""

import struct
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.formats.gltf_arrays import ArrayReader, library
from stridewire.formats.gltf_channels import Channels
from stridewire.formats.gltf_tree import Tree
from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.kinematics import to_local
from stridewire.motion.skeleton import Skeleton, SkeletonError

_MALFORMED = (
    AttributeError,
    IndexError,
    KeyError,
    RecursionError,
    TypeError,
    ValueError,
    struct.error,
)
_STILL = 1e-5
"""Joints that move less from their rest offsets do not move; by the skeleton's size."""


def read_gltf(path: Path | str) -> SourceMotion:
    """Read the first animation of a file, on the skeleton of its skin or of what it moves.

    In metres. Keys are sampled evenly at the rate of the densest channel.

    Raises:
        FormatError: If it is no glTF 2.0, has no animation or is damaged.
        StridewireError: If pygltflib is not installed.
        OSError: If it cannot be opened.
    """
    path = Path(path)
    gltf = library()
    with path.open("rb") as file:
        data = file.read()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            document = (
                gltf.GLTF2.load_from_bytes(data)
                if data.startswith(b"glTF")
                else gltf.GLTF2.gltf_from_json(data.decode())
            )
            return _motion(path, document)
    except FormatError:
        raise
    except (SkeletonError, UserWarning, OSError, *_MALFORMED) as error:
        raise FormatError(path, f"no glTF 2.0 that can be read ({error})") from None


def _motion(path: Path, document: Any) -> SourceMotion:
    if document.extensionsRequired:
        raise FormatError(path, f"requires {', '.join(document.extensionsRequired)}")
    if not document.animations:
        raise FormatError(path, "has no animation")
    channels = Channels.read(path, document.animations[0], ArrayReader(path, document))
    tree = Tree.of(path, document, channels.nodes)
    placed = _placed(tree, channels)
    notes = [*tree.notes]
    if len(document.animations) > 1:
        read = document.animations[0].name or "the first"
        notes.append(f"{len(document.animations)} animations; {read} was read")
    return _straightened(path, document, tree, channels, placed, notes)


@dataclass(frozen=True)
class _Placed:
    """Joints at rest and over time; metres."""

    rest_positions: Vectors
    """`(J, 3)` in the world."""
    rest_rotations: Quaternions
    """`(J, 4)` in the world."""
    positions: Vectors
    """`(T, J, 3)` in the world."""
    rotations: Quaternions
    """`(T, J, 4)` in the world."""


def _placed(tree: Tree, channels: Channels) -> _Placed:
    """Place all nodes in the world, those above the first joint too; keep the joints."""
    frames, nodes = len(channels.times), len(tree.nodes)
    rest_at, rest_turn = np.empty((1, nodes, 3)), np.empty((1, nodes, 4))
    at, turn = np.empty((frames, nodes, 3)), np.empty((frames, nodes, 4))
    size = np.ones(nodes)
    for row, (node, parent) in enumerate(zip(tree.nodes, tree.parents, strict=True)):
        rest = tree.rest[node]
        size[row] = rest.scale * (size[parent] if parent >= 0 else 1.0)
        above = size[parent] if parent >= 0 else 1.0
        moving = channels.sample(node, "translation", rest.translation)
        turning = channels.sample(node, "rotation", rest.rotation)
        for where, turned, step, own in (
            (rest_at, rest_turn, rest.translation[None], rest.rotation[None]),
            (at, turn, moving, turning),
        ):
            if parent < 0:
                where[:, row], turned[:, row] = step, own
                continue
            step = np.broadcast_to(above * step, where[:, row].shape)
            where[:, row] = where[:, parent] + quaternion.rotate(turned[:, parent], step)
            turned[:, row] = quaternion.multiply(turned[:, parent], own)
    first = tree.first_joint
    return _Placed(rest_at[0, first:], rest_turn[0, first:], at[:, first:], turn[:, first:])


def _straightened(
    path: Path, document: Any, tree: Tree, channels: Channels, placed: _Placed, notes: list[str]
) -> SourceMotion:
    """Choose joints' axes that are the world's at rest: rotations are zero there."""
    parents = [parent - tree.first_joint for parent in tree.parents[tree.first_joint :]]
    parents[0] = -1
    joints = tree.nodes[tree.first_joint :]
    offsets = placed.rest_positions.copy()
    offsets[1:] -= placed.rest_positions[parents[1:]]
    names = _unique([document.nodes[node].name or f"joint-{node}" for node in joints])
    skeleton = Skeleton(tuple(names), tuple(parents), offsets)
    turned = quaternion.multiply(placed.rotations, quaternion.conjugate(placed.rest_rotations))
    moving = _offsets_over_time(placed.positions, turned, parents)
    size = max(float(np.abs(offsets).max()), 1e-9)
    still = bool(np.abs(moving[:, 1:] - offsets[1:]).max(initial=0.0) < _STILL * size)
    return SourceMotion(
        path=path,
        skeleton=skeleton,
        tips=_end_sites(document, joints),
        frame_rate=channels.frame_rate,
        root_positions=placed.positions[:, 0],
        rotations=to_local(skeleton, turned),
        translations=None if still else moving,
        metres_per_unit=1.0,
        notes=tuple(notes),
    )


def _offsets_over_time(positions: Vectors, turned: Quaternions, parents: list[int]) -> Vectors:
    """Return `(T, J, 3)` offsets from the parents in the parents' frames; the first: places."""
    moving = positions.copy()
    above = parents[1:]
    moving[:, 1:] = quaternion.rotate(
        quaternion.conjugate(turned[:, above]), positions[:, 1:] - positions[:, above]
    )
    return moving


def _end_sites(document: Any, joints: list[int]) -> dict[int, Floats]:
    """Return the tips that `write_glb` noted."""
    noted = {j: (document.nodes[node].extras or {}) for j, node in enumerate(joints)}
    return {
        joint: np.array(extras["end_site"], np.float64).reshape(3)
        for joint, extras in noted.items()
        if isinstance(extras, dict) and "end_site" in extras
    }


def _unique(names: list[str]) -> list[str]:
    seen: set[str] = set()
    for index, name in enumerate(names):
        number, wanted = 1, name
        while wanted in seen:
            number, wanted = number + 1, f"{name}-{number + 1}"
        seen.add(wanted)
        names[index] = wanted
    return names
