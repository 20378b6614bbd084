from stridewire.v1 import pose_pb2 as _pose_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class StitchRequest(_message.Message):
    __slots__ = ("clips", "window_s", "shift_s", "passes", "seam_search", "strength", "joint_mask")
    class JointMaskEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: float
        def __init__(self, key: _Optional[str] = ..., value: _Optional[float] = ...) -> None: ...
    CLIPS_FIELD_NUMBER: _ClassVar[int]
    WINDOW_S_FIELD_NUMBER: _ClassVar[int]
    SHIFT_S_FIELD_NUMBER: _ClassVar[int]
    PASSES_FIELD_NUMBER: _ClassVar[int]
    SEAM_SEARCH_FIELD_NUMBER: _ClassVar[int]
    STRENGTH_FIELD_NUMBER: _ClassVar[int]
    JOINT_MASK_FIELD_NUMBER: _ClassVar[int]
    clips: _containers.RepeatedCompositeFieldContainer[_pose_pb2.ClipSource]
    window_s: float
    shift_s: float
    passes: int
    seam_search: bool
    strength: float
    joint_mask: _containers.ScalarMap[str, float]
    def __init__(self, clips: _Optional[_Iterable[_Union[_pose_pb2.ClipSource, _Mapping]]] = ..., window_s: _Optional[float] = ..., shift_s: _Optional[float] = ..., passes: _Optional[int] = ..., seam_search: bool = ..., strength: _Optional[float] = ..., joint_mask: _Optional[_Mapping[str, float]] = ...) -> None: ...

class StitchResponse(_message.Message):
    __slots__ = ("header", "poses", "report")
    HEADER_FIELD_NUMBER: _ClassVar[int]
    POSES_FIELD_NUMBER: _ClassVar[int]
    REPORT_FIELD_NUMBER: _ClassVar[int]
    header: StitchHeader
    poses: _pose_pb2.Poses
    report: StitchReport
    def __init__(self, header: _Optional[_Union[StitchHeader, _Mapping]] = ..., poses: _Optional[_Union[_pose_pb2.Poses, _Mapping]] = ..., report: _Optional[_Union[StitchReport, _Mapping]] = ...) -> None: ...

class StitchHeader(_message.Message):
    __slots__ = ("skeleton", "frame_rate_hz", "frames")
    SKELETON_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    skeleton: _pose_pb2.Skeleton
    frame_rate_hz: float
    frames: int
    def __init__(self, skeleton: _Optional[_Union[_pose_pb2.Skeleton, _Mapping]] = ..., frame_rate_hz: _Optional[float] = ..., frames: _Optional[int] = ...) -> None: ...

class StitchReport(_message.Message):
    __slots__ = ("seams", "methods")
    SEAMS_FIELD_NUMBER: _ClassVar[int]
    METHODS_FIELD_NUMBER: _ClassVar[int]
    seams: _containers.RepeatedScalarFieldContainer[int]
    methods: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, seams: _Optional[_Iterable[int]] = ..., methods: _Optional[_Iterable[str]] = ...) -> None: ...
