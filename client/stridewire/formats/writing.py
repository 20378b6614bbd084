"""Writing any motion file by its ending."""

from collections.abc import Callable
from pathlib import Path

from stridewire.formats.bvh_writing import clip_in_centimetres, write_source_bvh
from stridewire.formats.gltf_writing import write_glb
from stridewire.formats.npz import write_npz
from stridewire.formats.source_motion import SourceMotion
from stridewire.motion.clip import Clip

WRITERS: dict[str, Callable[[Path, SourceMotion], None]] = {
    ".bvh": write_source_bvh,
    ".glb": write_glb,
    ".npz": write_npz,
}
"""Writers by ending, lower case."""


def find_writer(path: Path) -> Callable[[Path, SourceMotion], None]:
    """Return what writes a file of this ending.

    Raises:
        ValueError: If nothing does.
    """
    writer = WRITERS.get(path.suffix.lower())
    if writer is None:
        raise ValueError(f"cannot write {path.name}; expected {', '.join(WRITERS)}")
    return writer


def write_clip(path: Path, clip: Clip) -> None:
    """Write a clip, Y up: BVH and npz in centimetres, glTF in metres.

    Hips are in the world; the root on the ground and the contacts are found again on import.

    Raises:
        ValueError: If nothing writes files of this ending.
        StridewireError: If what does so is not installed.
        OSError: If the file cannot be written.
    """
    find_writer(path)(path, clip_in_centimetres(clip, path))
