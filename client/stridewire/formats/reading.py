"""Reading any motion file by its ending."""

from collections.abc import Callable
from pathlib import Path

from stridewire.formats.acclaim import read_acclaim
from stridewire.formats.bvh import read_bvh
from stridewire.formats.gltf import read_gltf
from stridewire.formats.npz import read_npz
from stridewire.formats.source_motion import FormatError, SourceMotion

READERS: dict[str, Callable[[Path], SourceMotion]] = {
    ".bvh": read_bvh,
    ".amc": read_acclaim,
    ".npz": read_npz,
    ".glb": read_gltf,
    ".gltf": read_gltf,
}
"""Readers by ending, lower case."""


def read_motion(path: Path | str) -> SourceMotion:
    """Read a motion file.

    Raises:
        FormatError: If the ending is unknown or the file cannot be read.
        OSError: If it cannot be opened.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise FormatError(path, f"cannot read {path.suffix or 'it'}; expected {', '.join(READERS)}")
    return reader(path)
