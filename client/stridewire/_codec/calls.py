"""Which method of the wire answers which query, for every transport over gRPC."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from stridewire._codec import blends, catalogue, queries, stitches
from stridewire._messages import (
    BlendManyQuery,
    BlendQuery,
    ClipQuery,
    ClipsQuery,
    InfoQuery,
    LibrariesQuery,
    LibraryQuery,
    PartsQuery,
    Query,
    SearchQuery,
    SkeletonQuery,
    StitchQuery,
)
from stridewire.v1 import blend_pb2, library_pb2, match_pb2, stitch_pb2


@dataclass(frozen=True)
class Call:
    """A method and what translates its question and its answer, or the parts of its answer."""

    path: str
    encode: Callable[[Any], Any]
    """Query to request."""
    parse: Callable[[bytes], Any]
    """Bytes to response."""
    decode: Callable[[Any], Any]
    """Response to answer."""

    def serialize(self, query: Query[Any] | PartsQuery[Any]) -> bytes:
        """Return the bytes of a query's request."""
        data: bytes = self.encode(query).SerializeToString()
        return data

    def deserialize(self, data: bytes) -> Any:
        """Return the answer in the bytes of a response."""
        return self.decode(self.parse(data))


_SERVER = "/stridewire.v1.ServerService"
_LIBRARY = "/stridewire.v1.LibraryService"
_MATCH = "/stridewire.v1.MatchService"
_BLEND = "/stridewire.v1.BlendService"

CALL_BY_QUERY: dict[type[Query[Any]], Call] = {
    SearchQuery: Call(
        f"{_MATCH}/Search",
        queries.encode_search,
        match_pb2.SearchResponse.FromString,
        queries.decode_search_result,
    ),
    BlendQuery: Call(
        f"{_BLEND}/Blend",
        blends.encode_blend,
        blend_pb2.BlendResponse.FromString,
        blends.decode_blend_result,
    ),
    BlendManyQuery: Call(
        f"{_BLEND}/BlendMany",
        blends.encode_blend_many,
        blend_pb2.BlendManyResponse.FromString,
        blends.decode_blend_many_result,
    ),
    InfoQuery: Call(
        f"{_SERVER}/GetInfo",
        catalogue.encode_info_query,
        library_pb2.GetInfoResponse.FromString,
        catalogue.decode_info,
    ),
    LibrariesQuery: Call(
        f"{_LIBRARY}/ListLibraries",
        catalogue.encode_libraries_query,
        library_pb2.ListLibrariesResponse.FromString,
        catalogue.decode_libraries,
    ),
    LibraryQuery: Call(
        f"{_LIBRARY}/GetLibrary",
        catalogue.encode_library_query,
        library_pb2.GetLibraryResponse.FromString,
        catalogue.decode_library,
    ),
    ClipsQuery: Call(
        f"{_LIBRARY}/ListClips",
        catalogue.encode_clips_query,
        library_pb2.ListClipsResponse.FromString,
        catalogue.decode_clips,
    ),
    ClipQuery: Call(
        f"{_LIBRARY}/GetClip",
        catalogue.encode_clip_query,
        library_pb2.GetClipResponse.FromString,
        catalogue.decode_clip,
    ),
    SkeletonQuery: Call(
        f"{_LIBRARY}/GetSkeleton",
        catalogue.encode_skeleton_query,
        library_pb2.GetSkeletonResponse.FromString,
        catalogue.decode_skeleton_answer,
    ),
}
"""Each query that travels, and its method."""

CALL_BY_PARTS_QUERY: dict[type[PartsQuery[Any]], Call] = {
    StitchQuery: Call(
        "/stridewire.v1.StitchService/Stitch",
        stitches.encode_stitch,
        stitch_pb2.StitchResponse.FromString,
        stitches.decode_part,
    ),
}
"""Each query that is answered in parts, and its method."""
