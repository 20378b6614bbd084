from stridewire.v1 import pose_pb2 as _pose_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class SearchRequest(_message.Message):
    __slots__ = ("library", "pose", "trajectory", "motion", "filter", "weights", "k", "exclude")
    class WeightsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: float
        def __init__(self, key: _Optional[str] = ..., value: _Optional[float] = ...) -> None: ...
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    TRAJECTORY_FIELD_NUMBER: _ClassVar[int]
    MOTION_FIELD_NUMBER: _ClassVar[int]
    FILTER_FIELD_NUMBER: _ClassVar[int]
    WEIGHTS_FIELD_NUMBER: _ClassVar[int]
    K_FIELD_NUMBER: _ClassVar[int]
    EXCLUDE_FIELD_NUMBER: _ClassVar[int]
    library: str
    pose: _pose_pb2.PoseSource
    trajectory: _pose_pb2.Trajectory
    motion: DesiredMotion
    filter: str
    weights: _containers.ScalarMap[str, float]
    k: int
    exclude: _containers.RepeatedCompositeFieldContainer[_pose_pb2.ClipTime]
    def __init__(self, library: _Optional[str] = ..., pose: _Optional[_Union[_pose_pb2.PoseSource, _Mapping]] = ..., trajectory: _Optional[_Union[_pose_pb2.Trajectory, _Mapping]] = ..., motion: _Optional[_Union[DesiredMotion, _Mapping]] = ..., filter: _Optional[str] = ..., weights: _Optional[_Mapping[str, float]] = ..., k: _Optional[int] = ..., exclude: _Optional[_Iterable[_Union[_pose_pb2.ClipTime, _Mapping]]] = ...) -> None: ...

class DesiredMotion(_message.Message):
    __slots__ = ("velocity_x", "velocity_z", "facing_yaw")
    VELOCITY_X_FIELD_NUMBER: _ClassVar[int]
    VELOCITY_Z_FIELD_NUMBER: _ClassVar[int]
    FACING_YAW_FIELD_NUMBER: _ClassVar[int]
    velocity_x: float
    velocity_z: float
    facing_yaw: float
    def __init__(self, velocity_x: _Optional[float] = ..., velocity_z: _Optional[float] = ..., facing_yaw: _Optional[float] = ...) -> None: ...

class SearchResponse(_message.Message):
    __slots__ = ("matches", "library", "content_hash", "excluded", "exact")
    MATCHES_FIELD_NUMBER: _ClassVar[int]
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    CONTENT_HASH_FIELD_NUMBER: _ClassVar[int]
    EXCLUDED_FIELD_NUMBER: _ClassVar[int]
    EXACT_FIELD_NUMBER: _ClassVar[int]
    matches: _containers.RepeatedCompositeFieldContainer[Match]
    library: str
    content_hash: str
    excluded: _containers.RepeatedCompositeFieldContainer[ExcludedMatch]
    exact: bool
    def __init__(self, matches: _Optional[_Iterable[_Union[Match, _Mapping]]] = ..., library: _Optional[str] = ..., content_hash: _Optional[str] = ..., excluded: _Optional[_Iterable[_Union[ExcludedMatch, _Mapping]]] = ..., exact: bool = ...) -> None: ...

class Match(_message.Message):
    __slots__ = ("clip", "time_s", "tags", "cost", "channels", "bias")
    CLIP_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    TAGS_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    CHANNELS_FIELD_NUMBER: _ClassVar[int]
    BIAS_FIELD_NUMBER: _ClassVar[int]
    clip: str
    time_s: float
    tags: _containers.RepeatedScalarFieldContainer[str]
    cost: float
    channels: _containers.RepeatedCompositeFieldContainer[_pose_pb2.ChannelCost]
    bias: float
    def __init__(self, clip: _Optional[str] = ..., time_s: _Optional[float] = ..., tags: _Optional[_Iterable[str]] = ..., cost: _Optional[float] = ..., channels: _Optional[_Iterable[_Union[_pose_pb2.ChannelCost, _Mapping]]] = ..., bias: _Optional[float] = ...) -> None: ...

class ExcludedMatch(_message.Message):
    __slots__ = ("match", "reason")
    MATCH_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    match: Match
    reason: str
    def __init__(self, match: _Optional[_Union[Match, _Mapping]] = ..., reason: _Optional[str] = ...) -> None: ...
