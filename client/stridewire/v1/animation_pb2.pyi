from google.protobuf import field_mask_pb2 as _field_mask_pb2
from stridewire.v1 import match_pb2 as _match_pb2
from stridewire.v1 import pose_pb2 as _pose_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Pacing(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    PACING_UNSPECIFIED: _ClassVar[Pacing]
    PACING_CLIENT: _ClassVar[Pacing]
    PACING_SERVER: _ClassVar[Pacing]

class PoseFormat(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    POSE_FORMAT_UNSPECIFIED: _ClassVar[PoseFormat]
    POSE_FORMAT_F32: _ClassVar[PoseFormat]
    POSE_FORMAT_F16: _ClassVar[PoseFormat]

class Detail(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    DETAIL_UNSPECIFIED: _ClassVar[Detail]
    DETAIL_NONE: _ClassVar[Detail]
    DETAIL_EVENTS: _ClassVar[Detail]
    DETAIL_COSTS: _ClassVar[Detail]
    DETAIL_INSIDE: _ClassVar[Detail]

class CorrectionMode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CORRECTION_MODE_UNSPECIFIED: _ClassVar[CorrectionMode]
    CORRECTION_MODE_ADJUST: _ClassVar[CorrectionMode]
    CORRECTION_MODE_TELEPORT: _ClassVar[CorrectionMode]

class FrameFlag(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    FRAME_FLAG_UNSPECIFIED: _ClassVar[FrameFlag]
    FRAME_FLAG_DT_CLAMPED: _ClassVar[FrameFlag]
    FRAME_FLAG_DEGRADED: _ClassVar[FrameFlag]
    FRAME_FLAG_HELD: _ClassVar[FrameFlag]
    FRAME_FLAG_FALLBACK: _ClassVar[FrameFlag]
    FRAME_FLAG_TELEPORTED: _ClassVar[FrameFlag]

class TransitionReason(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    TRANSITION_REASON_UNSPECIFIED: _ClassVar[TransitionReason]
    TRANSITION_REASON_BETTER_MATCH: _ClassVar[TransitionReason]
    TRANSITION_REASON_CONTROL_CHANGE: _ClassVar[TransitionReason]
    TRANSITION_REASON_CLIP_END: _ClassVar[TransitionReason]
    TRANSITION_REASON_FORCED: _ClassVar[TransitionReason]
    TRANSITION_REASON_START: _ClassVar[TransitionReason]
    TRANSITION_REASON_FILTER_CHANGE: _ClassVar[TransitionReason]

class FallbackReason(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    FALLBACK_REASON_UNSPECIFIED: _ClassVar[FallbackReason]
    FALLBACK_REASON_NO_NETWORK: _ClassVar[FallbackReason]
    FALLBACK_REASON_OTHER_SKELETON: _ClassVar[FallbackReason]
    FALLBACK_REASON_OTHER_RATE: _ClassVar[FallbackReason]
    FALLBACK_REASON_TOO_FEW_FRAMES: _ClassVar[FallbackReason]
    FALLBACK_REASON_BUSY: _ClassVar[FallbackReason]
    FALLBACK_REASON_UNLIKE_TRAINING: _ClassVar[FallbackReason]

class NoticeKind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    NOTICE_KIND_UNSPECIFIED: _ClassVar[NoticeKind]
    NOTICE_KIND_DRAINING: _ClassVar[NoticeKind]
    NOTICE_KIND_DEGRADED: _ClassVar[NoticeKind]
    NOTICE_KIND_RECOVERED: _ClassVar[NoticeKind]
PACING_UNSPECIFIED: Pacing
PACING_CLIENT: Pacing
PACING_SERVER: Pacing
POSE_FORMAT_UNSPECIFIED: PoseFormat
POSE_FORMAT_F32: PoseFormat
POSE_FORMAT_F16: PoseFormat
DETAIL_UNSPECIFIED: Detail
DETAIL_NONE: Detail
DETAIL_EVENTS: Detail
DETAIL_COSTS: Detail
DETAIL_INSIDE: Detail
CORRECTION_MODE_UNSPECIFIED: CorrectionMode
CORRECTION_MODE_ADJUST: CorrectionMode
CORRECTION_MODE_TELEPORT: CorrectionMode
FRAME_FLAG_UNSPECIFIED: FrameFlag
FRAME_FLAG_DT_CLAMPED: FrameFlag
FRAME_FLAG_DEGRADED: FrameFlag
FRAME_FLAG_HELD: FrameFlag
FRAME_FLAG_FALLBACK: FrameFlag
FRAME_FLAG_TELEPORTED: FrameFlag
TRANSITION_REASON_UNSPECIFIED: TransitionReason
TRANSITION_REASON_BETTER_MATCH: TransitionReason
TRANSITION_REASON_CONTROL_CHANGE: TransitionReason
TRANSITION_REASON_CLIP_END: TransitionReason
TRANSITION_REASON_FORCED: TransitionReason
TRANSITION_REASON_START: TransitionReason
TRANSITION_REASON_FILTER_CHANGE: TransitionReason
FALLBACK_REASON_UNSPECIFIED: FallbackReason
FALLBACK_REASON_NO_NETWORK: FallbackReason
FALLBACK_REASON_OTHER_SKELETON: FallbackReason
FALLBACK_REASON_OTHER_RATE: FallbackReason
FALLBACK_REASON_TOO_FEW_FRAMES: FallbackReason
FALLBACK_REASON_BUSY: FallbackReason
FALLBACK_REASON_UNLIKE_TRAINING: FallbackReason
NOTICE_KIND_UNSPECIFIED: NoticeKind
NOTICE_KIND_DRAINING: NoticeKind
NOTICE_KIND_DEGRADED: NoticeKind
NOTICE_KIND_RECOVERED: NoticeKind

class AnimateRequest(_message.Message):
    __slots__ = ("open", "step", "edit", "close")
    OPEN_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    EDIT_FIELD_NUMBER: _ClassVar[int]
    CLOSE_FIELD_NUMBER: _ClassVar[int]
    open: Open
    step: Step
    edit: Edit
    close: Close
    def __init__(self, open: _Optional[_Union[Open, _Mapping]] = ..., step: _Optional[_Union[Step, _Mapping]] = ..., edit: _Optional[_Union[Edit, _Mapping]] = ..., close: _Optional[_Union[Close, _Mapping]] = ...) -> None: ...

class AnimateResponse(_message.Message):
    __slots__ = ("opened", "frame", "error", "notice")
    OPENED_FIELD_NUMBER: _ClassVar[int]
    FRAME_FIELD_NUMBER: _ClassVar[int]
    ERROR_FIELD_NUMBER: _ClassVar[int]
    NOTICE_FIELD_NUMBER: _ClassVar[int]
    opened: Opened
    frame: Frame
    error: Error
    notice: Notice
    def __init__(self, opened: _Optional[_Union[Opened, _Mapping]] = ..., frame: _Optional[_Union[Frame, _Mapping]] = ..., error: _Optional[_Union[Error, _Mapping]] = ..., notice: _Optional[_Union[Notice, _Mapping]] = ...) -> None: ...

class Open(_message.Message):
    __slots__ = ("library", "pacing", "rate_hz", "characters", "output_skeleton", "format", "max_frames_in_flight", "detail", "seed", "resume_token")
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    PACING_FIELD_NUMBER: _ClassVar[int]
    RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    OUTPUT_SKELETON_FIELD_NUMBER: _ClassVar[int]
    FORMAT_FIELD_NUMBER: _ClassVar[int]
    MAX_FRAMES_IN_FLIGHT_FIELD_NUMBER: _ClassVar[int]
    DETAIL_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    RESUME_TOKEN_FIELD_NUMBER: _ClassVar[int]
    library: str
    pacing: Pacing
    rate_hz: float
    characters: _containers.RepeatedCompositeFieldContainer[CharacterSpec]
    output_skeleton: _pose_pb2.Skeleton
    format: PoseFormat
    max_frames_in_flight: int
    detail: Detail
    seed: int
    resume_token: str
    def __init__(self, library: _Optional[str] = ..., pacing: _Optional[_Union[Pacing, str]] = ..., rate_hz: _Optional[float] = ..., characters: _Optional[_Iterable[_Union[CharacterSpec, _Mapping]]] = ..., output_skeleton: _Optional[_Union[_pose_pb2.Skeleton, _Mapping]] = ..., format: _Optional[_Union[PoseFormat, str]] = ..., max_frames_in_flight: _Optional[int] = ..., detail: _Optional[_Union[Detail, str]] = ..., seed: _Optional[int] = ..., resume_token: _Optional[str] = ...) -> None: ...

class CharacterSpec(_message.Message):
    __slots__ = ("id", "root", "height_m", "stitcher", "filter", "weights", "responsiveness", "foot_lock", "rate_divider")
    class WeightsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: float
        def __init__(self, key: _Optional[str] = ..., value: _Optional[float] = ...) -> None: ...
    ID_FIELD_NUMBER: _ClassVar[int]
    ROOT_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_M_FIELD_NUMBER: _ClassVar[int]
    STITCHER_FIELD_NUMBER: _ClassVar[int]
    FILTER_FIELD_NUMBER: _ClassVar[int]
    WEIGHTS_FIELD_NUMBER: _ClassVar[int]
    RESPONSIVENESS_FIELD_NUMBER: _ClassVar[int]
    FOOT_LOCK_FIELD_NUMBER: _ClassVar[int]
    RATE_DIVIDER_FIELD_NUMBER: _ClassVar[int]
    id: int
    root: _pose_pb2.GroundPose
    height_m: float
    stitcher: str
    filter: str
    weights: _containers.ScalarMap[str, float]
    responsiveness: float
    foot_lock: bool
    rate_divider: int
    def __init__(self, id: _Optional[int] = ..., root: _Optional[_Union[_pose_pb2.GroundPose, _Mapping]] = ..., height_m: _Optional[float] = ..., stitcher: _Optional[str] = ..., filter: _Optional[str] = ..., weights: _Optional[_Mapping[str, float]] = ..., responsiveness: _Optional[float] = ..., foot_lock: bool = ..., rate_divider: _Optional[int] = ...) -> None: ...

class Step(_message.Message):
    __slots__ = ("step", "dt_s", "last_frame", "client_time_s", "characters", "velocity_xz", "facing_yaw", "sparse", "ack_only")
    STEP_FIELD_NUMBER: _ClassVar[int]
    DT_S_FIELD_NUMBER: _ClassVar[int]
    LAST_FRAME_FIELD_NUMBER: _ClassVar[int]
    CLIENT_TIME_S_FIELD_NUMBER: _ClassVar[int]
    CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    VELOCITY_XZ_FIELD_NUMBER: _ClassVar[int]
    FACING_YAW_FIELD_NUMBER: _ClassVar[int]
    SPARSE_FIELD_NUMBER: _ClassVar[int]
    ACK_ONLY_FIELD_NUMBER: _ClassVar[int]
    step: int
    dt_s: float
    last_frame: int
    client_time_s: float
    characters: _containers.RepeatedScalarFieldContainer[int]
    velocity_xz: _containers.RepeatedScalarFieldContainer[float]
    facing_yaw: _containers.RepeatedScalarFieldContainer[float]
    sparse: _containers.RepeatedCompositeFieldContainer[Sparse]
    ack_only: bool
    def __init__(self, step: _Optional[int] = ..., dt_s: _Optional[float] = ..., last_frame: _Optional[int] = ..., client_time_s: _Optional[float] = ..., characters: _Optional[_Iterable[int]] = ..., velocity_xz: _Optional[_Iterable[float]] = ..., facing_yaw: _Optional[_Iterable[float]] = ..., sparse: _Optional[_Iterable[_Union[Sparse, _Mapping]]] = ..., ack_only: bool = ...) -> None: ...

class RootCorrection(_message.Message):
    __slots__ = ("root", "mode")
    ROOT_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    root: _pose_pb2.GroundPose
    mode: CorrectionMode
    def __init__(self, root: _Optional[_Union[_pose_pb2.GroundPose, _Mapping]] = ..., mode: _Optional[_Union[CorrectionMode, str]] = ...) -> None: ...

class Ground(_message.Message):
    __slots__ = ("height", "normal", "foot_heights", "foot_normals")
    HEIGHT_FIELD_NUMBER: _ClassVar[int]
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    FOOT_HEIGHTS_FIELD_NUMBER: _ClassVar[int]
    FOOT_NORMALS_FIELD_NUMBER: _ClassVar[int]
    height: float
    normal: _pose_pb2.Vector3
    foot_heights: _containers.RepeatedScalarFieldContainer[float]
    foot_normals: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, height: _Optional[float] = ..., normal: _Optional[_Union[_pose_pb2.Vector3, _Mapping]] = ..., foot_heights: _Optional[_Iterable[float]] = ..., foot_normals: _Optional[_Iterable[float]] = ...) -> None: ...

class Sparse(_message.Message):
    __slots__ = ("character", "trajectory", "filter", "gait", "root_correction", "ground", "force_search")
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    TRAJECTORY_FIELD_NUMBER: _ClassVar[int]
    FILTER_FIELD_NUMBER: _ClassVar[int]
    GAIT_FIELD_NUMBER: _ClassVar[int]
    ROOT_CORRECTION_FIELD_NUMBER: _ClassVar[int]
    GROUND_FIELD_NUMBER: _ClassVar[int]
    FORCE_SEARCH_FIELD_NUMBER: _ClassVar[int]
    character: int
    trajectory: _pose_pb2.Trajectory
    filter: str
    gait: str
    root_correction: RootCorrection
    ground: Ground
    force_search: bool
    def __init__(self, character: _Optional[int] = ..., trajectory: _Optional[_Union[_pose_pb2.Trajectory, _Mapping]] = ..., filter: _Optional[str] = ..., gait: _Optional[str] = ..., root_correction: _Optional[_Union[RootCorrection, _Mapping]] = ..., ground: _Optional[_Union[Ground, _Mapping]] = ..., force_search: bool = ...) -> None: ...

class Edit(_message.Message):
    __slots__ = ("add", "remove", "update")
    ADD_FIELD_NUMBER: _ClassVar[int]
    REMOVE_FIELD_NUMBER: _ClassVar[int]
    UPDATE_FIELD_NUMBER: _ClassVar[int]
    add: _containers.RepeatedCompositeFieldContainer[CharacterSpec]
    remove: _containers.RepeatedScalarFieldContainer[int]
    update: _containers.RepeatedCompositeFieldContainer[CharacterUpdate]
    def __init__(self, add: _Optional[_Iterable[_Union[CharacterSpec, _Mapping]]] = ..., remove: _Optional[_Iterable[int]] = ..., update: _Optional[_Iterable[_Union[CharacterUpdate, _Mapping]]] = ...) -> None: ...

class CharacterUpdate(_message.Message):
    __slots__ = ("spec", "mask")
    SPEC_FIELD_NUMBER: _ClassVar[int]
    MASK_FIELD_NUMBER: _ClassVar[int]
    spec: CharacterSpec
    mask: _field_mask_pb2.FieldMask
    def __init__(self, spec: _Optional[_Union[CharacterSpec, _Mapping]] = ..., mask: _Optional[_Union[_field_mask_pb2.FieldMask, _Mapping]] = ...) -> None: ...

class Close(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Opened(_message.Message):
    __slots__ = ("session", "resume_token", "skeleton", "library", "server_version", "models", "settings", "limits")
    class ModelsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: str
        def __init__(self, key: _Optional[str] = ..., value: _Optional[str] = ...) -> None: ...
    SESSION_FIELD_NUMBER: _ClassVar[int]
    RESUME_TOKEN_FIELD_NUMBER: _ClassVar[int]
    SKELETON_FIELD_NUMBER: _ClassVar[int]
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    SERVER_VERSION_FIELD_NUMBER: _ClassVar[int]
    MODELS_FIELD_NUMBER: _ClassVar[int]
    SETTINGS_FIELD_NUMBER: _ClassVar[int]
    LIMITS_FIELD_NUMBER: _ClassVar[int]
    session: str
    resume_token: str
    skeleton: _pose_pb2.Skeleton
    library: LibraryInfo
    server_version: str
    models: _containers.ScalarMap[str, str]
    settings: Settings
    limits: Limits
    def __init__(self, session: _Optional[str] = ..., resume_token: _Optional[str] = ..., skeleton: _Optional[_Union[_pose_pb2.Skeleton, _Mapping]] = ..., library: _Optional[_Union[LibraryInfo, _Mapping]] = ..., server_version: _Optional[str] = ..., models: _Optional[_Mapping[str, str]] = ..., settings: _Optional[_Union[Settings, _Mapping]] = ..., limits: _Optional[_Union[Limits, _Mapping]] = ...) -> None: ...

class LibraryInfo(_message.Message):
    __slots__ = ("name", "content_hash", "clips", "frames", "frame_rate_hz", "synthetic", "licence", "credit", "schema")
    NAME_FIELD_NUMBER: _ClassVar[int]
    CONTENT_HASH_FIELD_NUMBER: _ClassVar[int]
    CLIPS_FIELD_NUMBER: _ClassVar[int]
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    SYNTHETIC_FIELD_NUMBER: _ClassVar[int]
    LICENCE_FIELD_NUMBER: _ClassVar[int]
    CREDIT_FIELD_NUMBER: _ClassVar[int]
    SCHEMA_FIELD_NUMBER: _ClassVar[int]
    name: str
    content_hash: str
    clips: int
    frames: int
    frame_rate_hz: float
    synthetic: bool
    licence: str
    credit: str
    schema: str
    def __init__(self, name: _Optional[str] = ..., content_hash: _Optional[str] = ..., clips: _Optional[int] = ..., frames: _Optional[int] = ..., frame_rate_hz: _Optional[float] = ..., synthetic: bool = ..., licence: _Optional[str] = ..., credit: _Optional[str] = ..., schema: _Optional[str] = ...) -> None: ...

class Settings(_message.Message):
    __slots__ = ("pacing", "rate_hz", "max_frames_in_flight", "format", "detail", "seed", "default_stitcher")
    PACING_FIELD_NUMBER: _ClassVar[int]
    RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    MAX_FRAMES_IN_FLIGHT_FIELD_NUMBER: _ClassVar[int]
    FORMAT_FIELD_NUMBER: _ClassVar[int]
    DETAIL_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    DEFAULT_STITCHER_FIELD_NUMBER: _ClassVar[int]
    pacing: Pacing
    rate_hz: float
    max_frames_in_flight: int
    format: PoseFormat
    detail: Detail
    seed: int
    default_stitcher: str
    def __init__(self, pacing: _Optional[_Union[Pacing, str]] = ..., rate_hz: _Optional[float] = ..., max_frames_in_flight: _Optional[int] = ..., format: _Optional[_Union[PoseFormat, str]] = ..., detail: _Optional[_Union[Detail, str]] = ..., seed: _Optional[int] = ..., default_stitcher: _Optional[str] = ...) -> None: ...

class Limits(_message.Message):
    __slots__ = ("max_characters", "max_dt_s", "max_speed", "max_message_bytes", "write_timeout_s")
    MAX_CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    MAX_DT_S_FIELD_NUMBER: _ClassVar[int]
    MAX_SPEED_FIELD_NUMBER: _ClassVar[int]
    MAX_MESSAGE_BYTES_FIELD_NUMBER: _ClassVar[int]
    WRITE_TIMEOUT_S_FIELD_NUMBER: _ClassVar[int]
    max_characters: int
    max_dt_s: float
    max_speed: float
    max_message_bytes: int
    write_timeout_s: float
    def __init__(self, max_characters: _Optional[int] = ..., max_dt_s: _Optional[float] = ..., max_speed: _Optional[float] = ..., max_message_bytes: _Optional[int] = ..., write_timeout_s: _Optional[float] = ...) -> None: ...

class Frame(_message.Message):
    __slots__ = ("frame", "applied_step", "time_s", "client_time_s", "characters", "root", "root_delta", "hips", "rotations", "contacts", "foot_targets", "simulated_root", "events", "flags", "dropped", "timings", "root_f16", "root_delta_f16", "hips_f16", "rotations_f16", "ahead_s", "predicted", "captured", "sampled_hips", "sampled_rotations", "searches")
    FRAME_FIELD_NUMBER: _ClassVar[int]
    APPLIED_STEP_FIELD_NUMBER: _ClassVar[int]
    TIME_S_FIELD_NUMBER: _ClassVar[int]
    CLIENT_TIME_S_FIELD_NUMBER: _ClassVar[int]
    CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    ROOT_FIELD_NUMBER: _ClassVar[int]
    ROOT_DELTA_FIELD_NUMBER: _ClassVar[int]
    HIPS_FIELD_NUMBER: _ClassVar[int]
    ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    CONTACTS_FIELD_NUMBER: _ClassVar[int]
    FOOT_TARGETS_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_ROOT_FIELD_NUMBER: _ClassVar[int]
    EVENTS_FIELD_NUMBER: _ClassVar[int]
    FLAGS_FIELD_NUMBER: _ClassVar[int]
    DROPPED_FIELD_NUMBER: _ClassVar[int]
    TIMINGS_FIELD_NUMBER: _ClassVar[int]
    ROOT_F16_FIELD_NUMBER: _ClassVar[int]
    ROOT_DELTA_F16_FIELD_NUMBER: _ClassVar[int]
    HIPS_F16_FIELD_NUMBER: _ClassVar[int]
    ROTATIONS_F16_FIELD_NUMBER: _ClassVar[int]
    AHEAD_S_FIELD_NUMBER: _ClassVar[int]
    PREDICTED_FIELD_NUMBER: _ClassVar[int]
    CAPTURED_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_HIPS_FIELD_NUMBER: _ClassVar[int]
    SAMPLED_ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    SEARCHES_FIELD_NUMBER: _ClassVar[int]
    frame: int
    applied_step: int
    time_s: float
    client_time_s: float
    characters: _containers.RepeatedScalarFieldContainer[int]
    root: _containers.RepeatedScalarFieldContainer[float]
    root_delta: _containers.RepeatedScalarFieldContainer[float]
    hips: _containers.RepeatedScalarFieldContainer[float]
    rotations: _containers.RepeatedScalarFieldContainer[float]
    contacts: _containers.RepeatedScalarFieldContainer[int]
    foot_targets: _containers.RepeatedScalarFieldContainer[float]
    simulated_root: _containers.RepeatedScalarFieldContainer[float]
    events: _containers.RepeatedCompositeFieldContainer[Event]
    flags: _containers.RepeatedScalarFieldContainer[int]
    dropped: int
    timings: _containers.RepeatedCompositeFieldContainer[StageTiming]
    root_f16: bytes
    root_delta_f16: bytes
    hips_f16: bytes
    rotations_f16: bytes
    ahead_s: _containers.RepeatedScalarFieldContainer[float]
    predicted: _containers.RepeatedScalarFieldContainer[float]
    captured: _containers.RepeatedScalarFieldContainer[float]
    sampled_hips: _containers.RepeatedScalarFieldContainer[float]
    sampled_rotations: _containers.RepeatedScalarFieldContainer[float]
    searches: int
    def __init__(self, frame: _Optional[int] = ..., applied_step: _Optional[int] = ..., time_s: _Optional[float] = ..., client_time_s: _Optional[float] = ..., characters: _Optional[_Iterable[int]] = ..., root: _Optional[_Iterable[float]] = ..., root_delta: _Optional[_Iterable[float]] = ..., hips: _Optional[_Iterable[float]] = ..., rotations: _Optional[_Iterable[float]] = ..., contacts: _Optional[_Iterable[int]] = ..., foot_targets: _Optional[_Iterable[float]] = ..., simulated_root: _Optional[_Iterable[float]] = ..., events: _Optional[_Iterable[_Union[Event, _Mapping]]] = ..., flags: _Optional[_Iterable[int]] = ..., dropped: _Optional[int] = ..., timings: _Optional[_Iterable[_Union[StageTiming, _Mapping]]] = ..., root_f16: _Optional[bytes] = ..., root_delta_f16: _Optional[bytes] = ..., hips_f16: _Optional[bytes] = ..., rotations_f16: _Optional[bytes] = ..., ahead_s: _Optional[_Iterable[float]] = ..., predicted: _Optional[_Iterable[float]] = ..., captured: _Optional[_Iterable[float]] = ..., sampled_hips: _Optional[_Iterable[float]] = ..., sampled_rotations: _Optional[_Iterable[float]] = ..., searches: _Optional[int] = ...) -> None: ...

class Event(_message.Message):
    __slots__ = ("character", "frame", "transition", "contact", "clip_end", "tag_entered")
    CHARACTER_FIELD_NUMBER: _ClassVar[int]
    FRAME_FIELD_NUMBER: _ClassVar[int]
    TRANSITION_FIELD_NUMBER: _ClassVar[int]
    CONTACT_FIELD_NUMBER: _ClassVar[int]
    CLIP_END_FIELD_NUMBER: _ClassVar[int]
    TAG_ENTERED_FIELD_NUMBER: _ClassVar[int]
    character: int
    frame: int
    transition: Transition
    contact: ContactChange
    clip_end: ClipEnd
    tag_entered: TagEntered
    def __init__(self, character: _Optional[int] = ..., frame: _Optional[int] = ..., transition: _Optional[_Union[Transition, _Mapping]] = ..., contact: _Optional[_Union[ContactChange, _Mapping]] = ..., clip_end: _Optional[_Union[ClipEnd, _Mapping]] = ..., tag_entered: _Optional[_Union[TagEntered, _Mapping]] = ...) -> None: ...

class Transition(_message.Message):
    __slots__ = ("to", "cost", "stay_cost", "channels", "reason", "bias", "runners_up", "excluded", "fallback", "refined_frames")
    FROM_FIELD_NUMBER: _ClassVar[int]
    TO_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    STAY_COST_FIELD_NUMBER: _ClassVar[int]
    CHANNELS_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    BIAS_FIELD_NUMBER: _ClassVar[int]
    RUNNERS_UP_FIELD_NUMBER: _ClassVar[int]
    EXCLUDED_FIELD_NUMBER: _ClassVar[int]
    FALLBACK_FIELD_NUMBER: _ClassVar[int]
    REFINED_FRAMES_FIELD_NUMBER: _ClassVar[int]
    to: _pose_pb2.ClipTime
    cost: float
    stay_cost: float
    channels: _containers.RepeatedCompositeFieldContainer[_pose_pb2.ChannelCost]
    reason: TransitionReason
    bias: float
    runners_up: _containers.RepeatedCompositeFieldContainer[_match_pb2.Match]
    excluded: _containers.RepeatedCompositeFieldContainer[_match_pb2.ExcludedMatch]
    fallback: FallbackReason
    refined_frames: int
    def __init__(self, to: _Optional[_Union[_pose_pb2.ClipTime, _Mapping]] = ..., cost: _Optional[float] = ..., stay_cost: _Optional[float] = ..., channels: _Optional[_Iterable[_Union[_pose_pb2.ChannelCost, _Mapping]]] = ..., reason: _Optional[_Union[TransitionReason, str]] = ..., bias: _Optional[float] = ..., runners_up: _Optional[_Iterable[_Union[_match_pb2.Match, _Mapping]]] = ..., excluded: _Optional[_Iterable[_Union[_match_pb2.ExcludedMatch, _Mapping]]] = ..., fallback: _Optional[_Union[FallbackReason, str]] = ..., refined_frames: _Optional[int] = ..., **kwargs) -> None: ...

class ContactChange(_message.Message):
    __slots__ = ("joint", "planted")
    JOINT_FIELD_NUMBER: _ClassVar[int]
    PLANTED_FIELD_NUMBER: _ClassVar[int]
    joint: int
    planted: bool
    def __init__(self, joint: _Optional[int] = ..., planted: bool = ...) -> None: ...

class ClipEnd(_message.Message):
    __slots__ = ("clip",)
    CLIP_FIELD_NUMBER: _ClassVar[int]
    clip: str
    def __init__(self, clip: _Optional[str] = ...) -> None: ...

class TagEntered(_message.Message):
    __slots__ = ("tag",)
    TAG_FIELD_NUMBER: _ClassVar[int]
    tag: str
    def __init__(self, tag: _Optional[str] = ...) -> None: ...

class StageTiming(_message.Message):
    __slots__ = ("stage", "elapsed_ms")
    STAGE_FIELD_NUMBER: _ClassVar[int]
    ELAPSED_MS_FIELD_NUMBER: _ClassVar[int]
    stage: str
    elapsed_ms: float
    def __init__(self, stage: _Optional[str] = ..., elapsed_ms: _Optional[float] = ...) -> None: ...

class Error(_message.Message):
    __slots__ = ("step", "violations", "more")
    STEP_FIELD_NUMBER: _ClassVar[int]
    VIOLATIONS_FIELD_NUMBER: _ClassVar[int]
    MORE_FIELD_NUMBER: _ClassVar[int]
    step: int
    violations: _containers.RepeatedCompositeFieldContainer[_pose_pb2.FieldViolation]
    more: int
    def __init__(self, step: _Optional[int] = ..., violations: _Optional[_Iterable[_Union[_pose_pb2.FieldViolation, _Mapping]]] = ..., more: _Optional[int] = ...) -> None: ...

class Notice(_message.Message):
    __slots__ = ("kind", "message", "deadline_s", "resume_token")
    KIND_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    DEADLINE_S_FIELD_NUMBER: _ClassVar[int]
    RESUME_TOKEN_FIELD_NUMBER: _ClassVar[int]
    kind: NoticeKind
    message: str
    deadline_s: float
    resume_token: str
    def __init__(self, kind: _Optional[_Union[NoticeKind, str]] = ..., message: _Optional[str] = ..., deadline_s: _Optional[float] = ..., resume_token: _Optional[str] = ...) -> None: ...
