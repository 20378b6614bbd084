"""What clients of every kind share, without any I/O: messages out of arguments."""

from collections.abc import Mapping, Sequence

import numpy as np

from stridewire._errors import ProtocolError
from stridewire._messages import (
    BvhText,
    CharacterSpec,
    ClipPoses,
    ClipSpan,
    ClipTime,
    DesiredMotion,
    Detail,
    Open,
    Pacing,
    PoseFormat,
    RootPath,
    SearchQuery,
    Stitched,
    StitchHeader,
    StitchPart,
    StitchQuery,
    StitchReport,
    Trajectory,
)
from stridewire.motion.clip import Clip, Pose, TagSpan
from stridewire.motion.skeleton import Skeleton

DEFAULT_ADDRESS = "127.0.0.1:50051"
_CONTACT_BITS = np.array([1, 2, 4, 8], np.uint32)


def opening(
    characters: int | Sequence[int | CharacterSpec],
    *,
    library: str,
    pacing: Pacing,
    rate_hz: float,
    output_skeleton: Skeleton | None,
    format: PoseFormat,
    max_frames_in_flight: int,
    detail: Detail,
    seed: int,
) -> Open:
    """Return the message that opens a session."""
    given = range(characters) if isinstance(characters, int) else characters
    return Open(
        characters=tuple(c if isinstance(c, CharacterSpec) else CharacterSpec(c) for c in given),
        library=library,
        pacing=pacing,
        rate_hz=rate_hz,
        output_skeleton=output_skeleton,
        format=format,
        max_frames_in_flight=max_frames_in_flight,
        detail=detail,
        seed=seed,
    )


def search_query(
    pose: str | Pose,
    time_s: float,
    intent: Trajectory | DesiredMotion | None,
    *,
    k: int,
    library: str,
    exclude: Sequence[ClipTime],
    filter: str,
    weights: Mapping[str, float] | None,
) -> SearchQuery:
    """Return the message that searches."""
    moment = ClipTime(pose, time_s) if isinstance(pose, str) else pose
    return SearchQuery(moment, intent, k, library, tuple(exclude), filter, weights or {})


def to_clip(poses: ClipPoses, skeleton: Skeleton, start_s: float) -> Clip:
    """Return a clip made of a library's poses.

    Args:
        poses: As they came.
        skeleton: Of the library.
        start_s: Where in the library's clip they begin.
    """
    rate, frames = poses.frame_rate_hz, len(poses.contacts)
    tags = (
        TagSpan(
            tag.name,
            max(round((tag.start_s - start_s) * rate), 0),
            min(round((tag.end_s - start_s) * rate), frames),
        )
        for tag in poses.clip.tags
    )
    return Clip(
        poses.clip.name,
        skeleton,
        rate,
        poses.pose,
        poses.contacts[:, None] & _CONTACT_BITS != 0,
        tuple(tag for tag in tags if tag.start < tag.end),
        poses.clip.source,
    )


def stitch_query(
    clips: Sequence[str | ClipSpan | Clip | BvhText],
    *,
    stitcher: str,
    window_s: float,
    search_frames: int,
    strength: float,
    joint_mask: Mapping[str, float] | None,
    path: RootPath | None,
) -> StitchQuery:
    """Return the message that stitches."""
    return StitchQuery(
        tuple(ClipSpan(clip) if isinstance(clip, str) else clip for clip in clips),
        stitcher,
        window_s,
        search_frames=search_frames,
        strength=strength,
        joint_mask=joint_mask or {},
        path=path,
    )


def stitched(parts: Sequence[StitchPart]) -> Stitched:
    """Return the motion that parts make; of contacts an answer tells nothing.

    Raises:
        ProtocolError: If the answer broke off.
    """
    header, *poses, report = parts
    if not isinstance(header, StitchHeader) or not isinstance(report, StitchReport):
        raise ProtocolError("the answer has no header or no report; ask again")
    pose = Pose.concatenate(part for part in poses if isinstance(part, Pose))
    nowhere = np.zeros((header.frames, 4), np.bool_)
    clip = Clip(
        "stitched", header.skeleton, header.frame_rate_hz, pose, nowhere, source="stitching"
    )
    return Stitched(clip, report)
