"""Arrays in glTF documents: accessors into binary buffers, written and read.

pygltflib, which keeps the documents, has no types; what is used of it stays in `formats.gltf*`.
"""

import base64
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from stridewire._errors import StridewireError
from stridewire.formats.source_motion import FormatError
from stridewire.motion.array_types import Floats

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_MOST_BYTES = 1 << 31


def library() -> Any:
    """Return pygltflib.

    Raises:
        StridewireError: If it is not installed.
    """
    try:
        import pygltflib
    except ModuleNotFoundError as error:
        raise StridewireError("glTF needs pygltflib: pip install 'stridewire[server]'") from error
    return pygltflib


class ArrayWriter:
    """Puts arrays into a document's one buffer, each with a view and an accessor of its own.

    Args:
        document: A `pygltflib.GLTF2` that has no buffer yet.
    """

    def __init__(self, document: Any) -> None:
        self._gltf = library()
        self._document = document
        self._parts: list[bytes] = []
        self._length = 0

    def add(self, values: Any, *, target: int | None = None, bounds: bool = False) -> int:
        """Add an array `(N,)` or `(N, width)` and return the index of its accessor.

        Args:
            values: Of a type that glTF knows.
            target: `ARRAY_BUFFER` or `ELEMENT_ARRAY_BUFFER` for what a GPU draws.
            bounds: Note the least and the largest values, where glTF demands them.
        """
        array = np.ascontiguousarray(values)
        rows = array.reshape(len(array), -1)
        code = next(c for c, kind in _COMPONENTS.items() if np.dtype(kind) == array.dtype)
        view = self._gltf.BufferView(
            buffer=0, byteOffset=self._length, byteLength=array.nbytes, target=target
        )
        self._document.bufferViews.append(view)
        self._document.accessors.append(
            self._gltf.Accessor(
                bufferView=len(self._document.bufferViews) - 1,
                componentType=code,
                count=len(rows),
                type=_KINDS[rows.shape[1]],
                min=rows.min(axis=0).tolist() if bounds else None,
                max=rows.max(axis=0).tolist() if bounds else None,
            )
        )
        padding = bytes(-array.nbytes % 4)
        self._parts += [array.tobytes(), padding]
        self._length += array.nbytes + len(padding)
        return len(self._document.accessors) - 1

    def finish(self) -> None:
        """Give the document its buffer."""
        self._document.buffers.append(self._gltf.Buffer(byteLength=self._length))
        self._document.set_binary_blob(b"".join(self._parts))


class ArrayReader:
    """Reads accessors of a document.

    Args:
        path: Of the file; buffers that are files of their own lie beside it.
        document: What pygltflib read.
    """

    def __init__(self, path: Path, document: Any) -> None:
        self._path = path
        self._document = document
        self._buffers: dict[int, bytes] = {}

    def read(self, index: int, width: int) -> Floats:
        """Return an accessor's values `(N, width)` in float64.

        Raises:
            FormatError: If it is of another shape, reaches out of its buffer or is not finite.
        """
        accessor = self._document.accessors[index]
        if accessor.sparse is not None or accessor.bufferView is None:
            raise FormatError(self._path, f"accessor {index} is sparse, which is not read")
        if _WIDTHS.get(accessor.type) != width:
            raise FormatError(self._path, f"accessor {index} is {accessor.type}, not {width} wide")
        view = self._document.bufferViews[accessor.bufferView]
        kind = np.dtype(_COMPONENTS[accessor.componentType])
        row = kind.itemsize * width
        stride = view.byteStride or row
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        end = start + stride * (accessor.count - 1) + row
        data = self._buffer(view.buffer)
        if not (0 <= start < end <= len(data) and accessor.count > 0 and stride >= row):
            raise FormatError(self._path, f"accessor {index} reaches out of its buffer")
        raw: Any = np.ndarray((accessor.count, width), kind, data, start, (stride, kind.itemsize))
        values = np.asarray(raw, np.float64)
        if accessor.normalized and kind.kind in "iu":
            values = np.maximum(values / np.iinfo(kind).max, -1.0)
        if not np.all(np.abs(values) < 1e9):
            raise FormatError(self._path, f"accessor {index} is not finite")
        return values

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            self._buffers[index] = self._load(self._document.buffers[index].uri)
        return self._buffers[index]

    def _load(self, uri: str | None) -> bytes:
        """Return a buffer: the file's own, one in its text, or a file beside it."""
        if uri is None:
            return bytes(self._document.binary_blob() or b"")
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition("base64,")[2])
        name = unquote(uri)
        beside = self._path.parent / name
        if Path(name).name != name or beside.stat().st_size > _MOST_BYTES:
            raise FormatError(self._path, f"buffer {uri!r}; expected a file beside it")
        return beside.read_bytes()
