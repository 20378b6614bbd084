from stridewire.v1 import pose_pb2 as _pose_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class BlendMethod(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    BLEND_METHOD_UNSPECIFIED: _ClassVar[BlendMethod]
    BLEND_METHOD_NEURAL: _ClassVar[BlendMethod]
    BLEND_METHOD_SLERP: _ClassVar[BlendMethod]
    BLEND_METHOD_AUTO: _ClassVar[BlendMethod]
BLEND_METHOD_UNSPECIFIED: BlendMethod
BLEND_METHOD_NEURAL: BlendMethod
BLEND_METHOD_SLERP: BlendMethod
BLEND_METHOD_AUTO: BlendMethod

class BlendRequest(_message.Message):
    __slots__ = ("start", "end", "weights", "method", "joint_mask", "ground_height", "duration_s")
    class JointMaskEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: float
        def __init__(self, key: _Optional[str] = ..., value: _Optional[float] = ...) -> None: ...
    START_FIELD_NUMBER: _ClassVar[int]
    END_FIELD_NUMBER: _ClassVar[int]
    WEIGHTS_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    JOINT_MASK_FIELD_NUMBER: _ClassVar[int]
    GROUND_HEIGHT_FIELD_NUMBER: _ClassVar[int]
    DURATION_S_FIELD_NUMBER: _ClassVar[int]
    start: _pose_pb2.PoseSource
    end: _pose_pb2.PoseSource
    weights: _containers.RepeatedScalarFieldContainer[float]
    method: BlendMethod
    joint_mask: _containers.ScalarMap[str, float]
    ground_height: float
    duration_s: float
    def __init__(self, start: _Optional[_Union[_pose_pb2.PoseSource, _Mapping]] = ..., end: _Optional[_Union[_pose_pb2.PoseSource, _Mapping]] = ..., weights: _Optional[_Iterable[float]] = ..., method: _Optional[_Union[BlendMethod, str]] = ..., joint_mask: _Optional[_Mapping[str, float]] = ..., ground_height: _Optional[float] = ..., duration_s: _Optional[float] = ...) -> None: ...

class BlendResponse(_message.Message):
    __slots__ = ("poses", "method", "reason")
    POSES_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    poses: _pose_pb2.Poses
    method: BlendMethod
    reason: str
    def __init__(self, poses: _Optional[_Union[_pose_pb2.Poses, _Mapping]] = ..., method: _Optional[_Union[BlendMethod, str]] = ..., reason: _Optional[str] = ...) -> None: ...

class BlendManyRequest(_message.Message):
    __slots__ = ("requests",)
    REQUESTS_FIELD_NUMBER: _ClassVar[int]
    requests: _containers.RepeatedCompositeFieldContainer[BlendRequest]
    def __init__(self, requests: _Optional[_Iterable[_Union[BlendRequest, _Mapping]]] = ...) -> None: ...

class BlendManyResponse(_message.Message):
    __slots__ = ("responses",)
    RESPONSES_FIELD_NUMBER: _ClassVar[int]
    responses: _containers.RepeatedCompositeFieldContainer[BlendResponse]
    def __init__(self, responses: _Optional[_Iterable[_Union[BlendResponse, _Mapping]]] = ...) -> None: ...
