"""ServerService: what the server is."""

from typing import Any

from stridewire._codec.catalogue import decode_info_query, encode_info
from stridewire.v1 import library_pb2
from stridewire.v1.library_pb2_grpc import ServerServiceServicer
from stridewire_server.ticker import Ticker


class ServerService(ServerServiceServicer):
    """Tells versions, libraries, limits and load."""

    def __init__(self, ticker: Ticker) -> None:
        self._ticker = ticker

    async def GetInfo(
        self, request: library_pb2.GetInfoRequest, context: Any
    ) -> library_pb2.GetInfoResponse:
        """Tell about the server."""
        query = decode_info_query(request)
        return encode_info(await self._ticker.query(self._ticker.runtime.ask, query))
