"""LibraryService: what the libraries hold."""

from typing import Any

from stridewire._codec import catalogue as codec
from stridewire.v1 import library_pb2 as pb
from stridewire.v1.library_pb2_grpc import LibraryServiceServicer
from stridewire_engine.runtime import Runtime


class LibraryService(LibraryServiceServicer):
    """Reads the libraries, which never change; so it needs no turn in the runtime's thread."""

    def __init__(self, runtime: Runtime) -> None:
        self._runtime = runtime

    async def ListLibraries(
        self, request: pb.ListLibrariesRequest, context: Any
    ) -> pb.ListLibrariesResponse:
        """List all libraries, the default first."""
        return codec.encode_libraries(self._runtime.ask(codec.decode_libraries_query(request)))

    async def GetLibrary(
        self, request: pb.GetLibraryRequest, context: Any
    ) -> pb.GetLibraryResponse:
        """Tell about one library."""
        return codec.encode_library(self._runtime.ask(codec.decode_library_query(request)))

    async def ListClips(self, request: pb.ListClipsRequest, context: Any) -> pb.ListClipsResponse:
        """List clips, page by page."""
        return codec.encode_clips(self._runtime.ask(codec.decode_clips_query(request)))

    async def GetClip(self, request: pb.GetClipRequest, context: Any) -> pb.GetClipResponse:
        """Give the poses of a span."""
        return codec.encode_clip(self._runtime.ask(codec.decode_clip_query(request)))

    async def GetSkeleton(
        self, request: pb.GetSkeletonRequest, context: Any
    ) -> pb.GetSkeletonResponse:
        """Give the skeleton of a library."""
        skeleton = self._runtime.ask(codec.decode_skeleton_query(request))
        return codec.encode_skeleton_answer(skeleton)
