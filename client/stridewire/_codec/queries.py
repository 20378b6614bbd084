"""Unary queries: search of the motion database, what the server is."""

from stridewire._codec.matches import (
    decode_excluded,
    decode_match,
    encode_excluded,
    encode_match,
)
from stridewire._codec.shared import (
    decode_library_info,
    decode_limits,
    decode_trajectory,
    encode_library_info,
    encode_limits,
    encode_trajectory,
)
from stridewire._errors import InvalidRequestError, NotImplementedYetError, Violation
from stridewire._messages import (
    ClipTime,
    DesiredMotion,
    SearchQuery,
    SearchResult,
    ServerInfo,
    Trajectory,
)
from stridewire.v1 import library_pb2, match_pb2, pose_pb2

_DEFAULT_MATCHES = 5


def encode_search(query: SearchQuery) -> match_pb2.SearchRequest:
    """Encode a search."""
    wire = match_pb2.SearchRequest(
        library=query.library,
        pose=pose_pb2.PoseSource(clip=_encode_clip_time(query.pose)),
        filter=query.filter,
        weights=query.weights,
        k=query.k,
        exclude=map(_encode_clip_time, query.exclude),
    )
    match query.intent:
        case Trajectory():
            wire.trajectory.CopyFrom(encode_trajectory(query.intent))
        case DesiredMotion():
            wire.motion.CopyFrom(match_pb2.DesiredMotion(**vars(query.intent)))
    return wire


def decode_search(wire: match_pb2.SearchRequest) -> SearchQuery:
    """Decode a search.

    Raises:
        InvalidRequestError: If there is no pose, or two libraries are named.
        NotImplementedYetError: If the pose is inline.
    """
    if wire.pose.WhichOneof("source") == "inline":
        raise NotImplementedYetError("pose.inline is not implemented yet; refer to a clip")
    if not wire.pose.HasField("clip"):
        raise InvalidRequestError.of(
            Violation("pose", "absent; give the clip and the time to continue from")
        )
    return SearchQuery(
        pose=_decode_clip_time(wire.pose.clip),
        intent=_decode_intent(wire),
        k=wire.k or _DEFAULT_MATCHES,
        library=_only_library(wire),
        exclude=tuple(map(_decode_clip_time, wire.exclude)),
        filter=wire.filter,
        weights=dict(wire.weights),
    )


def encode_search_result(result: SearchResult) -> match_pb2.SearchResponse:
    """Encode the matches."""
    return match_pb2.SearchResponse(
        matches=map(encode_match, result.matches),
        library=result.library,
        content_hash=result.content_hash,
        excluded=map(encode_excluded, result.excluded),
        exact=result.exact,
    )


def decode_search_result(wire: match_pb2.SearchResponse) -> SearchResult:
    """Decode the matches."""
    return SearchResult(
        tuple(map(decode_match, wire.matches)),
        wire.library,
        wire.content_hash,
        tuple(map(decode_excluded, wire.excluded)),
        wire.exact,
    )


def encode_server_info(info: ServerInfo) -> library_pb2.GetInfoResponse:
    """Encode what the server is."""
    return library_pb2.GetInfoResponse(
        version=info.version,
        libraries=map(encode_library_info, info.libraries),
        models=info.models,
        limits=encode_limits(info.limits),
        stitchers=info.stitchers,
        sessions=info.sessions,
        characters=info.characters,
    )


def decode_server_info(wire: library_pb2.GetInfoResponse) -> ServerInfo:
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


def _encode_clip_time(moment: ClipTime) -> pose_pb2.ClipTime:
    return pose_pb2.ClipTime(clip=moment.clip, time_s=moment.time_s)


def _decode_clip_time(wire: pose_pb2.ClipTime) -> ClipTime:
    return ClipTime(wire.clip, wire.time_s)


def _decode_intent(wire: match_pb2.SearchRequest) -> Trajectory | DesiredMotion | None:
    match wire.WhichOneof("intent"):
        case "trajectory":
            return decode_trajectory(wire.trajectory)
        case "motion":
            motion = wire.motion
            facing = motion.facing_yaw if motion.HasField("facing_yaw") else None
            return DesiredMotion(motion.velocity_x, motion.velocity_z, facing)
    return None


def _only_library(wire: match_pb2.SearchRequest) -> str:
    """Return the one library that request, pose and exclusions name between them."""
    named = [("library", wire.library), ("pose.clip.library", wire.pose.clip.library)]
    named += [(f"exclude[{i}].library", moment.library) for i, moment in enumerate(wire.exclude)]
    given = [(field, name) for field, name in named if name]
    first, library = given[0] if given else ("", "")
    for field, name in given:
        if name != library:
            raise InvalidRequestError.of(
                Violation(field, f"{name!r}, but {first} is {library!r}; give one library")
            )
    return library
