"""LibraryService: what the libraries hold."""

from typing import Any

import numpy as np

from stridewire._codec.blocks import write_blocks
from stridewire._codec.shared import encode_library_info, encode_skeleton
from stridewire._errors import InvalidRequestError, Violation
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.contacts import to_mask
from stridewire.v1 import library_pb2 as pb
from stridewire.v1 import pose_pb2
from stridewire.v1.library_pb2_grpc import LibraryServiceServicer
from stridewire_engine.library import ClipEntry
from stridewire_engine.runtime import Runtime

MAX_SPAN_S = 60.0
MAX_PAGE = 1000
DEFAULT_PAGE = 100


class LibraryService(LibraryServiceServicer):
    """Reads the libraries, which never change; so it needs no turn in the runtime's thread."""

    def __init__(self, runtime: Runtime) -> None:
        self._runtime = runtime

    async def ListLibraries(
        self, request: pb.ListLibrariesRequest, context: Any
    ) -> pb.ListLibrariesResponse:
        """List all libraries, the default first."""
        infos = (
            encode_library_info(library.info()) for library in self._runtime.libraries.values()
        )
        return pb.ListLibrariesResponse(libraries=infos)

    async def GetLibrary(
        self, request: pb.GetLibraryRequest, context: Any
    ) -> pb.GetLibraryResponse:
        """Tell about one library."""
        library = self._runtime.library(request.name)
        return pb.GetLibraryResponse(
            library=encode_library_info(library.info()), seconds_by_tag=library.seconds_by_tag()
        )

    async def ListClips(self, request: pb.ListClipsRequest, context: Any) -> pb.ListClipsResponse:
        """List clips, page by page."""
        library = self._runtime.library(request.library)
        clips = [entry for entry in library.clips if _fits(entry, request)]
        start, size = _page(request, len(clips))
        return pb.ListClipsResponse(
            clips=(_clip_info(entry, library.frame_rate) for entry in clips[start : start + size]),
            next_page_token=str(start + size) if start + size < len(clips) else "",
            total=len(clips),
        )

    async def GetClip(self, request: pb.GetClipRequest, context: Any) -> pb.GetClipResponse:
        """Give the poses of a span."""
        library = self._runtime.library(request.span.library)
        clip = library.clip(request.span.clip)
        part = _cut(clip, request.span)
        return pb.GetClipResponse(
            clip=_clip_info(library.entry(clip.name), library.frame_rate),
            frame_rate_hz=clip.frame_rate,
            poses=_poses(part.pose),
            contacts=to_mask(part.contacts).tolist(),
        )

    async def GetSkeleton(
        self, request: pb.GetSkeletonRequest, context: Any
    ) -> pb.GetSkeletonResponse:
        """Give the skeleton of a library."""
        return pb.GetSkeletonResponse(
            skeleton=encode_skeleton(self._runtime.library(request.library).skeleton)
        )


def _fits(entry: ClipEntry, request: pb.ListClipsRequest) -> bool:
    tagged = not request.tag or any(tag.name == request.tag for tag in entry.tags)
    return tagged and request.name_contains in entry.name


def _page(request: pb.ListClipsRequest, total: int) -> tuple[int, int]:
    """Return the first clip and the number of clips of a page."""
    if request.page_size > MAX_PAGE:
        raise InvalidRequestError.of(
            Violation(
                "page_size",
                f"{request.page_size}; allowed are 0 (means {DEFAULT_PAGE}) to {MAX_PAGE}",
            )
        )
    token = request.page_token or "0"
    if not (token.isascii() and token.isdigit() and int(token) <= total):
        raise InvalidRequestError.of(
            Violation("page_token", f"{token!r} is of no page; give next_page_token as it came")
        )
    return int(token), request.page_size or DEFAULT_PAGE


def _cut(clip: Clip, span: pose_pb2.ClipSpan) -> Clip:
    """Return the frames of a span."""
    end_s = span.end_s or clip.seconds
    if not 0.0 <= span.start_s <= end_s <= clip.seconds + 1e-6:
        raise InvalidRequestError.of(
            Violation(
                "span",
                f"{span.start_s:g} s to {end_s:g} s; clip {clip.name!r} goes from 0 to "
                f"{clip.seconds:g} s",
            )
        )
    if end_s - span.start_s > MAX_SPAN_S:
        raise InvalidRequestError.of(
            Violation("span", f"{end_s - span.start_s:g} s; ask for {MAX_SPAN_S:g} s at most")
        )
    first, last = round(span.start_s * clip.frame_rate), round(end_s * clip.frame_rate)
    return clip.cut(first, last + 1)


def _poses(pose: Pose) -> pose_pb2.Poses:
    wire = pose_pb2.Poses(frames=len(pose.rotations))
    root = np.concatenate([pose.root_position, pose.root_rotation], axis=-1)
    write_blocks(wire, root=root, hips=pose.hips, rotations=pose.rotations)
    return wire


def _clip_info(entry: ClipEntry, frame_rate: float) -> pb.ClipInfo:
    return pb.ClipInfo(
        name=entry.name,
        seconds=(entry.frames - 1) / frame_rate,
        frames=entry.frames,
        source=entry.source,
        tags=(
            pb.Tag(name=tag.name, start_s=tag.start / frame_rate, end_s=tag.end / frame_rate)
            for tag in entry.tags
        ),
    )
