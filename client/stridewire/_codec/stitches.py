"""Stitches: one motion out of several clips."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from stridewire._codec.blocks import read_block, write_blocks
from stridewire._codec.catalogue import decode_poses, encode_poses
from stridewire._codec.shared import decode_skeleton, encode_skeleton
from stridewire._errors import InvalidRequestError, ProtocolError, Violation
from stridewire._messages import (
    BvhText,
    ClipSpan,
    MotionFigures,
    RootPath,
    Seam,
    StitchHeader,
    StitchPart,
    StitchQuery,
    StitchReport,
)
from stridewire.motion.clip import Clip, ClipError, Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire.v1 import pose_pb2
from stridewire.v1 import stitch_pb2 as pb

SEARCHED_FRAMES = 15
"""What `seam_search` alone means."""


def encode_stitch(query: StitchQuery) -> pb.StitchRequest:
    """Encode what to stitch and how."""
    return pb.StitchRequest(
        clips=map(_encode_source, query.clips),
        window_s=query.window_s,
        shift_s=query.shift_s,
        passes=query.passes,
        strength=query.strength,
        joint_mask=query.joint_mask,
        stitcher=query.stitcher,
        search_frames=query.search_frames,
        start_s=query.start_s,
        end_s=query.end_s,
        path=None if query.path is None else _encode_path(query.path),
    )


def decode_stitch(wire: pb.StitchRequest) -> StitchQuery:
    """Decode what to stitch and how.

    Raises:
        InvalidRequestError: If a clip is absent or its blocks do not make one.
    """
    given: dict[str, Any] = {
        name: getattr(wire, name)
        for name in ("window_s", "shift_s", "passes", "strength")
        if wire.HasField(name)
    }
    return StitchQuery(
        tuple(_decode_source(clip, f"clips[{i}]") for i, clip in enumerate(wire.clips)),
        wire.stitcher or "auto",
        search_frames=wire.search_frames or (SEARCHED_FRAMES if wire.seam_search else 0),
        joint_mask=dict(wire.joint_mask),
        start_s=wire.start_s,
        end_s=wire.end_s,
        path=_decode_path(wire.path) if wire.HasField("path") else None,
        **given,
    )


def encode_part(part: StitchPart) -> pb.StitchResponse:
    """Encode one part of the answer."""
    match part:
        case Pose():
            return pb.StitchResponse(poses=encode_poses(part))
        case StitchHeader():
            return pb.StitchResponse(
                header=pb.StitchHeader(
                    skeleton=encode_skeleton(part.skeleton),
                    frame_rate_hz=part.frame_rate_hz,
                    frames=part.frames,
                )
            )
        case StitchReport():
            return pb.StitchResponse(report=_encode_report(part))


def decode_part(wire: pb.StitchResponse) -> StitchPart:
    """Decode one part of the answer.

    Raises:
        ProtocolError: If it is none that this version knows.
    """
    match wire.WhichOneof("part"):
        case "poses":
            return decode_poses(wire.poses)
        case "header":
            header = wire.header
            skeleton = decode_skeleton(header.skeleton, "header.skeleton")
            return StitchHeader(skeleton, header.frame_rate_hz, header.frames)
        case "report":
            return _decode_report(wire.report)
    raise ProtocolError("the server sent a part that this version does not know; update stridewire")


def _encode_source(source: ClipSpan | Clip | BvhText) -> pose_pb2.ClipSource:
    match source:
        case ClipSpan():
            return pose_pb2.ClipSource(span=pose_pb2.ClipSpan(**vars(source)))
        case BvhText():
            return pose_pb2.ClipSource(bvh=source.text)
        case Clip():
            inline = pose_pb2.InlineClip(
                name=source.name,
                frame_rate_hz=source.frame_rate,
                poses=encode_poses(source.pose),
                skeleton=encode_skeleton(source.skeleton),
            )
            return pose_pb2.ClipSource(inline=inline)


def _decode_source(wire: pose_pb2.ClipSource, path: str) -> ClipSpan | Clip | BvhText:
    match wire.WhichOneof("source"):
        case "span":
            span = wire.span
            return ClipSpan(span.clip, span.start_s, span.end_s, span.library)
        case "bvh":
            return BvhText(wire.bvh)
        case "inline":
            return _decode_inline(wire.inline, f"{path}.inline")
    raise InvalidRequestError.of(
        Violation(path, "absent; give a span of a clip, poses inline, or the text of a BVH file")
    )


def _decode_inline(wire: pose_pb2.InlineClip, path: str) -> Clip:
    skeleton = REFERENCE
    if wire.HasField("skeleton"):
        skeleton = decode_skeleton(wire.skeleton, f"{path}.skeleton")
    pose, joints = decode_poses(wire.poses), len(skeleton)
    for name, values, size in (
        ("root", wire.poses.root, 7),
        ("hips", wire.poses.hips, 3),
        ("rotations", wire.poses.rotations, 4 * joints),
    ):
        if len(values) != size * wire.poses.frames:
            raise InvalidRequestError.of(
                Violation(
                    f"{path}.poses.{name}",
                    f"{len(values)} values for {wire.poses.frames} frames of {joints} joints; "
                    f"expected {size} a frame",
                )
            )
    contacts = np.zeros((wire.poses.frames, 4), np.bool_)
    try:
        return Clip(wire.name, skeleton, wire.frame_rate_hz, pose, contacts)
    except ClipError as error:
        raise InvalidRequestError.of(Violation(path, str(error))) from error


def _encode_path(path: RootPath) -> pb.RootPath:
    wire = pb.RootPath()
    write_blocks(wire, positions_xz=path.positions_xz, times_s=path.times_s)
    if path.facings_yaw is not None:
        write_blocks(wire, facings_yaw=path.facings_yaw)
    return wire


def _decode_path(wire: pb.RootPath) -> RootPath:
    return RootPath(
        read_block(wire, "positions_xz", -1, 2),
        read_block(wire, "times_s"),
        read_block(wire, "facings_yaw") if wire.facings_yaw else None,
    )


def _encode_report(report: StitchReport) -> pb.StitchReport:
    seams = report.seams
    return pb.StitchReport(
        seams=[seam.frame for seam in seams],
        methods=[seam.method for seam in seams],
        reasons=[seam.reason for seam in seams],
        cut_before=[seam.cut_before for seam in seams],
        cut_after=[seam.cut_after for seam in seams],
        before=_encode_figures(report.before),
        after=_encode_figures(report.after),
        elsewhere=_encode_figures(report.elsewhere),
        changed_frames=report.changed_frames,
        window_s=report.window_s,
        models=report.models,
        version=report.version,
    )


def _decode_report(wire: pb.StitchReport) -> StitchReport:
    rows = zip(wire.seams, wire.methods, wire.reasons, wire.cut_before, wire.cut_after, strict=True)
    models: Mapping[str, str] = dict(wire.models)
    return StitchReport(
        tuple(Seam(*row) for row in rows),
        _decode_figures(wire.before),
        _decode_figures(wire.after),
        _decode_figures(wire.elsewhere),
        wire.changed_frames,
        wire.window_s,
        models,
        wire.version,
    )


def _encode_figures(figures: MotionFigures) -> pb.MotionFigures:
    return pb.MotionFigures(**vars(figures))


def _decode_figures(wire: pb.MotionFigures) -> MotionFigures:
    return MotionFigures(
        wire.sliding_c_cm_s,
        wire.sliding_a_cm_s,
        wire.toe_jerk,
        wire.knee_jerk,
        wire.seam_step_cm_s,
    )
