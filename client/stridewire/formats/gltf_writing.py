"""Writing glTF: one `.glb` with skeleton, animation and a body of capsules bound to it.

Metres, +Y up, a character looks along +Z, as glTF has it. Each joint is a node; the first one's
translation and the rotations of all have keys at every frame. Where end sites are known their
offsets stand in the `extras` of their joint's node.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stridewire._version import __version__
from stridewire.formats.bvh_writing import leaf_tips
from stridewire.formats.conversion import scaled
from stridewire.formats.gltf_arrays import ArrayWriter, library
from stridewire.formats.gltf_figure import Surface, figure
from stridewire.formats.source_motion import SourceMotion
from stridewire.formats.units import likely_unit
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.skeleton import Skeleton

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_SCALAR_LAST = [1, 2, 3, 0]


def write_glb(path: Path | str, motion: SourceMotion) -> None:
    """Write a motion as binary glTF.

    Args:
        path: Of the file.
        motion: Y up; without a unit it is taken for people's by the length of its legs.

    Raises:
        ValueError: If it has no frame rate.
        StridewireError: If pygltflib is not installed.
        OSError: If the file cannot be written.
    """
    if motion.frame_rate is None:
        raise ValueError(f"{motion.path} says no frame rate; give one")
    motion = scaled(motion, motion.metres_per_unit or likely_unit(motion.skeleton))
    _write(path, motion.name, motion.skeleton, motion.tips, motion)


def write_body(path: Path | str, skeleton: Skeleton) -> None:
    """Write a body that stands still, for an engine that moves its joints itself.

    Args:
        path: Of the `.glb`.
        skeleton: Such as `session.opened.skeleton`; metres.

    Raises:
        StridewireError: If pygltflib is not installed.
        OSError: If the file cannot be written.
    """
    _write(path, "Character", skeleton, leaf_tips(skeleton), None)


def _write(
    path: Path | str,
    name: str,
    skeleton: Skeleton,
    tips: Mapping[int, Vectors],
    motion: SourceMotion | None,
) -> None:
    gltf = library()
    document = gltf.GLTF2(asset=gltf.Asset(generator=f"stridewire {__version__}"))
    arrays = ArrayWriter(document)
    rest = _at_rest(skeleton)
    _nodes(document, name, skeleton, tips)
    _skin(document, arrays, rest)
    _mesh(document, arrays, figure(skeleton, rest, tips))
    if motion is not None:
        _animation(document, arrays, motion)
    arrays.finish()
    Path(path).write_bytes(b"".join(document.save_to_bytes()))


def _at_rest(skeleton: Skeleton) -> Vectors:
    """Return `(J, 3)` the joints where all local rotations are zero."""
    rest = skeleton.offsets.copy()
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        rest[joint] += rest[parent]
    return rest


def _nodes(document: Any, name: str, skeleton: Skeleton, tips: Mapping[int, Vectors]) -> None:
    """Add a node for each joint, in order, after them the body, and one above all.

    The body is no root, which the Khronos validator would rather have: Panda3D takes a skin
    for a character only where both are below one node, as Blender writes them.
    """
    gltf = library()
    for joint, joint_name in enumerate(skeleton.names):
        children = [child for child, parent in enumerate(skeleton.parents) if parent == joint]
        node = gltf.Node(name=joint_name, children=children)
        node.translation = skeleton.offsets[joint].tolist()
        if joint in tips:
            node.extras = {"end_site": np.asarray(tips[joint], np.float64).tolist()}
        document.nodes.append(node)
    document.nodes.append(gltf.Node(name="Body", mesh=0, skin=0))
    document.nodes.append(gltf.Node(name="Armature", children=[0, len(skeleton)]))
    document.scenes.append(gltf.Scene(name=name, nodes=[len(skeleton) + 1]))
    document.scene = 0


def _skin(document: Any, arrays: ArrayWriter, rest: Vectors) -> None:
    inverse = np.tile(np.eye(4, dtype=np.float32), (len(rest), 1, 1))
    inverse[:, 3, :3] = -rest  # column-major
    accessor = arrays.add(inverse.reshape(-1, 16))
    joints = list(range(len(rest)))
    skin = library().Skin(inverseBindMatrices=accessor, joints=joints, skeleton=len(rest) + 1)
    document.skins.append(skin)


def _mesh(document: Any, arrays: ArrayWriter, surfaces: list[Surface]) -> None:
    gltf = library()
    primitives = []
    for number, surface in enumerate(surfaces):
        followed = np.zeros((len(surface.joints), 4), np.uint16)
        followed[:, 0] = surface.joints
        weights = np.zeros((len(surface.joints), 4), np.float32)
        weights[:, 0] = 1.0  # as bytes, which glTF allows, Panda3D takes them for 255
        attributes = gltf.Attributes(
            POSITION=arrays.add(surface.positions, target=_ARRAY_BUFFER, bounds=True),
            NORMAL=arrays.add(surface.normals, target=_ARRAY_BUFFER),
            JOINTS_0=arrays.add(followed, target=_ARRAY_BUFFER),
            WEIGHTS_0=arrays.add(weights, target=_ARRAY_BUFFER),
        )
        corners = surface.triangles.reshape(-1)
        if len(surface.positions) < np.iinfo(np.uint16).max:
            corners = corners.astype(np.uint16)
        indices = arrays.add(corners, target=_ELEMENT_ARRAY_BUFFER)
        primitives.append(gltf.Primitive(attributes=attributes, indices=indices, material=number))
        document.materials.append(_material(surface.colour))
    document.meshes.append(gltf.Mesh(name="Body", primitives=primitives))


def _material(colour: str) -> Any:
    gltf = library()
    screen = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    linear = np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4)
    factors = [*np.round(linear, 4).tolist(), 1.0]
    surface = gltf.PbrMetallicRoughness(
        baseColorFactor=factors, metallicFactor=0.0, roughnessFactor=0.8
    )
    return gltf.Material(name=colour, pbrMetallicRoughness=surface)


def _animation(document: Any, arrays: ArrayWriter, motion: SourceMotion) -> None:
    gltf = library()
    seconds = np.arange(len(motion)) / np.float64(motion.frame_rate or 1.0)
    times = arrays.add(seconds.astype(np.float32), bounds=True)
    animation = gltf.Animation(name=motion.name)

    def channel(joint: int, path: str, values: Floats) -> None:
        keys = arrays.add(values.astype(np.float32))
        target = gltf.AnimationChannelTarget(node=joint, path=path)
        animation.samplers.append(gltf.AnimationSampler(input=times, output=keys))
        number = len(animation.samplers) - 1
        animation.channels.append(gltf.AnimationChannel(sampler=number, target=target))

    rotations = quaternion.normalize(quaternion.unroll(motion.rotations))[..., _SCALAR_LAST]
    for joint in range(len(motion.skeleton)):
        channel(joint, "rotation", rotations[:, joint])
    channel(0, "translation", motion.root_positions)
    if motion.translations is not None:
        for joint in range(1, len(motion.skeleton)):
            channel(joint, "translation", motion.translations[:, joint])
    document.animations.append(animation)
