"""Every field that a later version fills is refused by name, and no other."""

from collections.abc import Callable

import grpc
import pytest

from serving import opening, stepping
from stridewire.v1 import animation_pb2, pose_pb2
from stridewire.v1 import animation_pb2 as pb

Call = Callable[..., list[pb.AnimateResponse]]

OPEN = {
    "open.resume_token": {"resume_token": "r"},
}


@pytest.mark.parametrize("field", OPEN)
def test_open(raw_stream: Call, field: str) -> None:
    """Open with a later field ends UNIMPLEMENTED and names it."""
    assert field in refusal(raw_stream, opening(**OPEN[field]))


def test_all_other_fields_work(raw_stream: Call) -> None:
    """Every field of Open, CharacterSpec and Sparse that is not listed above is accepted."""
    spec = pb.CharacterSpec(
        id=7,
        root=pose_pb2.GroundPose(position=pose_pb2.Vector3(x=1.0), yaw=0.5),
        stitcher="none",
        foot_lock=False,
        height_m=1.8,
        filter="walk | idle",
        weights={"trajectory-position": 2.0},
        responsiveness=0.7,
        rate_divider=2,
    )
    opened = pb.Open(
        library="small",
        pacing=pb.PACING_CLIENT,
        rate_hz=30.0,
        characters=[spec],
        max_frames_in_flight=8,
        detail=pb.DETAIL_COSTS,
        seed=3,
        output_skeleton=pose_pb2.Skeleton(name="reference"),
        format=pb.POSE_FORMAT_F16,
    )
    trajectory = pose_pb2.Trajectory(
        positions_xz=[0, 1, 0, 2], facings_yaw=[0, 0], times_s=[0.5, 1]
    )
    sparse = pb.Sparse(
        character=7,
        trajectory=trajectory,
        root_correction=pb.RootCorrection(root=spec.root),
        force_search=True,
        filter="walk",
        ground=pb.Ground(height=0.1),
    )
    # sugar for a filter, so that it comes in a control of its own
    gait = pb.Sparse(character=7, gait="walk")
    later = {"gait", *(name.partition(".")[2] for name in OPEN)}
    for message in (opened, spec, sparse):
        present = {field.name for field, _ in message.ListFields()}
        assert present == {f.name for f in message.DESCRIPTOR.fields} - later
    responses = raw_stream(pb.AnimateRequest(open=opened), stepping(step=1, sparse=[sparse, gait]))
    assert [response.WhichOneof("message") for response in responses] == ["opened", "frame"]
    assert len(responses[1].frame.simulated_root) == 4


def refusal(call: Call, request: animation_pb2.AnimateRequest) -> str:
    """Return the message of the UNIMPLEMENTED that a request is answered with."""
    with pytest.raises(grpc.RpcError) as raised:
        call(request)
    assert raised.value.code() is grpc.StatusCode.UNIMPLEMENTED
    details: str = raised.value.details()
    return details
