"""Writing glTF: one `.glb` with skeleton, animation and a body of capsules bound to it.

Metres, +Y up, a character looks along +Z, as glTF has it. Each joint is a node; the first one's
translation and the rotations of all have keys at every frame. Where end sites are known their
offsets stand in the `extras` of their joint's node.
"""

from pathlib import Path
from typing import Any

import numpy as np

from stridewire._version import __version__
from stridewire.formats.conversion import scaled
from stridewire.formats.gltf_arrays import ArrayWriter, library
from stridewire.formats.gltf_figure import Surface, figure
from stridewire.formats.source_motion import SourceMotion
from stridewire.formats.units import likely_unit
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Vectors

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
    gltf = library()
    document = gltf.GLTF2(asset=gltf.Asset(generator=f"stridewire {__version__}"))
    arrays = ArrayWriter(document)
    rest = _at_rest(motion)
    _nodes(document, motion)
    _skin(document, arrays, rest)
    _mesh(document, arrays, figure(motion.skeleton, rest, dict(motion.tips)))
    _animation(document, arrays, motion)
    arrays.finish()
    Path(path).write_bytes(b"".join(document.save_to_bytes()))


def _at_rest(motion: SourceMotion) -> Vectors:
    """Return `(J, 3)` the joints where all local rotations are zero."""
    rest = motion.skeleton.offsets.copy()
    for joint, parent in enumerate(motion.skeleton.parents[1:], start=1):
        rest[joint] += rest[parent]
    return rest


def _nodes(document: Any, motion: SourceMotion) -> None:
    """Add a node for each joint, in order, and after them one for the body."""
    gltf, skeleton = library(), motion.skeleton
    for joint, name in enumerate(skeleton.names):
        children = [child for child, parent in enumerate(skeleton.parents) if parent == joint]
        node = gltf.Node(name=name, children=children)
        node.translation = skeleton.offsets[joint].tolist()
        if joint in motion.tips:
            node.extras = {"end_site": np.asarray(motion.tips[joint], np.float64).tolist()}
        document.nodes.append(node)
    document.nodes.append(gltf.Node(name="Body", mesh=0, skin=0))
    document.scenes.append(gltf.Scene(name=motion.name, nodes=[0, len(skeleton)]))
    document.scene = 0


def _skin(document: Any, arrays: ArrayWriter, rest: Vectors) -> None:
    inverse = np.tile(np.eye(4, dtype=np.float32), (len(rest), 1, 1))
    inverse[:, 3, :3] = -rest  # column-major
    accessor = arrays.add(inverse.reshape(-1, 16))
    joints = list(range(len(rest)))
    skin = library().Skin(inverseBindMatrices=accessor, joints=joints, skeleton=0)
    document.skins.append(skin)


def _mesh(document: Any, arrays: ArrayWriter, surfaces: list[Surface]) -> None:
    gltf = library()
    primitives = []
    for number, surface in enumerate(surfaces):
        followed = np.zeros((len(surface.joints), 4), np.uint16)
        followed[:, 0] = surface.joints
        weights = np.zeros((len(surface.joints), 4), np.uint8)
        weights[:, 0] = 255
        attributes = gltf.Attributes(
            POSITION=arrays.add(surface.positions, target=_ARRAY_BUFFER, bounds=True),
            NORMAL=arrays.add(surface.normals, target=_ARRAY_BUFFER),
            JOINTS_0=arrays.add(followed, target=_ARRAY_BUFFER),
            WEIGHTS_0=arrays.add(weights, target=_ARRAY_BUFFER, unit=True),
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
