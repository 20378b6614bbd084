"""StitchService: the same motion over the wire and in process, blocking and awaited."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import grpc
import numpy as np
import pytest

from external import grpcurl, needs_grpcurl, needs_node, node_script, objects
from serving import DEADLINE_S
from stridewire import (
    BvhText,
    Client,
    ClipSpan,
    ExhaustedError,
    InvalidRequestError,
    NotFoundError,
    RootPath,
    StitchHeader,
    StitchQuery,
    StitchReport,
)
from stridewire._messages import Pacing
from stridewire.formats.bvh_writing import write_bvh
from stridewire.motion.clip import Clip, Pose
from stridewire.v1 import pose_pb2, stitch_pb2, stitch_pb2_grpc
from stridewire_engine.library import Library
from stridewire_engine.stitching.checks import MAX_CLIPS

NODE = """
import grpc from "@grpc/grpc-js";
import loader from "@grpc/proto-loader";
const options = { includeDirs: ["../../proto"], oneofs: true };
const definition = loader.loadSync("stridewire/v1/stitch.proto", options);
const { StitchService } = grpc.loadPackageDefinition(definition).stridewire.v1;
const client = new StitchService("ADDRESS", grpc.credentials.createInsecure());
const clips = [{ span: { clip: "walk-1.4", endS: 1 } }, { span: { clip: "walk-1.1" } }];
const parts = [];
client.Stitch({ clips }).on("data", (part) => parts.push(part.part)).on("end", () => {
  console.log(JSON.stringify(parts));
  client.close();
});
"""
SPANS = (ClipSpan("walk-1.4", 2.0, 4.0), ClipSpan("walk-1.7", 2.5, 4.5), ClipSpan("walk-1.1", 3.0))


def test_clips_become_one_motion(either: Any, small_library: Library) -> None:
    """All frames at 60 frames/s; seams are hidden, and the rest is the clips' own."""
    result = either.stitch(SPANS)
    frames = [121, 121, len(small_library.clip("walk-1.1")) - 180]
    assert len(result.clip) == sum(frames)
    report = result.report
    assert [seam.frame for seam in report.seams] == [121, 242]
    assert report.after.seam_step_cm_s < 0.2 * report.before.seam_step_cm_s
    own = small_library.clip("walk-1.4").pose.rotations[120:241]
    assert np.array_equal(result.clip.pose.rotations[:121], own)


def test_both_ways_give_the_same(client: Client, small_library: Library) -> None:
    """Poses to the last bit, and the report."""
    with Client.in_process(small_library.path) as inside:
        times = np.linspace(0.0, 10.0, 8, dtype=np.float32)
        way = np.stack([np.sin(times), times], axis=-1)
        for given in ({}, {"path": RootPath(way, times)}, {"search_frames": 9, "strength": 0.5}):
            over, here = (c.stitch(SPANS[:2], **given) for c in (client, inside))
            assert np.array_equal(over.clip.pose.rotations, here.clip.pose.rotations)
            assert np.array_equal(over.clip.pose.root_position, here.clip.pose.root_position)
            assert over.report == here.report


def test_sources_of_all_kinds(either: Any, small_library: Library, tmp_path: Path) -> None:
    """A name, a span, a clip of one's own and the text of a file go together."""
    walk = small_library.clip("walk-1.4").cut(120, 240)
    write_bvh(tmp_path / "walk.bvh", walk)
    text = BvhText((tmp_path / "walk.bvh").read_text())
    half = replace(walk, frame_rate=30.0, pose=walk.pose[::2], contacts=walk.contacts[::2], tags=())
    result = either.stitch(["walk-1.1", SPANS[1], walk, text, half])
    assert len(result.report.seams) == 4
    assert result.report.after.seam_step_cm_s < 0.3 * result.report.before.seam_step_cm_s


def test_parts_come_in_order(either: Any) -> None:
    """A header, poses, a report; whoever stops reading ends the call."""
    parts = list(either.stitch_parts(StitchQuery(SPANS)))
    assert isinstance(parts[0], StitchHeader)
    assert isinstance(parts[-1], StitchReport)
    assert all(isinstance(part, Pose) for part in parts[1:-1])
    assert sum(len(part.hips) for part in parts[1:-1]) == parts[0].frames
    stopped = either.stitch_parts(StitchQuery(SPANS))
    assert isinstance(next(stopped), StitchHeader)
    stopped.close()
    assert either.stitch(SPANS).report == parts[-1]


@pytest.mark.parametrize(
    ("clips", "given", "field"),
    [
        (SPANS[:1], {}, "clips"),
        (SPANS[:1] * (MAX_CLIPS + 1), {}, "clips"),
        (SPANS, {"window_s": 3.0}, "window_s"),
        (SPANS, {"strength": float("nan")}, "strength"),
        (SPANS, {"stitcher": "glue"}, "stitcher"),
        (SPANS, {"joint_mask": {"Tail": 1.0}}, "joint_mask[Tail]"),
        ((SPANS[0], ClipSpan("walk-1.4", 1.0, 99.0)), {}, "clips[1].span"),
        ((SPANS[0], ClipSpan("walk-1.4", 1.0, 1.1)), {}, "clips[1]"),
        ((SPANS[0], BvhText("HIERARCHY")), {}, "clips[1].bvh"),
    ],
)
def test_what_is_wrong_is_named(either: Any, clips: Any, given: dict[str, Any], field: str) -> None:
    """INVALID_ARGUMENT with the path of the field."""
    with pytest.raises(InvalidRequestError) as raised:
        either.stitch(clips, **given)
    assert [violation.field for violation in raised.value.violations] == [field]


def test_unknown_clips_are_not_found(either: Any) -> None:
    """NOT_FOUND, naming near ones."""
    with pytest.raises(NotFoundError, match=r"walk-1\.4"):
        either.stitch([SPANS[0], "walk-1.40"])


@pytest.mark.parametrize("field", ["passes", "shift_s"])
def test_zero_is_not_the_default(address: str, field: str) -> None:
    """Zero passes and windows that do not move are refused; absent, they have a default."""
    request = stitch_pb2.StitchRequest(
        clips=[pose_pb2.ClipSource(span=pose_pb2.ClipSpan(clip="walk-1.4"))] * 2
    )
    with grpc.insecure_channel(address) as channel:
        stitch = stitch_pb2_grpc.StitchServiceStub(channel).Stitch
        assert list(stitch(request, timeout=DEADLINE_S))[-1].report.seams
        setattr(request, field, 0)
        with pytest.raises(grpc.RpcError) as raised:
            list(stitch(request, timeout=DEADLINE_S))
    assert raised.value.code() is grpc.StatusCode.INVALID_ARGUMENT
    assert field in raised.value.details()


@pytest.mark.parametrize(
    ("break_it", "field"),
    [
        (lambda inline: inline.poses.rotations.pop(), "clips[0].inline.poses.rotations"),
        (lambda inline: inline.poses.hips.__setitem__(4, float("nan")), "clips[0].inline"),
        (lambda inline: inline.ClearField("poses"), "clips[0].inline"),
        (lambda inline: inline.poses.root.__setitem__(3, 9.0), "clips[0].inline.poses.root"),
    ],
)
def test_broken_blocks_are_named(
    address: str, small_library: Library, break_it: Any, field: str
) -> None:
    """Numbers missing, none, or no rotations, in a clip that comes with the request."""
    from stridewire._codec.stitches import encode_stitch

    request = encode_stitch(StitchQuery([small_library.clip("walk-1.4").cut(0, 30)] * 2))
    break_it(request.clips[0].inline)
    with grpc.insecure_channel(address) as channel:
        stitch = stitch_pb2_grpc.StitchServiceStub(channel).Stitch
        with pytest.raises(grpc.RpcError) as raised:
            list(stitch(request, timeout=DEADLINE_S))
    assert raised.value.code() is grpc.StatusCode.INVALID_ARGUMENT
    assert f"{field}:" in raised.value.details()


def test_long_files_pass_and_longer_ones_are_refused(client: Client, tmp_path: Path) -> None:
    """A request of several MiB works, one of more than 16 MiB is RESOURCE_EXHAUSTED."""
    with pytest.raises(InvalidRequestError, match="MOTION"):
        client.stitch([BvhText("x" * (4 << 20)), SPANS[0]])
    with pytest.raises(ExhaustedError):
        client.stitch([BvhText("x" * (17 << 20)), SPANS[0]])


def test_streams_go_on_meanwhile(client: Client) -> None:
    """Frames are made between the parts of a motion that is being stitched."""
    with client.open_session(pacing=Pacing.CLIENT) as session:
        parts = client.stitch_parts(StitchQuery(SPANS))
        for _ in parts:
            assert session.step(velocity=(0.0, 1.0)).rotations.shape == (1, 22, 4)


def test_too_many_at_once_are_turned_away(client: Client) -> None:
    """Four are worked on; the fifth hears when to come again; places are freed."""
    long = StitchQuery([SPANS[2]] * 40)
    running = [client.stitch_parts(long) for _ in range(4)]
    for parts in running:
        next(parts)
    with pytest.raises(ExhaustedError) as raised:
        client.stitch(SPANS)
    assert raised.value.retry_after_s
    for parts in running:
        parts.close()  # type: ignore[attr-defined]


@needs_grpcurl
def test_it_is_a_one_liner(address: str) -> None:
    """With grpcurl, numbers in, numbers out."""
    spans = [{"span": {"clip": "walk-1.4", "end_s": 1.0}}, {"span": {"clip": "walk-1.1"}}]
    answer = grpcurl(
        address, "stridewire.v1.StitchService/Stitch", data=json.dumps({"clips": spans})
    )
    header, *_, report = objects(answer)
    assert header["header"]["frame_rate_hz"] == 60
    assert report["report"]["seams"] == [61]


@needs_node
def test_node_stitches(address: str) -> None:
    """With grpc-js, a header, poses and a report."""
    header, *poses, report = json.loads(node_script(NODE.replace("ADDRESS", address)))
    assert (header, report) == ("header", "report")
    assert set(poses) == {"poses"}


def test_clips_are_unchanged(client: Client, small_library: Library) -> None:
    """A clip of one's own that is sent is the same afterwards."""
    clip: Clip = small_library.clip("walk-1.4").cut(120, 240)
    before = clip.pose.rotations.copy()
    with Client.in_process(small_library.path) as inside:
        inside.stitch([clip, clip])
    assert np.array_equal(clip.pose.rotations, before)
