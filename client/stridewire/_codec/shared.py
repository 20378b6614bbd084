"""What streams and queries share: places, skeletons, trajectories, libraries, limits."""

from collections.abc import Iterable, Mapping
from enum import IntEnum
from typing import TypeVar

import numpy as np

from stridewire._codec.blocks import read_block, write_blocks
from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import GroundPose, LibraryInfo, Limits, Trajectory
from stridewire.motion.skeleton import REFERENCE, Skeleton, SkeletonError
from stridewire.v1 import animation_pb2, pose_pb2

_SKELETONS = {"reference": REFERENCE}

AnyEnum = TypeVar("AnyEnum", bound=IntEnum)


def decode_enum(kind: type[AnyEnum], value: int, default: AnyEnum, field: str) -> AnyEnum:
    """Return an enum's member; 0 means the default.

    Raises:
        InvalidRequestError: If the value is none of the enum's.
    """
    try:
        return kind(value) if value else default
    except ValueError:
        allowed = ", ".join(f"{member.value} ({member.name})" for member in kind)
        raise InvalidRequestError.of(
            Violation(field, f"{value} has no meaning; allowed are {allowed}")
        ) from None


def encode_ground_pose(pose: GroundPose) -> pose_pb2.GroundPose:
    """Encode a place on the ground."""
    x, y, z = pose.position
    return pose_pb2.GroundPose(position=pose_pb2.Vector3(x=x, y=y, z=z), yaw=pose.yaw)


def decode_ground_pose(wire: pose_pb2.GroundPose) -> GroundPose:
    """Decode a place on the ground; what is absent is 0."""
    return GroundPose((wire.position.x, wire.position.y, wire.position.z), wire.yaw)


def encode_skeleton(skeleton: Skeleton, name: str = "") -> pose_pb2.Skeleton:
    """Encode a skeleton."""
    wire = pose_pb2.Skeleton(name=name, joints=skeleton.names, parents=skeleton.parents)
    write_blocks(wire, offsets=skeleton.offsets)
    return wire


def decode_skeleton(wire: pose_pb2.Skeleton, field: str) -> Skeleton:
    """Decode a skeleton.

    Raises:
        InvalidRequestError: If names, parents and offsets make no tree.
    """
    if wire.name and not wire.joints:
        if wire.name not in _SKELETONS:
            known = ", ".join(_SKELETONS)
            raise InvalidRequestError.of(
                Violation(
                    f"{field}.name",
                    f"{wire.name!r} is not known, only {known}; give joints, parents and offsets",
                )
            )
        return _SKELETONS[wire.name]
    offsets = read_block(wire, "offsets", -1, 3)
    try:
        return Skeleton(tuple(wire.joints), tuple(wire.parents), offsets.astype(np.float64))
    except SkeletonError as error:
        raise InvalidRequestError.of(Violation(field, str(error))) from error


def encode_trajectory(trajectory: Trajectory) -> pose_pb2.Trajectory:
    """Encode points in time."""
    wire = pose_pb2.Trajectory()
    write_blocks(wire, positions_xz=trajectory.positions_xz, times_s=trajectory.times_s)
    if trajectory.facings_yaw is not None:
        write_blocks(wire, facings_yaw=trajectory.facings_yaw)
    return wire


def decode_trajectory(wire: pose_pb2.Trajectory) -> Trajectory:
    """Decode points in time."""
    return Trajectory(
        read_block(wire, "positions_xz", -1, 2),
        read_block(wire, "times_s"),
        read_block(wire, "facings_yaw") if wire.facings_yaw else None,
    )


def encode_channels(channels: Mapping[str, float]) -> list[pose_pb2.ChannelCost]:
    """Encode costs by channel."""
    return [pose_pb2.ChannelCost(channel=name, cost=cost) for name, cost in channels.items()]


def decode_channels(wire: Iterable[pose_pb2.ChannelCost]) -> dict[str, float]:
    """Decode costs by channel."""
    return {channel.channel: channel.cost for channel in wire}


def encode_library_info(info: LibraryInfo) -> animation_pb2.LibraryInfo:
    """Encode what a library is."""
    return animation_pb2.LibraryInfo(**vars(info))


def decode_library_info(wire: animation_pb2.LibraryInfo) -> LibraryInfo:
    """Decode what a library is."""
    return LibraryInfo(
        name=wire.name,
        content_hash=wire.content_hash,
        clips=wire.clips,
        frames=wire.frames,
        frame_rate_hz=wire.frame_rate_hz,
        synthetic=wire.synthetic,
        licence=wire.licence,
        credit=wire.credit,
        schema=wire.schema,
    )


def encode_limits(limits: Limits) -> animation_pb2.Limits:
    """Encode the limits of a session."""
    return animation_pb2.Limits(**vars(limits))


def decode_limits(wire: animation_pb2.Limits) -> Limits:
    """Decode the limits of a session."""
    return Limits(
        max_characters=wire.max_characters,
        max_dt_s=wire.max_dt_s,
        max_speed=wire.max_speed,
        max_message_bytes=wire.max_message_bytes,
        write_timeout_s=wire.write_timeout_s,
    )
