from stridewire.v1 import animation_pb2 as _animation_pb2
from stridewire.v1 import pose_pb2 as _pose_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class ListLibrariesRequest(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class ListLibrariesResponse(_message.Message):
    __slots__ = ("libraries",)
    LIBRARIES_FIELD_NUMBER: _ClassVar[int]
    libraries: _containers.RepeatedCompositeFieldContainer[_animation_pb2.LibraryInfo]
    def __init__(self, libraries: _Optional[_Iterable[_Union[_animation_pb2.LibraryInfo, _Mapping]]] = ...) -> None: ...

class GetLibraryRequest(_message.Message):
    __slots__ = ("name",)
    NAME_FIELD_NUMBER: _ClassVar[int]
    name: str
    def __init__(self, name: _Optional[str] = ...) -> None: ...

class GetLibraryResponse(_message.Message):
    __slots__ = ("library", "seconds_by_tag")
    class SecondsByTagEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: float
        def __init__(self, key: _Optional[str] = ..., value: _Optional[float] = ...) -> None: ...
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    SECONDS_BY_TAG_FIELD_NUMBER: _ClassVar[int]
    library: _animation_pb2.LibraryInfo
    seconds_by_tag: _containers.ScalarMap[str, float]
    def __init__(self, library: _Optional[_Union[_animation_pb2.LibraryInfo, _Mapping]] = ..., seconds_by_tag: _Optional[_Mapping[str, float]] = ...) -> None: ...

class ListClipsRequest(_message.Message):
    __slots__ = ("library", "page_size", "page_token", "name_contains", "tag")
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    PAGE_SIZE_FIELD_NUMBER: _ClassVar[int]
    PAGE_TOKEN_FIELD_NUMBER: _ClassVar[int]
    NAME_CONTAINS_FIELD_NUMBER: _ClassVar[int]
    TAG_FIELD_NUMBER: _ClassVar[int]
    library: str
    page_size: int
    page_token: str
    name_contains: str
    tag: str
    def __init__(self, library: _Optional[str] = ..., page_size: _Optional[int] = ..., page_token: _Optional[str] = ..., name_contains: _Optional[str] = ..., tag: _Optional[str] = ...) -> None: ...

class ListClipsResponse(_message.Message):
    __slots__ = ("clips", "next_page_token", "total")
    CLIPS_FIELD_NUMBER: _ClassVar[int]
    NEXT_PAGE_TOKEN_FIELD_NUMBER: _ClassVar[int]
    TOTAL_FIELD_NUMBER: _ClassVar[int]
    clips: _containers.RepeatedCompositeFieldContainer[ClipInfo]
    next_page_token: str
    total: int
    def __init__(self, clips: _Optional[_Iterable[_Union[ClipInfo, _Mapping]]] = ..., next_page_token: _Optional[str] = ..., total: _Optional[int] = ...) -> None: ...

class ClipInfo(_message.Message):
    __slots__ = ("name", "seconds", "frames", "source", "tags")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SECONDS_FIELD_NUMBER: _ClassVar[int]
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    TAGS_FIELD_NUMBER: _ClassVar[int]
    name: str
    seconds: float
    frames: int
    source: str
    tags: _containers.RepeatedCompositeFieldContainer[Tag]
    def __init__(self, name: _Optional[str] = ..., seconds: _Optional[float] = ..., frames: _Optional[int] = ..., source: _Optional[str] = ..., tags: _Optional[_Iterable[_Union[Tag, _Mapping]]] = ...) -> None: ...

class Tag(_message.Message):
    __slots__ = ("name", "start_s", "end_s")
    NAME_FIELD_NUMBER: _ClassVar[int]
    START_S_FIELD_NUMBER: _ClassVar[int]
    END_S_FIELD_NUMBER: _ClassVar[int]
    name: str
    start_s: float
    end_s: float
    def __init__(self, name: _Optional[str] = ..., start_s: _Optional[float] = ..., end_s: _Optional[float] = ...) -> None: ...

class GetClipRequest(_message.Message):
    __slots__ = ("span",)
    SPAN_FIELD_NUMBER: _ClassVar[int]
    span: _pose_pb2.ClipSpan
    def __init__(self, span: _Optional[_Union[_pose_pb2.ClipSpan, _Mapping]] = ...) -> None: ...

class GetClipResponse(_message.Message):
    __slots__ = ("clip", "frame_rate_hz", "poses", "contacts")
    CLIP_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    POSES_FIELD_NUMBER: _ClassVar[int]
    CONTACTS_FIELD_NUMBER: _ClassVar[int]
    clip: ClipInfo
    frame_rate_hz: float
    poses: _pose_pb2.Poses
    contacts: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, clip: _Optional[_Union[ClipInfo, _Mapping]] = ..., frame_rate_hz: _Optional[float] = ..., poses: _Optional[_Union[_pose_pb2.Poses, _Mapping]] = ..., contacts: _Optional[_Iterable[int]] = ...) -> None: ...

class GetSkeletonRequest(_message.Message):
    __slots__ = ("library",)
    LIBRARY_FIELD_NUMBER: _ClassVar[int]
    library: str
    def __init__(self, library: _Optional[str] = ...) -> None: ...

class GetSkeletonResponse(_message.Message):
    __slots__ = ("skeleton",)
    SKELETON_FIELD_NUMBER: _ClassVar[int]
    skeleton: _pose_pb2.Skeleton
    def __init__(self, skeleton: _Optional[_Union[_pose_pb2.Skeleton, _Mapping]] = ...) -> None: ...

class GetInfoRequest(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class GetInfoResponse(_message.Message):
    __slots__ = ("version", "libraries", "models", "limits", "stitchers", "sessions", "characters")
    class ModelsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: str
        def __init__(self, key: _Optional[str] = ..., value: _Optional[str] = ...) -> None: ...
    VERSION_FIELD_NUMBER: _ClassVar[int]
    LIBRARIES_FIELD_NUMBER: _ClassVar[int]
    MODELS_FIELD_NUMBER: _ClassVar[int]
    LIMITS_FIELD_NUMBER: _ClassVar[int]
    STITCHERS_FIELD_NUMBER: _ClassVar[int]
    SESSIONS_FIELD_NUMBER: _ClassVar[int]
    CHARACTERS_FIELD_NUMBER: _ClassVar[int]
    version: str
    libraries: _containers.RepeatedCompositeFieldContainer[_animation_pb2.LibraryInfo]
    models: _containers.ScalarMap[str, str]
    limits: _animation_pb2.Limits
    stitchers: _containers.RepeatedScalarFieldContainer[str]
    sessions: int
    characters: int
    def __init__(self, version: _Optional[str] = ..., libraries: _Optional[_Iterable[_Union[_animation_pb2.LibraryInfo, _Mapping]]] = ..., models: _Optional[_Mapping[str, str]] = ..., limits: _Optional[_Union[_animation_pb2.Limits, _Mapping]] = ..., stitchers: _Optional[_Iterable[str]] = ..., sessions: _Optional[int] = ..., characters: _Optional[int] = ...) -> None: ...
