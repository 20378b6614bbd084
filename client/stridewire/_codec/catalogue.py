"""Queries about libraries and the server: what is open, which clips, their poses, skeletons."""

import numpy as np

from stridewire._codec.blocks import read_block, read_integers, write_blocks
from stridewire._codec.shared import (
    decode_library_info,
    decode_limits,
    decode_skeleton,
    encode_library_info,
    encode_limits,
    encode_skeleton,
)
from stridewire._messages import (
    ClipInfo,
    ClipPage,
    ClipPoses,
    ClipQuery,
    ClipsQuery,
    InfoQuery,
    LibrariesQuery,
    LibraryDetails,
    LibraryInfo,
    LibraryQuery,
    ServerInfo,
    SkeletonQuery,
    TagTime,
)
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton
from stridewire.v1 import library_pb2 as pb
from stridewire.v1 import pose_pb2


def encode_info_query(query: InfoQuery) -> pb.GetInfoRequest:
    """Encode the question what the server is."""
    return pb.GetInfoRequest()


def decode_info_query(wire: pb.GetInfoRequest) -> InfoQuery:
    """Decode the question what the server is."""
    return InfoQuery()


def encode_info(info: ServerInfo) -> pb.GetInfoResponse:
    """Encode what the server is."""
    return pb.GetInfoResponse(
        version=info.version,
        libraries=map(encode_library_info, info.libraries),
        models=info.models,
        limits=encode_limits(info.limits),
        stitchers=info.stitchers,
        sessions=info.sessions,
        characters=info.characters,
    )


def decode_info(wire: pb.GetInfoResponse) -> ServerInfo:
    """Decode what the server is."""
    return ServerInfo(
        version=wire.version,
        libraries=tuple(map(decode_library_info, wire.libraries)),
        models=dict(wire.models),
        limits=decode_limits(wire.limits),
        stitchers=tuple(wire.stitchers),
        sessions=wire.sessions,
        characters=wire.characters,
    )


def encode_libraries_query(query: LibrariesQuery) -> pb.ListLibrariesRequest:
    """Encode the question which libraries are open."""
    return pb.ListLibrariesRequest()


def decode_libraries_query(wire: pb.ListLibrariesRequest) -> LibrariesQuery:
    """Decode the question which libraries are open."""
    return LibrariesQuery()


def encode_libraries(libraries: tuple[LibraryInfo, ...]) -> pb.ListLibrariesResponse:
    """Encode which libraries are open."""
    return pb.ListLibrariesResponse(libraries=map(encode_library_info, libraries))


def decode_libraries(wire: pb.ListLibrariesResponse) -> tuple[LibraryInfo, ...]:
    """Decode which libraries are open."""
    return tuple(map(decode_library_info, wire.libraries))


def encode_library_query(query: LibraryQuery) -> pb.GetLibraryRequest:
    """Encode the question what a library holds."""
    return pb.GetLibraryRequest(name=query.name)


def decode_library_query(wire: pb.GetLibraryRequest) -> LibraryQuery:
    """Decode the question what a library holds."""
    return LibraryQuery(wire.name)


def encode_library(details: LibraryDetails) -> pb.GetLibraryResponse:
    """Encode what a library holds."""
    return pb.GetLibraryResponse(
        library=encode_library_info(details.info), seconds_by_tag=details.seconds_by_tag
    )


def decode_library(wire: pb.GetLibraryResponse) -> LibraryDetails:
    """Decode what a library holds."""
    return LibraryDetails(decode_library_info(wire.library), dict(wire.seconds_by_tag))


def encode_clips_query(query: ClipsQuery) -> pb.ListClipsRequest:
    """Encode the question which clips there are."""
    return pb.ListClipsRequest(**vars(query))


def decode_clips_query(wire: pb.ListClipsRequest) -> ClipsQuery:
    """Decode the question which clips there are."""
    return ClipsQuery(wire.library, wire.page_size, wire.page_token, wire.name_contains, wire.tag)


def encode_clips(page: ClipPage) -> pb.ListClipsResponse:
    """Encode a page of clips."""
    return pb.ListClipsResponse(
        clips=map(_encode_clip_info, page.clips),
        next_page_token=page.next_page_token,
        total=page.total,
    )


def decode_clips(wire: pb.ListClipsResponse) -> ClipPage:
    """Decode a page of clips."""
    return ClipPage(tuple(map(_decode_clip_info, wire.clips)), wire.next_page_token, wire.total)


def encode_clip_query(query: ClipQuery) -> pb.GetClipRequest:
    """Encode the question for a clip's poses."""
    span = pose_pb2.ClipSpan(
        library=query.library, clip=query.clip, start_s=query.start_s, end_s=query.end_s
    )
    return pb.GetClipRequest(span=span)


def decode_clip_query(wire: pb.GetClipRequest) -> ClipQuery:
    """Decode the question for a clip's poses."""
    span = wire.span
    return ClipQuery(span.clip, span.library, span.start_s, span.end_s)


def encode_clip(answer: ClipPoses) -> pb.GetClipResponse:
    """Encode a clip's poses."""
    return pb.GetClipResponse(
        clip=_encode_clip_info(answer.clip),
        frame_rate_hz=answer.frame_rate_hz,
        poses=encode_poses(answer.pose),
        contacts=answer.contacts.tolist(),
    )


def decode_clip(wire: pb.GetClipResponse) -> ClipPoses:
    """Decode a clip's poses."""
    return ClipPoses(
        _decode_clip_info(wire.clip),
        wire.frame_rate_hz,
        decode_poses(wire.poses),
        read_integers(wire.contacts),
    )


def encode_skeleton_query(query: SkeletonQuery) -> pb.GetSkeletonRequest:
    """Encode the question for a library's skeleton."""
    return pb.GetSkeletonRequest(library=query.library)


def decode_skeleton_query(wire: pb.GetSkeletonRequest) -> SkeletonQuery:
    """Decode the question for a library's skeleton."""
    return SkeletonQuery(wire.library)


def encode_skeleton_answer(skeleton: Skeleton) -> pb.GetSkeletonResponse:
    """Encode a library's skeleton."""
    return pb.GetSkeletonResponse(skeleton=encode_skeleton(skeleton))


def decode_skeleton_answer(wire: pb.GetSkeletonResponse) -> Skeleton:
    """Decode a library's skeleton."""
    return decode_skeleton(wire.skeleton, "skeleton")


def encode_poses(pose: Pose) -> pose_pb2.Poses:
    """Encode poses `(T, …)`."""
    wire = pose_pb2.Poses(frames=len(pose.rotations))
    root = np.concatenate([pose.root_position, pose.root_rotation], axis=-1)
    write_blocks(wire, root=root, hips=pose.hips, rotations=pose.rotations)
    return wire


def decode_poses(wire: pose_pb2.Poses) -> Pose:
    """Decode poses; blocks that do not fill their frames stay flat."""
    frames = wire.frames
    joints = len(wire.rotations) // (4 * frames) if frames else 0
    root = read_block(wire, "root", frames, 7)
    return Pose(
        root[..., :3],
        root[..., 3:],
        read_block(wire, "hips", frames, 3),
        read_block(wire, "rotations", frames, joints, 4),
    )


def _encode_clip_info(clip: ClipInfo) -> pb.ClipInfo:
    return pb.ClipInfo(
        name=clip.name,
        seconds=clip.seconds,
        frames=clip.frames,
        source=clip.source,
        tags=(pb.Tag(**vars(tag)) for tag in clip.tags),
    )


def _decode_clip_info(wire: pb.ClipInfo) -> ClipInfo:
    tags = tuple(TagTime(tag.name, tag.start_s, tag.end_s) for tag in wire.tags)
    return ClipInfo(wire.name, wire.seconds, wire.frames, wire.source, tags)
