"""BlendService: postures between postures."""

from typing import Any

from stridewire._codec import blends as codec
from stridewire.v1 import blend_pb2 as pb
from stridewire.v1.blend_pb2_grpc import BlendServiceServicer
from stridewire_server.ticker import Ticker


class BlendService(BlendServiceServicer):
    """Answers "which posture lies between these two?"."""

    def __init__(self, ticker: Ticker) -> None:
        self._ticker = ticker

    async def Blend(self, request: pb.BlendRequest, context: Any) -> pb.BlendResponse:
        """Blend one pair at many weights."""
        query = codec.decode_blend(request)
        return codec.encode_blend_result(await self._ticker.query(self._ticker.runtime.ask, query))

    async def BlendMany(self, request: pb.BlendManyRequest, context: Any) -> pb.BlendManyResponse:
        """Blend many pairs."""
        query = codec.decode_blend_many(request)
        return codec.encode_blend_many_result(
            await self._ticker.query(self._ticker.runtime.ask, query)
        )
