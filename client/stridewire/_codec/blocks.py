"""Blocks of numbers: packed `repeated float` fields, written and read in one piece.

A packed `repeated float` lies on the wire as tag, length in bytes and little-endian float32 values:
the bytes of the array itself. Copying them whole costs microseconds where filling from a list costs
milliseconds, on every version of protobuf.
"""

import math
import struct

import numpy as np
from google.protobuf.message import Message

from stridewire.motion.array_types import Floats, Indices

LENGTH_DELIMITED = 2
_FEW = 32
"""Up to so many numbers, one by one is faster."""


def write_blocks(message: Message, **blocks: Floats) -> None:
    """Append arrays to `repeated float` fields, flattened row by row.

    Args:
        message: The message that has the fields.
        blocks: An array of any shape for each field by name.
    """
    fields = message.DESCRIPTOR.fields_by_name
    parts = []
    for name, values in blocks.items():
        data = np.asarray(values, "<f4").tobytes()
        if data:
            parts += [
                varint(fields[name].number << 3 | LENGTH_DELIMITED),
                varint(len(data)),
                data,
            ]
    message.MergeFromString(b"".join(parts))


def read_block(message: Message, name: str, *shape: int) -> Floats:
    """Return a `repeated float` field as a read-only float32 array.

    Args:
        message: The message that has the field.
        name: Name of the field.
        shape: Shape of the array, at most one -1; without it, or where the values do not fill it,
            the array is flat.
    """
    field = getattr(message, name)
    if len(field) <= _FEW:
        data = struct.pack(f"<{len(field)}f", *field)
    else:
        alone = type(message)()
        getattr(alone, name).MergeFrom(field)
        data = alone.SerializeToString()
    block = np.frombuffer(data, "<f4", offset=len(data) - 4 * len(field))
    if not shape:
        return block
    fixed = math.prod(size for size in shape if size != -1)
    fits = block.size % fixed == 0 if -1 in shape and fixed else block.size == fixed
    return block.reshape(shape) if fits else block


def write_halves(message: Message, **blocks: Floats) -> None:
    """Write arrays to `bytes` fields as little-endian half floats, flattened row by row."""
    for name, values in blocks.items():
        setattr(message, name, np.asarray(values, "<f2").tobytes())


def read_halves(message: Message, name: str, *shape: int) -> Floats:
    """Return a block of half floats as a read-only float32 array.

    Args:
        message: The message that has the field `NAME_f16`.
        name: Name of the block.
        shape: Shape of the array.
    """
    block = np.frombuffer(getattr(message, f"{name}_f16"), "<f2").astype(np.float32)
    block.flags.writeable = False
    return block.reshape(shape) if block.size == np.prod(shape, dtype=int) else block


def read_integers(values: object) -> Indices:
    """Return a `repeated uint32` field as a read-only array."""
    integers = np.array(values, np.uint32)
    integers.flags.writeable = False
    return integers


def varint(number: int) -> bytes:
    """Write an unsigned integer in groups of seven bits, the lowest first."""
    out = bytearray()
    while number > 0x7F:
        out.append(number & 0x7F | 0x80)
        number >>= 7
    out.append(number)
    return bytes(out)
