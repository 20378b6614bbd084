"""Search of the motion database."""

from stridewire._codec.matches import (
    decode_excluded,
    decode_match,
    encode_excluded,
    encode_match,
)
from stridewire._codec.pose_sources import (
    decode_clip_time,
    decode_pose_source,
    encode_clip_time,
    encode_pose_source,
)
from stridewire._codec.shared import decode_trajectory, encode_trajectory
from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import (
    DesiredMotion,
    SearchQuery,
    SearchResult,
    Trajectory,
)
from stridewire.v1 import match_pb2

_DEFAULT_MATCHES = 5


def encode_search(query: SearchQuery) -> match_pb2.SearchRequest:
    """Encode a search."""
    wire = match_pb2.SearchRequest(
        library=query.library,
        pose=encode_pose_source(query.pose),
        filter=query.filter,
        weights=query.weights,
        k=query.k,
        exclude=map(encode_clip_time, query.exclude),
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
        InvalidRequestError: If there is no pose or not one pose, or two libraries are named.
    """
    return SearchQuery(
        pose=decode_pose_source(wire.pose, "pose"),
        intent=_decode_intent(wire),
        k=wire.k or _DEFAULT_MATCHES,
        library=_only_library(wire),
        exclude=tuple(map(decode_clip_time, wire.exclude)),
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
