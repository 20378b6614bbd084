from stridewire.v1 import pose_pb2 as _pose_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class StitchRequest(_message.Message):
    __slots__ = ("clips", "window_s", "shift_s", "passes", "seam_search", "strength", "joint_mask", "stitcher", "search_frames", "start_s", "end_s", "path")
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
    STITCHER_FIELD_NUMBER: _ClassVar[int]
    SEARCH_FRAMES_FIELD_NUMBER: _ClassVar[int]
    START_S_FIELD_NUMBER: _ClassVar[int]
    END_S_FIELD_NUMBER: _ClassVar[int]
    PATH_FIELD_NUMBER: _ClassVar[int]
    clips: _containers.RepeatedCompositeFieldContainer[_pose_pb2.ClipSource]
    window_s: float
    shift_s: float
    passes: int
    seam_search: bool
    strength: float
    joint_mask: _containers.ScalarMap[str, float]
    stitcher: str
    search_frames: int
    start_s: float
    end_s: float
    path: RootPath
    def __init__(self, clips: _Optional[_Iterable[_Union[_pose_pb2.ClipSource, _Mapping]]] = ..., window_s: _Optional[float] = ..., shift_s: _Optional[float] = ..., passes: _Optional[int] = ..., seam_search: bool = ..., strength: _Optional[float] = ..., joint_mask: _Optional[_Mapping[str, float]] = ..., stitcher: _Optional[str] = ..., search_frames: _Optional[int] = ..., start_s: _Optional[float] = ..., end_s: _Optional[float] = ..., path: _Optional[_Union[RootPath, _Mapping]] = ...) -> None: ...

class RootPath(_message.Message):
    __slots__ = ("positions_xz", "facings_yaw", "times_s")
    POSITIONS_XZ_FIELD_NUMBER: _ClassVar[int]
    FACINGS_YAW_FIELD_NUMBER: _ClassVar[int]
    TIMES_S_FIELD_NUMBER: _ClassVar[int]
    positions_xz: _containers.RepeatedScalarFieldContainer[float]
    facings_yaw: _containers.RepeatedScalarFieldContainer[float]
    times_s: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, positions_xz: _Optional[_Iterable[float]] = ..., facings_yaw: _Optional[_Iterable[float]] = ..., times_s: _Optional[_Iterable[float]] = ...) -> None: ...

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
    __slots__ = ("seams", "methods", "reasons", "cut_before", "cut_after", "before", "after", "elsewhere", "changed_frames", "window_s", "models", "version")
    class ModelsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: str
        def __init__(self, key: _Optional[str] = ..., value: _Optional[str] = ...) -> None: ...
    SEAMS_FIELD_NUMBER: _ClassVar[int]
    METHODS_FIELD_NUMBER: _ClassVar[int]
    REASONS_FIELD_NUMBER: _ClassVar[int]
    CUT_BEFORE_FIELD_NUMBER: _ClassVar[int]
    CUT_AFTER_FIELD_NUMBER: _ClassVar[int]
    BEFORE_FIELD_NUMBER: _ClassVar[int]
    AFTER_FIELD_NUMBER: _ClassVar[int]
    ELSEWHERE_FIELD_NUMBER: _ClassVar[int]
    CHANGED_FRAMES_FIELD_NUMBER: _ClassVar[int]
    WINDOW_S_FIELD_NUMBER: _ClassVar[int]
    MODELS_FIELD_NUMBER: _ClassVar[int]
    VERSION_FIELD_NUMBER: _ClassVar[int]
    seams: _containers.RepeatedScalarFieldContainer[int]
    methods: _containers.RepeatedScalarFieldContainer[str]
    reasons: _containers.RepeatedScalarFieldContainer[str]
    cut_before: _containers.RepeatedScalarFieldContainer[int]
    cut_after: _containers.RepeatedScalarFieldContainer[int]
    before: MotionFigures
    after: MotionFigures
    elsewhere: MotionFigures
    changed_frames: int
    window_s: float
    models: _containers.ScalarMap[str, str]
    version: str
    def __init__(self, seams: _Optional[_Iterable[int]] = ..., methods: _Optional[_Iterable[str]] = ..., reasons: _Optional[_Iterable[str]] = ..., cut_before: _Optional[_Iterable[int]] = ..., cut_after: _Optional[_Iterable[int]] = ..., before: _Optional[_Union[MotionFigures, _Mapping]] = ..., after: _Optional[_Union[MotionFigures, _Mapping]] = ..., elsewhere: _Optional[_Union[MotionFigures, _Mapping]] = ..., changed_frames: _Optional[int] = ..., window_s: _Optional[float] = ..., models: _Optional[_Mapping[str, str]] = ..., version: _Optional[str] = ...) -> None: ...

class MotionFigures(_message.Message):
    __slots__ = ("sliding_c_cm_s", "sliding_a_cm_s", "toe_jerk", "knee_jerk", "seam_step_cm_s")
    SLIDING_C_CM_S_FIELD_NUMBER: _ClassVar[int]
    SLIDING_A_CM_S_FIELD_NUMBER: _ClassVar[int]
    TOE_JERK_FIELD_NUMBER: _ClassVar[int]
    KNEE_JERK_FIELD_NUMBER: _ClassVar[int]
    SEAM_STEP_CM_S_FIELD_NUMBER: _ClassVar[int]
    sliding_c_cm_s: float
    sliding_a_cm_s: float
    toe_jerk: float
    knee_jerk: float
    seam_step_cm_s: float
    def __init__(self, sliding_c_cm_s: _Optional[float] = ..., sliding_a_cm_s: _Optional[float] = ..., toe_jerk: _Optional[float] = ..., knee_jerk: _Optional[float] = ..., seam_step_cm_s: _Optional[float] = ...) -> None: ...
