"""Whatever is wrong with a message is told by field, and nothing else stops because of it."""

from collections.abc import Callable

import grpc
import numpy as np
import pytest
from google.rpc import error_details_pb2, status_pb2

from serving import opening, stepping
from stridewire import Client, FrameFlag
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    CorrectionMode,
    GroundPose,
    RootCorrection,
    Sparse,
)
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import pose_pb2

Call = Callable[..., list[pb.AnimateResponse]]

NAN = float("nan")


def place(**given: float) -> pose_pb2.GroundPose:
    """Return a place on the ground, `yaw` apart."""
    yaw = given.pop("yaw", 0.0)
    return pose_pb2.GroundPose(position=pose_pb2.Vector3(**given), yaw=yaw)


def character(**given: object) -> pb.AnimateRequest:
    """Return an Open of one character."""
    return pb.AnimateRequest(open=pb.Open(characters=[pb.CharacterSpec(**given)]))


@pytest.mark.parametrize(
    ("requests", "code", "says"),
    [
        ([], "FAILED_PRECONDITION", "send Open first"),
        ([stepping()], "FAILED_PRECONDITION", "Step before Open"),
        ([pb.AnimateRequest(close=pb.Close())], "FAILED_PRECONDITION", "Close before Open"),
        ([pb.AnimateRequest()], "FAILED_PRECONDITION", "empty message"),
        ([opening(), opening()], "FAILED_PRECONDITION", "a second Open"),
        ([opening(), pb.AnimateRequest()], "FAILED_PRECONDITION", "empty message"),
        ([opening(0)], "INVALID_ARGUMENT", "0 characters; allowed are 1 to 4096"),
        ([opening(4097)], "INVALID_ARGUMENT", "4097 characters; allowed are 1 to 4096"),
        ([opening(library="nowhere")], "NOT_FOUND", "no library 'nowhere'"),
        ([opening(rate_hz=5.0)], "INVALID_ARGUMENT", "open.rate_hz: 5.0"),
        ([opening(rate_hz=NAN)], "INVALID_ARGUMENT", "open.rate_hz: nan"),
        ([opening(max_frames_in_flight=4000)], "INVALID_ARGUMENT", "max_frames_in_flight"),
        ([opening(pacing=7)], "INVALID_ARGUMENT", "open.pacing: 7 has no meaning"),
        ([character(root=place(x=NAN))], "INVALID_ARGUMENT", "root.position.x: nan"),
        ([character(root=place(yaw=NAN))], "INVALID_ARGUMENT", "root.yaw: nan"),
        ([character(root=place(z=2e6))], "INVALID_ARGUMENT", "root.position.z: 2000000"),
        ([character(stitcher="glue")], "INVALID_ARGUMENT", "'glue' is not present; present are"),
        (
            [pb.AnimateRequest(open=pb.Open(characters=[pb.CharacterSpec(id=3)] * 2))],
            "INVALID_ARGUMENT",
            "open.characters[1].id: 3 is taken",
        ),
    ],
)
def test_what_cannot_begin_ends_with_a_status(
    raw_stream: Call, requests: list[pb.AnimateRequest], code: str, says: str
) -> None:
    """Order, counts, names and numbers of Open are answered with code and reason."""
    with pytest.raises(grpc.RpcError) as raised:
        raw_stream(*requests)
    assert raised.value.code().name == code
    assert says in raised.value.details()


def test_every_wrong_field_is_in_the_details(raw_stream: Call) -> None:
    """INVALID_ARGUMENT carries google.rpc.BadRequest with one violation a field."""
    request = pb.AnimateRequest(
        open=pb.Open(rate_hz=1.0, characters=[pb.CharacterSpec(root=place(x=NAN, y=NAN))])
    )
    with pytest.raises(grpc.RpcError) as raised:
        raw_stream(request)
    metadata = dict(raised.value.trailing_metadata())
    status = status_pb2.Status.FromString(metadata["grpc-status-details-bin"])
    bad = error_details_pb2.BadRequest()
    assert status.code == grpc.StatusCode.INVALID_ARGUMENT.value[0]
    assert status.details[0].Unpack(bad)
    assert [violation.field for violation in bad.field_violations] == [
        "open.rate_hz",
        "open.characters[0].root.position.x",
        "open.characters[0].root.position.y",
    ]


def test_an_oversized_message_exhausts_the_limit(raw_stream: Call) -> None:
    """A step of more than 1 MiB ends its stream with RESOURCE_EXHAUSTED."""
    with pytest.raises(grpc.RpcError) as raised:
        raw_stream(opening(), stepping(velocity_xz=[1.0] * 300_000))
    assert raised.value.code() is grpc.StatusCode.RESOURCE_EXHAUSTED


def test_bytes_that_are_no_message_end_the_stream_alone(address: str, client: Client) -> None:
    """Garbage ends its own stream; a session beside it goes on."""
    with grpc.insecure_channel(address) as channel, client.open_session() as session:
        animate = channel.stream_stream("/stridewire.v1.AnimationService/Animate")
        with pytest.raises(grpc.RpcError) as raised:
            list(animate(iter([b"\xff" * 9]), timeout=10.0))
        assert raised.value.code() is grpc.StatusCode.INVALID_ARGUMENT
        assert session.step().frame == 1


@pytest.mark.parametrize(
    ("given", "field", "says"),
    [
        ({"dt_s": NAN}, "step.dt_s", "nan; allowed are 0 to 0.25"),
        ({"dt_s": -0.1}, "step.dt_s", "-0.1; allowed are 0 to 0.25"),
        ({"velocity_xz": [NAN, 0.0, 0.0, 0.0]}, "step.velocity_xz[0]", "nan m/s"),
        ({"velocity_xz": [0.0, 0.0, 0.0, 25.0]}, "step.velocity_xz[3]", "25.0 m/s; allowed"),
        ({"velocity_xz": [1.0, 2.0, 3.0]}, "step.velocity_xz", "3 values for 2 characters"),
        ({"facing_yaw": [0.0, float("inf")]}, "step.facing_yaw[1]", "inf is no angle"),
        ({"facing_yaw": [0.0]}, "step.facing_yaw", "1 values for 2 characters"),
        ({"characters": [0, 9]}, "step.characters[1]", "9 is not in this session"),
        ({"last_frame": 99}, "step.last_frame", "99 was not sent yet"),
        ({"sparse": [pb.Sparse(character=8)]}, "step.sparse[0].character", "8 is not in"),
        (
            {"sparse": [pb.Sparse(root_correction=pb.RootCorrection(root=place(y=NAN)))]},
            "step.sparse[0].root_correction.root.position.y",
            "nan is not a place",
        ),
        (
            {"sparse": [pb.Sparse(root_correction=pb.RootCorrection(mode=9))]},
            "step.sparse[0].root_correction.mode",
            "9 has no meaning",
        ),
        (
            {"sparse": [pb.Sparse(trajectory=pose_pb2.Trajectory(times_s=[1.0, 0.5]))]},
            "step.sparse[0].trajectory.positions_xz",
            "0 values for 2 times",
        ),
    ],
)
def test_a_bad_control_is_refused_in_the_stream(
    raw_stream: Call, given: dict[str, object], field: str, says: str
) -> None:
    """An Error names the field, the step makes its frame all the same, and the next one too."""
    responses = raw_stream(opening(2), stepping(step=1, **given), stepping(step=2))
    kinds = [response.WhichOneof("message") for response in responses]
    assert kinds == ["opened", "error", "frame", "frame"]
    error = responses[1].error
    assert error.step == 1
    violations = {v.field: v.description for v in error.violations}
    assert says in violations[field]
    assert [response.frame.applied_step for response in responses[2:]] == [1, 2]


def test_a_bad_control_holds_one_of_256_characters(client: Client) -> None:
    """The one that was asked for nonsense goes on as before; the others follow the new control."""
    with client.open_session(256) as session:
        for _ in range(60):
            session.step(velocity=(0.0, 1.2))
        velocity = np.tile(np.float32([1.2, 0.0]), (256, 1))
        velocity[100] = NAN
        frame = session.step(velocity=velocity)
        assert frame.flagged(FrameFlag.HELD).tolist() == [100]
        violations = [v.field for error in session.errors for v in error.violations]
        assert violations == ["step.velocity_xz[200]", "step.velocity_xz[201]"]
        start = frame.root[:, :3]
        for _ in range(120):
            frame = session.step()
        moved = frame.root[:, :3] - start
        assert moved[100, 2] > 3.0 * abs(moved[100, 0])
        others = np.delete(moved, 100, axis=0)
        assert np.all(others[:, 0] > others[:, 2])


def test_an_edit_is_refused_by_part(client: Client) -> None:
    """Known characters are changed, unknown ones are told, the last one stays."""
    with client.open_session([1, 2]) as session:
        session.edit(
            add=[CharacterSpec(3), CharacterSpec(3), CharacterSpec(4, GroundPose((NAN, 0.0, 0.0)))],
            remove=[1, 77],
            update=[
                CharacterUpdate(CharacterSpec(2, stitcher="none"), ("stitcher",)),
                CharacterUpdate(CharacterSpec(2), ()),
                CharacterUpdate(CharacterSpec(55), ("foot_lock",)),
            ],
        )
        frame = session.step(characters=[2, 3], velocity=(0.0, 1.0))
        assert frame.characters.tolist() == [2, 3]
        (error,) = session.errors
        assert [violation.field for violation in error.violations] == [
            "edit.remove[1]",
            "edit.add[1].id",
            "edit.add[2].root.position.x",
            "edit.update[1].mask",
            "edit.update[2].spec.id",
        ]


def test_a_bad_correction_does_not_move_the_character(client: Client) -> None:
    """A place that is none is refused; a good teleport after it is taken and flagged."""
    with client.open_session() as session:
        session.step()
        root = GroundPose((NAN, 0.0, 0.0))
        held = session.step(
            sparse=[Sparse(0, root_correction=RootCorrection(root, CorrectionMode.TELEPORT))]
        )
        assert np.all(np.isfinite(held.root))
        assert np.linalg.norm(held.root[0, :3]) < 0.5
        session.teleport(0, (10.0, 0.0, -5.0))
        moved = session.step()
        np.testing.assert_allclose(moved.root[0, :3], (10.0, 0.0, -5.0), atol=0.1)
        assert moved.flagged(FrameFlag.TELEPORTED).tolist() == [0]
