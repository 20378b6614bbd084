"""Poses by reference or inline, as searches and blends take them."""

import numpy as np

from stridewire._codec.catalogue import decode_poses, encode_poses
from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import ClipTime
from stridewire.motion.clip import Pose
from stridewire.v1 import pose_pb2


def encode_pose_source(pose: ClipTime | Pose) -> pose_pb2.PoseSource:
    """Encode a moment, or one pose without leading shape."""
    if isinstance(pose, ClipTime):
        return pose_pb2.PoseSource(clip=encode_clip_time(pose))
    return pose_pb2.PoseSource(inline=encode_poses(pose[np.newaxis]))


def decode_pose_source(wire: pose_pb2.PoseSource, path: str) -> ClipTime | Pose:
    """Decode a moment, or one pose without leading shape.

    Args:
        wire: The source.
        path: Of its field.

    Raises:
        InvalidRequestError: If there is neither, or not one pose.
    """
    match wire.WhichOneof("source"):
        case "clip":
            return decode_clip_time(wire.clip)
        case "inline":
            return _decode_inline(wire.inline, f"{path}.inline")
    raise InvalidRequestError.of(
        Violation(path, "absent; give the clip and the time, or a pose inline")
    )


def encode_clip_time(moment: ClipTime) -> pose_pb2.ClipTime:
    """Encode a moment of a library."""
    return pose_pb2.ClipTime(library=moment.library, clip=moment.clip, time_s=moment.time_s)


def decode_clip_time(wire: pose_pb2.ClipTime) -> ClipTime:
    """Decode a moment of a library."""
    return ClipTime(wire.clip, wire.time_s, wire.library)


def _decode_inline(wire: pose_pb2.Poses, path: str) -> Pose:
    if wire.frames != 1:
        raise InvalidRequestError.of(
            Violation(f"{path}.frames", f"{wire.frames}; one pose is 1 frame")
        )
    wrong = [
        Violation(f"{path}.{name}", f"{len(values)} values for 1 frame; expected {expected}")
        for name, values, expected, fits in (
            ("root", wire.root, "7", len(wire.root) == 7),
            ("hips", wire.hips, "3", len(wire.hips) == 3),
            ("rotations", wire.rotations, "4 a joint", len(wire.rotations) % 4 == 0),
        )
        if not fits
    ]
    if wrong:
        raise InvalidRequestError.of(*wrong)
    return decode_poses(wire)[0]
