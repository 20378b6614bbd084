"""What a client sends on a stream: Open, Step, Edit, Close."""

from typing import assert_never

from google.protobuf.field_mask_pb2 import FieldMask

from stridewire._codec.blocks import read_block, read_integers, write_blocks
from stridewire._codec.shared import (
    decode_enum,
    decode_ground_pose,
    decode_skeleton,
    decode_trajectory,
    encode_ground_pose,
    encode_skeleton,
    encode_trajectory,
)
from stridewire._errors import ProtocolError
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    ClientMessage,
    Close,
    CorrectionMode,
    Detail,
    Edit,
    Ground,
    GroundPose,
    Open,
    Pacing,
    PoseFormat,
    RootCorrection,
    Sparse,
    Step,
)
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import pose_pb2

_DEFAULT_RATE_HZ = 60.0
_DEFAULT_CREDITS = 30


def encode_request(message: ClientMessage) -> pb.AnimateRequest:
    """Encode a message of a client."""
    match message:
        case Open():
            return pb.AnimateRequest(open=_encode_open(message))
        case Step():
            return pb.AnimateRequest(step=_encode_step(message))
        case Edit():
            return pb.AnimateRequest(edit=_encode_edit(message))
        case Close():
            return pb.AnimateRequest(close=pb.Close())
        case _:
            assert_never(message)


def decode_request(wire: pb.AnimateRequest) -> ClientMessage:
    """Decode a message of a client.

    Raises:
        InvalidRequestError: If a field has no meaning at all.
        ProtocolError: If the message holds none of the four.
    """
    match wire.WhichOneof("message"):
        case "open":
            return _decode_open(wire.open)
        case "step":
            return _decode_step(wire.step)
        case "edit":
            return _decode_edit(wire.edit)
        case "close":
            return Close()
    raise ProtocolError("an empty message; a message holds one of open, step, edit, close")


def decode_bare_step(wire: pb.Step) -> Step:
    """Decode a step without its controls: what is left of a step whose controls make no sense."""
    return Step(
        step=wire.step,
        dt_s=wire.dt_s,
        last_frame=wire.last_frame,
        client_time_s=wire.client_time_s,
        ack_only=wire.ack_only,
    )


def _encode_open(message: Open) -> pb.Open:
    skeleton = message.output_skeleton
    return pb.Open(
        library=message.library,
        pacing=f"PACING_{message.pacing.name}",
        rate_hz=message.rate_hz,
        characters=map(_encode_spec, message.characters),
        output_skeleton=None if skeleton is None else encode_skeleton(skeleton),
        format=f"POSE_FORMAT_{message.format.name}",
        max_frames_in_flight=message.max_frames_in_flight,
        detail=f"DETAIL_{message.detail.name}",
        seed=message.seed,
        resume_token=message.resume_token,
    )


def _decode_open(wire: pb.Open) -> Open:
    credits_given = wire.HasField("max_frames_in_flight")
    return Open(
        library=wire.library,
        pacing=decode_enum(Pacing, wire.pacing, Pacing.CLIENT, "open.pacing"),
        rate_hz=wire.rate_hz or _DEFAULT_RATE_HZ,
        characters=tuple(map(_decode_spec, wire.characters)),
        output_skeleton=(
            decode_skeleton(wire.output_skeleton, "open.output_skeleton")
            if wire.HasField("output_skeleton")
            else None
        ),
        format=decode_enum(PoseFormat, wire.format, PoseFormat.F32, "open.format"),
        max_frames_in_flight=wire.max_frames_in_flight if credits_given else _DEFAULT_CREDITS,
        detail=decode_enum(Detail, wire.detail, Detail.EVENTS, "open.detail"),
        seed=wire.seed,
        resume_token=wire.resume_token,
    )


def _encode_spec(spec: CharacterSpec) -> pb.CharacterSpec:
    return pb.CharacterSpec(
        id=spec.id,
        root=encode_ground_pose(spec.root),
        height_m=spec.height_m,
        stitcher=spec.stitcher,
        filter=spec.filter,
        weights=spec.weights,
        responsiveness=spec.responsiveness,
        foot_lock=spec.foot_lock,
        rate_divider=spec.rate_divider,
    )


def _decode_spec(wire: pb.CharacterSpec) -> CharacterSpec:
    return CharacterSpec(
        id=wire.id,
        root=decode_ground_pose(wire.root) if wire.HasField("root") else GroundPose(),
        height_m=wire.height_m,
        stitcher=wire.stitcher,
        filter=wire.filter,
        weights=dict(wire.weights),
        responsiveness=wire.responsiveness if wire.HasField("responsiveness") else None,
        foot_lock=wire.foot_lock if wire.HasField("foot_lock") else True,
        rate_divider=wire.rate_divider,
    )


def _encode_step(message: Step) -> pb.Step:
    wire = pb.Step(
        step=message.step,
        dt_s=message.dt_s,
        last_frame=message.last_frame,
        client_time_s=message.client_time_s,
        sparse=map(_encode_sparse, message.sparse),
        ack_only=message.ack_only,
    )
    if message.characters is not None:
        wire.characters.extend(message.characters.tolist())
    if message.velocity_xz is not None:
        write_blocks(wire, velocity_xz=message.velocity_xz)
    if message.facing_yaw is not None:
        write_blocks(wire, facing_yaw=message.facing_yaw)
    return wire


def _decode_step(wire: pb.Step) -> Step:
    return Step(
        step=wire.step,
        dt_s=wire.dt_s,
        last_frame=wire.last_frame,
        client_time_s=wire.client_time_s,
        characters=read_integers(wire.characters) if wire.characters else None,
        velocity_xz=read_block(wire, "velocity_xz", -1, 2) if wire.velocity_xz else None,
        facing_yaw=read_block(wire, "facing_yaw") if wire.facing_yaw else None,
        sparse=_decode_sparses(wire) if wire.sparse else (),
        ack_only=wire.ack_only,
    )


def _decode_sparses(wire: pb.Step) -> tuple[Sparse, ...]:
    return tuple(
        _decode_sparse(sparse, f"step.sparse[{i}]") for i, sparse in enumerate(wire.sparse)
    )


def _encode_sparse(sparse: Sparse) -> pb.Sparse:
    wire = pb.Sparse(
        character=sparse.character,
        filter=sparse.filter,
        gait=sparse.gait,
        force_search=sparse.force_search,
    )
    if sparse.trajectory is not None:
        wire.trajectory.CopyFrom(encode_trajectory(sparse.trajectory))
    if sparse.root_correction is not None:
        correction = pb.RootCorrection(
            root=encode_ground_pose(sparse.root_correction.root),
            mode=f"CORRECTION_MODE_{sparse.root_correction.mode.name}",
        )
        wire.root_correction.CopyFrom(correction)
    if sparse.ground is not None:
        wire.ground.CopyFrom(_encode_ground(sparse.ground))
    return wire


def _decode_sparse(wire: pb.Sparse, field: str) -> Sparse:
    correction = None
    if wire.HasField("root_correction"):
        mode = decode_enum(
            CorrectionMode,
            wire.root_correction.mode,
            CorrectionMode.ADJUST,
            f"{field}.root_correction.mode",
        )
        correction = RootCorrection(decode_ground_pose(wire.root_correction.root), mode)
    return Sparse(
        character=wire.character,
        trajectory=decode_trajectory(wire.trajectory) if wire.HasField("trajectory") else None,
        filter=wire.filter if wire.HasField("filter") else None,
        gait=wire.gait if wire.HasField("gait") else None,
        root_correction=correction,
        ground=_decode_ground(wire.ground) if wire.HasField("ground") else None,
        force_search=wire.force_search,
    )


def _encode_ground(ground: Ground) -> pb.Ground:
    x, y, z = ground.normal
    wire = pb.Ground(height=ground.height, normal=pose_pb2.Vector3(x=x, y=y, z=z))
    if ground.foot_heights is not None:
        write_blocks(wire, foot_heights=ground.foot_heights)
    if ground.foot_normals is not None:
        write_blocks(wire, foot_normals=ground.foot_normals)
    return wire


def _decode_ground(wire: pb.Ground) -> Ground:
    normal = (wire.normal.x, wire.normal.y, wire.normal.z)
    return Ground(
        height=wire.height,
        normal=normal if wire.HasField("normal") else Ground.normal,
        foot_heights=read_block(wire, "foot_heights") if wire.foot_heights else None,
        foot_normals=read_block(wire, "foot_normals", -1, 3) if wire.foot_normals else None,
    )


def _encode_edit(message: Edit) -> pb.Edit:
    return pb.Edit(
        add=map(_encode_spec, message.add),
        remove=message.remove,
        update=(
            pb.CharacterUpdate(spec=_encode_spec(u.spec), mask=FieldMask(paths=u.mask))
            for u in message.update
        ),
    )


def _decode_edit(wire: pb.Edit) -> Edit:
    return Edit(
        add=tuple(map(_decode_spec, wire.add)),
        remove=tuple(wire.remove),
        update=tuple(
            CharacterUpdate(_decode_spec(u.spec), tuple(u.mask.paths)) for u in wire.update
        ),
    )
