"""AnimationService: live streams over gRPC."""

from typing import Any

from grpc.aio import EOF  # type: ignore[attr-defined]

from stridewire.v1 import animation_pb2 as pb
from stridewire.v1.animation_pb2_grpc import AnimationServiceServicer
from stridewire_server.streaming.sessions import Sessions


class AnimationService(AnimationServiceServicer):
    """Serves streams; the sessions are the server's, whatever door they come through."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions

    async def Animate(self, request_iterator: Any, context: Any) -> None:
        """Serve one stream."""
        await self._sessions.serve(_GrpcWire(context))


class _GrpcWire:
    """The wire of a gRPC stream; its messages are decoded by gRPC."""

    def __init__(self, context: Any) -> None:
        self._context = context

    async def read(self) -> pb.AnimateRequest | None:
        request: pb.AnimateRequest = await self._context.read()
        return None if request is EOF else request

    async def write(self, response: pb.AnimateResponse) -> None:
        await self._context.write(response)
