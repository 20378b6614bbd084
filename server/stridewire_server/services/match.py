"""MatchService: search of the motion database."""

from typing import Any

from stridewire._codec.queries import decode_search, encode_search_result
from stridewire.v1 import match_pb2
from stridewire.v1.match_pb2_grpc import MatchServiceServicer
from stridewire_server.ticker import Ticker


class MatchService(MatchServiceServicer):
    """Answers "which moment of the library fits?"."""

    def __init__(self, ticker: Ticker) -> None:
        self._ticker = ticker

    async def Search(
        self, request: match_pb2.SearchRequest, context: Any
    ) -> match_pb2.SearchResponse:
        """Find the moments that fit best."""
        query = decode_search(request)
        return encode_search_result(await self._ticker.query(self._ticker.runtime.search, query))
