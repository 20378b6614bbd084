"""Blends: postures between two postures."""

import numpy as np

from stridewire._codec.blocks import read_block, write_blocks
from stridewire._codec.catalogue import decode_poses, encode_poses
from stridewire._codec.pose_sources import decode_pose_source, encode_pose_source
from stridewire._codec.shared import decode_enum
from stridewire._messages import BlendManyQuery, BlendMethod, BlendQuery, BlendResult
from stridewire.v1 import blend_pb2 as pb


def encode_blend(query: BlendQuery) -> pb.BlendRequest:
    """Encode a pair and its weights."""
    wire = pb.BlendRequest(
        start=encode_pose_source(query.start),
        end=encode_pose_source(query.end),
        method=f"BLEND_METHOD_{query.method.name}",
        joint_mask=query.joint_mask,
        ground_height=query.ground_height,
        duration_s=query.duration_s,
    )
    write_blocks(wire, weights=np.asarray(query.weights, np.float32))
    return wire


def decode_blend(wire: pb.BlendRequest, path: str = "") -> BlendQuery:
    """Decode a pair and its weights.

    Args:
        wire: The request.
        path: In front of its fields.

    Raises:
        InvalidRequestError: If a posture is absent or the method has no meaning.
    """
    return BlendQuery(
        decode_pose_source(wire.start, f"{path}start"),
        decode_pose_source(wire.end, f"{path}end"),
        read_block(wire, "weights"),
        decode_enum(BlendMethod, wire.method, BlendMethod.AUTO, f"{path}method"),
        dict(wire.joint_mask),
        wire.ground_height,
        wire.duration_s,
    )


def encode_blend_result(result: BlendResult) -> pb.BlendResponse:
    """Encode postures."""
    return pb.BlendResponse(
        poses=encode_poses(result.pose),
        method=f"BLEND_METHOD_{result.method.name}",
        reason=result.reason,
    )


def decode_blend_result(wire: pb.BlendResponse) -> BlendResult:
    """Decode postures."""
    return BlendResult(decode_poses(wire.poses), BlendMethod(wire.method), wire.reason)


def encode_blend_many(query: BlendManyQuery) -> pb.BlendManyRequest:
    """Encode many pairs."""
    return pb.BlendManyRequest(requests=map(encode_blend, query.requests))


def decode_blend_many(wire: pb.BlendManyRequest) -> BlendManyQuery:
    """Decode many pairs.

    Raises:
        InvalidRequestError: If a posture is absent or a method has no meaning.
    """
    return BlendManyQuery(
        tuple(decode_blend(one, f"requests[{i}].") for i, one in enumerate(wire.requests))
    )


def encode_blend_many_result(results: tuple[BlendResult, ...]) -> pb.BlendManyResponse:
    """Encode the postures of many pairs."""
    return pb.BlendManyResponse(responses=map(encode_blend_result, results))


def decode_blend_many_result(wire: pb.BlendManyResponse) -> tuple[BlendResult, ...]:
    """Decode the postures of many pairs."""
    return tuple(map(decode_blend_result, wire.responses))
