"""The byte layout of the messages, for engines without a protobuf library.

A message is a run of fields, each a tag and a value. What a client must know beside that fits into
one JSON object: every field's tag and type by name, and the shapes of a frame's blocks. It is read
off the contract itself, so that it cannot differ from it.
"""

from typing import Any

from google.protobuf.descriptor_pb2 import DescriptorProto, FieldDescriptorProto

from stridewire.v1 import animation_pb2 as pb

ENCODING = {
    "message": "a run of fields in any order; one that is absent is 0, empty or false",
    "field": "its tag, then its value; skip tags that you do not know by the wire type, tag & 7",
    "tag": "a varint: the number of the field << 3 | wire type",
    "varint": "seven bits a byte, the lowest first; the highest bit says that another byte follows",
    "wire_types": {
        "0": "one varint",
        "1": "8 bytes, little-endian",
        "2": "a varint that tells a length in bytes, then as many bytes",
        "5": "4 bytes, little-endian",
    },
    "packed": "a repeated field of numbers is one value of wire type 2: the numbers side by side",
    "repeated": "any other repeated field is written once for each element",
    "negative": "an int32 below 0 is a varint of ten bytes: take 2**64 off it",
}

_XYZ = ["x", "y", "z"]
_QUATERNION = ["w", "x", "y", "z"]
_ROOT = [*_XYZ, "qw", "qx", "qy", "qz"]
_YAW = [*_XYZ, "yaw"]
_WAY = ["x", "z", "yaw"]

BLOCKS: dict[str, dict[str, Any]] = {
    "characters": {"shape": ["N"]},
    "root": {"shape": ["N", 7], "columns": _ROOT},
    "root_delta": {"shape": ["N", 4], "columns": _YAW},
    "hips": {"shape": ["N", 3], "columns": _XYZ},
    "rotations": {"shape": ["N", "J", 4], "columns": _QUATERNION},
    "contacts": {"shape": ["N"], "bits": ["left foot", "left toe", "right foot", "right toe"]},
    "foot_targets": {"shape": ["N", 2, 3], "columns": _XYZ},
    "simulated_root": {"shape": ["N", 4], "columns": _YAW},
    "flags": {"shape": ["N"], "bits": "1 << value of FrameFlag"},
    "root_f16": {"shape": ["N", 7], "columns": _ROOT, "type": "float16"},
    "root_delta_f16": {"shape": ["N", 4], "columns": _YAW, "type": "float16"},
    "hips_f16": {"shape": ["N", 3], "columns": _XYZ, "type": "float16"},
    "rotations_f16": {"shape": ["N", "J", 4], "columns": _QUATERNION, "type": "float16"},
    "ahead_s": {"shape": ["K"]},
    "predicted": {"shape": ["N", "K", 3], "columns": _WAY},
    "captured": {"shape": ["N", "K", 3], "columns": _WAY},
    "sampled_hips": {"shape": ["N", 3], "columns": _XYZ},
    "sampled_rotations": {"shape": ["N", "J", 4], "columns": _QUATERNION},
}
"""Row-major; N characters, J joints of the skeleton, K times ahead."""

_KINDS = {
    FieldDescriptorProto.TYPE_DOUBLE: ("float64", 1),
    FieldDescriptorProto.TYPE_FLOAT: ("float32", 5),
    FieldDescriptorProto.TYPE_UINT32: ("uint32", 0),
    FieldDescriptorProto.TYPE_INT32: ("int32", 0),
    FieldDescriptorProto.TYPE_BOOL: ("bool", 0),
    FieldDescriptorProto.TYPE_ENUM: ("enum", 0),
    FieldDescriptorProto.TYPE_STRING: ("string", 2),
    FieldDescriptorProto.TYPE_BYTES: ("bytes", 2),
    FieldDescriptorProto.TYPE_MESSAGE: ("message", 2),
}
_LENGTH_DELIMITED = 2


def layout() -> dict[str, Any]:
    """Return the layout of everything that travels on a stream, to be written as JSON."""
    messages: dict[str, Any] = {}
    enums: dict[str, Any] = {}
    _describe(pb.AnimateRequest, messages, enums)
    _describe(pb.AnimateResponse, messages, enums)
    return {
        "endpoint": "/v1/animate",
        "send": "AnimateRequest",
        "receive": "AnimateResponse",
        "encoding": ENCODING,
        "blocks": BLOCKS,
        "messages": messages,
        "enums": enums,
    }


def _describe(message: Any, messages: dict[str, Any], enums: dict[str, Any]) -> None:
    """Add a message, given by its class or descriptor, and all that it holds."""
    descriptor = getattr(message, "DESCRIPTOR", message)
    if descriptor.name in messages:
        return
    proto = DescriptorProto()
    descriptor.CopyToProto(proto)
    messages[descriptor.name] = {field.name: _field(field) for field in proto.field}
    for field in descriptor.fields:
        if field.message_type is not None:
            _describe(field.message_type, messages, enums)
        if field.enum_type is not None:
            values = field.enum_type.values
            enums[field.enum_type.name] = {value.name: value.number for value in values}


def _field(field: FieldDescriptorProto) -> dict[str, Any]:
    kind, wire_type = _KINDS[field.type]
    repeated = field.label == FieldDescriptorProto.LABEL_REPEATED
    packed = repeated and wire_type != _LENGTH_DELIMITED
    return {
        "tag": field.number << 3 | (_LENGTH_DELIMITED if packed else wire_type),
        "type": kind,
        **({"repeated": "packed" if packed else "one by one"} if repeated else {}),
        **({"of": field.type_name.rpartition(".")[2]} if field.type_name else {}),
    }
