from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Vector3(_message.Message):
    __slots__ = ("x", "y", "z")
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class GroundPose(_message.Message):
    __slots__ = ("position", "yaw")
    POSITION_FIELD_NUMBER: _ClassVar[int]
    YAW_FIELD_NUMBER: _ClassVar[int]
    position: Vector3
    yaw: float
    def __init__(self, position: _Optional[_Union[Vector3, _Mapping]] = ..., yaw: _Optional[float] = ...) -> None: ...

class Skeleton(_message.Message):
    __slots__ = ("name", "joints", "parents", "offsets")
    NAME_FIELD_NUMBER: _ClassVar[int]
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    PARENTS_FIELD_NUMBER: _ClassVar[int]
    OFFSETS_FIELD_NUMBER: _ClassVar[int]
    name: str
    joints: _containers.RepeatedScalarFieldContainer[str]
    parents: _containers.RepeatedScalarFieldContainer[int]
    offsets: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, name: _Optional[str] = ..., joints: _Optional[_Iterable[str]] = ..., parents: _Optional[_Iterable[int]] = ..., offsets: _Optional[_Iterable[float]] = ...) -> None: ...

class Poses(_message.Message):
    __slots__ = ("frames", "root", "hips", "rotations")
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    ROOT_FIELD_NUMBER: _ClassVar[int]
    HIPS_FIELD_NUMBER: _ClassVar[int]
    ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    frames: int
    root: _containers.RepeatedScalarFieldContainer[float]
    hips: _containers.RepeatedScalarFieldContainer[float]
    rotations: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, frames: _Optional[int] = ..., root: _Optional[_Iterable[float]] = ..., hips: _Optional[_Iterable[float]] = ..., rotations: _Optional[_Iterable[float]] = ...) -> None: ...

class ClipTime(_message.Message):
    __slots__ = ("library", "clip", "time_s")
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    CLIP_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    library: str
    clip: str
    time_s: float
    def __init__(self, library: _Optional[str] = ..., clip: _Optional[str] = ..., time_s: _Optional[float] = ...) -> None: ...

class PoseSource(_message.Message):
    __slots__ = ("clip", "inline")
    CLIP_FIELD_NUMBER: _ClassVar[int]
    INLINE_FIELD_NUMBER: _ClassVar[int]
    clip: ClipTime
    inline: Poses
    def __init__(self, clip: _Optional[_Union[ClipTime, _Mapping]] = ..., inline: _Optional[_Union[Poses, _Mapping]] = ...) -> None: ...

class ClipSource(_message.Message):
    __slots__ = ("span", "inline", "bvh")
    SPAN_FIELD_NUMBER: _ClassVar[int]
    INLINE_FIELD_NUMBER: _ClassVar[int]
    BVH_FIELD_NUMBER: _ClassVar[int]
    span: ClipSpan
    inline: InlineClip
    bvh: str
    def __init__(self, span: _Optional[_Union[ClipSpan, _Mapping]] = ..., inline: _Optional[_Union[InlineClip, _Mapping]] = ..., bvh: _Optional[str] = ...) -> None: ...

class ClipSpan(_message.Message):
    __slots__ = ("library", "clip", "start_s", "end_s")
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    CLIP_FIELD_NUMBER: _ClassVar[int]
    START_S_FIELD_NUMBER: _ClassVar[int]
    END_S_FIELD_NUMBER: _ClassVar[int]
    library: str
    clip: str
    start_s: float
    end_s: float
    def __init__(self, library: _Optional[str] = ..., clip: _Optional[str] = ..., start_s: _Optional[float] = ..., end_s: _Optional[float] = ...) -> None: ...

class InlineClip(_message.Message):
    __slots__ = ("name", "frame_rate_hz", "poses", "skeleton")
    NAME_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    POSES_FIELD_NUMBER: _ClassVar[int]
    SKELETON_FIELD_NUMBER: _ClassVar[int]
    name: str
    frame_rate_hz: float
    poses: Poses
    skeleton: Skeleton
    def __init__(self, name: _Optional[str] = ..., frame_rate_hz: _Optional[float] = ..., poses: _Optional[_Union[Poses, _Mapping]] = ..., skeleton: _Optional[_Union[Skeleton, _Mapping]] = ...) -> None: ...

class Trajectory(_message.Message):
    __slots__ = ("positions_xz", "facings_yaw", "times_s")
    POSITIONS_XZ_FIELD_NUMBER: _ClassVar[int]
    FACINGS_YAW_FIELD_NUMBER: _ClassVar[int]
    TIMES_S_FIELD_NUMBER: _ClassVar[int]
    positions_xz: _containers.RepeatedScalarFieldContainer[float]
    facings_yaw: _containers.RepeatedScalarFieldContainer[float]
    times_s: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, positions_xz: _Optional[_Iterable[float]] = ..., facings_yaw: _Optional[_Iterable[float]] = ..., times_s: _Optional[_Iterable[float]] = ...) -> None: ...

class ChannelCost(_message.Message):
    __slots__ = ("channel", "cost")
    CHANNEL_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    channel: str
    cost: float
    def __init__(self, channel: _Optional[str] = ..., cost: _Optional[float] = ...) -> None: ...

class FieldViolation(_message.Message):
    __slots__ = ("field", "description")
    FIELD_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    field: str
    description: str
    def __init__(self, field: _Optional[str] = ..., description: _Optional[str] = ...) -> None: ...
