"""AnimationService: live streams over gRPC."""

from typing import Any

import grpc
from grpc.aio import EOF  # type: ignore[attr-defined]

from stridewire._messages import Limits
from stridewire.v1 import animation_pb2
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1.animation_pb2_grpc import AnimationServiceServicer
from stridewire_server.interceptors import check_size
from stridewire_server.streaming.sessions import Sessions


class AnimationService(AnimationServiceServicer):
    """Serves streams; the sessions are the server's, whatever door they come through."""

    def __init__(self, sessions: Sessions, limits: Limits) -> None:
        self._sessions = sessions
        self._most = limits.max_message_bytes

    async def Animate(self, request_iterator: Any, context: Any) -> None:
        """Serve one stream."""
        await self._sessions.serve(_GrpcWire(context, self._most))


def add_to_server(service: AnimationService, server: Any) -> None:
    """Register a service whose responses are bytes already."""
    described = animation_pb2.DESCRIPTOR.services_by_name["AnimationService"]
    method = grpc.stream_stream_rpc_method_handler(
        service.Animate, request_deserializer=pb.AnimateRequest.FromString
    )
    handler = grpc.method_handlers_generic_handler(described.full_name, {"Animate": method})
    server.add_generic_rpc_handlers((handler,))


class _GrpcWire:
    """The wire of a gRPC stream; its messages are decoded by gRPC."""

    def __init__(self, context: Any, most: int) -> None:
        self._context = context
        self._most = most

    async def read(self) -> pb.AnimateRequest | None:
        request: pb.AnimateRequest = await self._context.read()
        if request is EOF:
            return None
        check_size(request, self._most)
        return request

    async def write(self, response: bytes) -> None:
        await self._context.write(response)
