"""What a server sends on a stream: Opened, Frame, Error, Notice."""

from typing import assert_never

from stridewire._codec.blocks import (
    read_block,
    read_halves,
    read_integers,
    write_blocks,
    write_halves,
)
from stridewire._codec.events import decode_event, encode_event
from stridewire._codec.frames import frame_bytes
from stridewire._codec.shared import (
    decode_library_info,
    decode_limits,
    decode_skeleton,
    encode_library_info,
    encode_limits,
    encode_skeleton,
)
from stridewire._errors import ServerError, Violation
from stridewire._messages import (
    Detail,
    Frame,
    Inside,
    Notice,
    Opened,
    Pacing,
    PoseFormat,
    ServerMessage,
    Settings,
    StreamError,
)
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import pose_pb2


def encode_response(message: ServerMessage) -> pb.AnimateResponse:
    """Encode a message of a server."""
    match message:
        case Frame():
            return pb.AnimateResponse(frame=_encode_frame(message))
        case Opened():
            return pb.AnimateResponse(opened=_encode_opened(message))
        case StreamError():
            return pb.AnimateResponse(error=_encode_error(message))
        case Notice():
            return pb.AnimateResponse(notice=pb.Notice(**vars(message)))
        case _:
            assert_never(message)


def response_bytes(message: ServerMessage) -> bytes:
    """Return a message of a server as it lies on the wire; frames the fast way."""
    if isinstance(message, Frame):
        return frame_bytes(message)
    return encode_response(message).SerializeToString()


def decode_response(wire: pb.AnimateResponse) -> ServerMessage:
    """Decode a message of a server.

    Raises:
        ServerError: If the message holds none of the four that are known.
    """
    match wire.WhichOneof("message"):
        case "frame":
            return _decode_frame(wire.frame)
        case "opened":
            return _decode_opened(wire.opened)
        case "error":
            return _decode_error(wire.error)
        case "notice":
            notice = wire.notice
            return Notice(notice.kind, notice.message, notice.deadline_s, notice.resume_token)
    raise ServerError("the server sent a message of an unknown kind; update this client")


def _encode_frame(frame: Frame) -> pb.Frame:
    wire = pb.Frame(
        frame=frame.frame,
        applied_step=frame.applied_step,
        time_s=frame.time_s,
        client_time_s=frame.client_time_s,
        characters=frame.characters.tolist(),
        contacts=frame.contacts.tolist(),
        events=map(encode_event, frame.events),
        flags=frame.flags.tolist(),
        dropped=frame.dropped,
        searches=frame.searches,
        timings=(
            pb.StageTiming(stage=stage, elapsed_ms=elapsed)
            for stage, elapsed in frame.timings_ms.items()
        ),
    )
    # half floats have steps of 6 cm a hundred metres from the origin: the root comes whole, too
    write_blocks(wire, root=frame.root, foot_targets=frame.foot_targets)
    if frame.format is PoseFormat.F16:
        write_halves(
            wire,
            root_f16=frame.root,
            root_delta_f16=frame.root_delta,
            hips_f16=frame.hips,
            rotations_f16=frame.rotations,
        )
    else:
        write_blocks(wire, root_delta=frame.root_delta, hips=frame.hips, rotations=frame.rotations)
    if frame.simulated_root is not None:
        write_blocks(wire, simulated_root=frame.simulated_root)
    if frame.inside is not None:
        inside = frame.inside
        write_blocks(
            wire,
            ahead_s=inside.ahead_s,
            predicted=inside.predicted,
            captured=inside.captured,
            sampled_hips=inside.hips,
            sampled_rotations=inside.rotations,
        )
    return wire


def _decode_frame(wire: pb.Frame) -> Frame:
    count = len(wire.characters)
    halves = bool(wire.rotations_f16)
    read = read_halves if halves else read_block
    numbers = len(wire.rotations_f16) // 2 if halves else len(wire.rotations)
    joints = numbers // (4 * count) if count else 0
    return Frame(
        frame=wire.frame,
        applied_step=wire.applied_step,
        time_s=wire.time_s,
        client_time_s=wire.client_time_s,
        characters=read_integers(wire.characters),
        root=read_block(wire, "root", count, 7),
        root_delta=read(wire, "root_delta", count, 4),
        hips=read(wire, "hips", count, 3),
        rotations=read(wire, "rotations", count, joints, 4),
        contacts=read_integers(wire.contacts),
        foot_targets=read_block(wire, "foot_targets", count, 2, 3),
        flags=read_integers(wire.flags),
        simulated_root=(
            read_block(wire, "simulated_root", count, 4) if wire.simulated_root else None
        ),
        inside=_decode_inside(wire, count) if wire.ahead_s else None,
        events=tuple(map(decode_event, wire.events)),
        dropped=wire.dropped,
        searches=wire.searches,
        timings_ms={timing.stage: timing.elapsed_ms for timing in wire.timings},
        format=PoseFormat.F16 if halves else PoseFormat.F32,
    )


def _decode_inside(wire: pb.Frame, count: int) -> Inside:
    times = len(wire.ahead_s)
    joints = len(wire.sampled_rotations) // (4 * count) if count else 0
    return Inside(
        ahead_s=read_block(wire, "ahead_s", times),
        predicted=read_block(wire, "predicted", count, times, 3),
        captured=read_block(wire, "captured", count, times, 3),
        hips=read_block(wire, "sampled_hips", count, 3),
        rotations=read_block(wire, "sampled_rotations", count, joints, 4),
    )


def _encode_opened(opened: Opened) -> pb.Opened:
    settings = opened.settings
    return pb.Opened(
        session=opened.session,
        resume_token=opened.resume_token,
        skeleton=encode_skeleton(opened.skeleton),
        library=encode_library_info(opened.library),
        server_version=opened.server_version,
        models=opened.models,
        settings=pb.Settings(
            pacing=f"PACING_{settings.pacing.name}",
            rate_hz=settings.rate_hz,
            max_frames_in_flight=settings.max_frames_in_flight,
            format=f"POSE_FORMAT_{settings.format.name}",
            detail=f"DETAIL_{settings.detail.name}",
            seed=settings.seed,
            default_stitcher=settings.default_stitcher,
        ),
        limits=encode_limits(opened.limits),
    )


def _decode_opened(wire: pb.Opened) -> Opened:
    settings = wire.settings
    return Opened(
        session=wire.session,
        skeleton=decode_skeleton(wire.skeleton, "opened.skeleton"),
        library=decode_library_info(wire.library),
        server_version=wire.server_version,
        settings=Settings(
            pacing=Pacing(settings.pacing),
            rate_hz=settings.rate_hz,
            max_frames_in_flight=settings.max_frames_in_flight,
            format=PoseFormat(settings.format),
            detail=Detail(settings.detail),
            seed=settings.seed,
            default_stitcher=settings.default_stitcher,
        ),
        limits=decode_limits(wire.limits),
        models=dict(wire.models),
        resume_token=wire.resume_token,
    )


def _encode_error(error: StreamError) -> pb.Error:
    return pb.Error(
        step=error.step,
        violations=(pose_pb2.FieldViolation(**vars(v)) for v in error.violations),
        more=error.more,
    )


def _decode_error(wire: pb.Error) -> StreamError:
    violations = tuple(Violation(v.field, v.description) for v in wire.violations)
    return StreamError(wire.step, violations, wire.more)
