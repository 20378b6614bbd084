"""Frames as they lie on the wire, written at once: the bytes that `AnimateResponse` would have.

Numbers and events are small and go through protobuf; blocks are appended as they are, so that they
are copied once. Stage times, the same in each frame, are written by hand.
"""

import struct
from functools import lru_cache
from typing import Any

import numpy as np

from stridewire._codec.blocks import LENGTH_DELIMITED, varint
from stridewire._codec.events import encode_event
from stridewire._messages import Frame, PoseFormat
from stridewire.motion.array_types import Floats
from stridewire.v1 import animation_pb2 as pb

_TAGS = {
    field.name: varint(field.number << 3 | LENGTH_DELIMITED) for field in pb.Frame.DESCRIPTOR.fields
}
_FRAME = varint(
    pb.AnimateResponse.DESCRIPTOR.fields_by_name["frame"].number << 3 | LENGTH_DELIMITED
)
_FIXED32 = 5
_ELAPSED = varint(pb.StageTiming.DESCRIPTOR.fields_by_name["elapsed_ms"].number << 3 | _FIXED32)
_FLOAT = struct.Struct("<f")
_WHOLE, _HALF = np.dtype("<f4"), np.dtype("<f2")


def frame_bytes(frame: Frame) -> bytes:
    """Return the bytes of the response that holds a frame."""
    small = pb.Frame(
        frame=frame.frame,
        applied_step=frame.applied_step,
        time_s=frame.time_s,
        client_time_s=frame.client_time_s,
        characters=frame.characters.tolist(),
        contacts=frame.contacts.tolist(),
        flags=frame.flags.tolist(),
        dropped=frame.dropped,
        searches=frame.searches,
    )
    if frame.events:
        small.events.extend(map(encode_event, frame.events))
    parts = [small.SerializeToString(), _timings(tuple(frame.timings_ms.items()))]
    # half floats have steps of 6 cm a hundred metres from the origin: the root comes whole, too
    _block(parts, "root", frame.root)
    _block(parts, "foot_targets", frame.foot_targets)
    end, kind = ("_f16", _HALF) if frame.format is PoseFormat.F16 else ("", _WHOLE)
    if end:
        _block(parts, "root_f16", frame.root, kind)
    _block(parts, f"root_delta{end}", frame.root_delta, kind)
    _block(parts, f"hips{end}", frame.hips, kind)
    _block(parts, f"rotations{end}", frame.rotations, kind)
    if frame.simulated_root is not None:
        _block(parts, "simulated_root", frame.simulated_root)
    if frame.inside is not None:
        inside = frame.inside
        _block(parts, "ahead_s", inside.ahead_s)
        _block(parts, "predicted", inside.predicted)
        _block(parts, "captured", inside.captured)
        _block(parts, "sampled_hips", inside.hips)
        _block(parts, "sampled_rotations", inside.rotations)
    size = sum(map(len, parts))
    return b"".join([_FRAME, varint(size), *parts])


def _block(parts: list[bytes], name: str, values: Floats, kind: "np.dtype[Any]" = _WHOLE) -> None:
    """Append a block: tag, length, and the bytes of the array itself."""
    data = np.asarray(values, kind).tobytes()
    if data:
        parts += (_head(name, len(data)), data)


@lru_cache(maxsize=256)
def _head(name: str, size: int) -> bytes:
    """Return what stands before a block of so many bytes."""
    return _TAGS[name] + varint(size)


@lru_cache(maxsize=4)
def _timings(timings_ms: tuple[tuple[str, float], ...]) -> bytes:
    """Write the times of a tick, the same for all its sessions."""
    return b"".join(_stage(stage) + _FLOAT.pack(elapsed) for stage, elapsed in timings_ms)


@lru_cache(maxsize=64)
def _stage(stage: str) -> bytes:
    """Return what stands before the time of a stage."""
    name = pb.StageTiming(stage=stage).SerializeToString() + _ELAPSED
    return _TAGS["timings"] + varint(len(name) + _FLOAT.size) + name
