"""`make show-surface`: one interface three ways, sessions by the hundred, rigs, replays.

Bars stand here as they were asked for. Needs grpcurl, node with `examples/node` installed, and the
capture (STRIDEWIRE_DATA) for real skeletons and a second library.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import grpc
from capture import capture
from grpc_reflection.v1alpha import reflection_pb2, reflection_pb2_grpc
from hypothesis import HealthCheck, given, settings
from points import ROOT, Point, show
from rig_figures import measure, real_rigs

from sessions import assert_alike, hostile_ends, hostile_in_stream, plans, play
from stridewire import Client
from stridewire.testing import serve
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import blend_pb2, library_pb2, match_pb2, stitch_pb2
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub

ONE = "tests/integration/test_one_interface.py::"
SAME = "tests/integration/test_same_in_process.py::"
CURL = "tests/integration/test_grpcurl.py::"
BLEND = "tests/integration/test_blend.py::"
STITCH = "tests/integration/test_stitch.py::"
NODE = "tests/end_to_end/test_node.py::"
QUERIES = f"{CURL}test_every_query_is_a_one_liner[grpcurl]"
WAYS = ("blocking", "asyncio", "in process", "grpcurl", "Node")

BY_CLIENTS = {
    "Animate": f"{SAME}test_frames_are_the_same[{{way}}-follow_a_script-2]",
    "Search": f"{ONE}test_a_search_by_a_moment_and_a_way[{{way}}]",
    "GetInfo": f"{ONE}test_info_tells_version_libraries_limits[{{way}}]",
    "ListLibraries": f"{ONE}test_libraries_are_listed[{{way}}]",
    "GetLibrary": f"{ONE}test_libraries_are_listed[{{way}}]",
    "ListClips": f"{ONE}test_clips_are_listed_over_all_pages[{{way}}]",
    "GetClip": f"{ONE}test_a_clip_comes_as_a_clip[{{way}}]",
    "GetSkeleton": f"{ONE}test_the_skeleton_is_the_librarys[{{way}}]",
    "Blend": f"{BLEND}test_references_and_poses_are_the_same[{{way}}]",
    "BlendMany": f"{BLEND}test_many_are_each[{{way}}]",
    "Stitch": f"{STITCH}test_clips_become_one_motion[{{way}}]",
}
"""Which test has which method, for each kind of client."""
BY_GRPCURL = {
    "Animate": f"{CURL}test_a_scripted_session_comes_from_a_file[grpcurl]",
    "Blend": f"{CURL}test_a_blend_is_pasted[grpcurl]",
    "BlendMany": f"{CURL}test_many_blends_are_one_call[grpcurl]",
    "Stitch": f"{STITCH}test_it_is_a_one_liner",
}
"""Which test has which method by grpcurl, where it is not that of all queries."""
BY_NODE = {
    "Animate": f"{NODE}test_node_streams",
    "Stitch": f"{STITCH}test_node_stitches",
}
"""Which test has which method by Node, where it is not that of all queries."""


def methods() -> Iterator[Point]:
    """Each RPC by blocking, asyncio, in process, grpcurl and Node, with the test's name."""
    files = (pb, match_pb2, library_pb2, blend_pb2, stitch_pb2)
    services = [s for file in files for s in file.DESCRIPTOR.services_by_name.values()]
    with _channel() as channel:
        served = _served(channel)
    missing = {service.full_name for service in services} ^ served
    yield Point("services that are served but not in this table, or the other way round",
                str(sorted(missing)), "none", not missing)  # fmt: skip
    names = [method.name for service in services for method in service.methods]
    yield Point("RPCs without a row", str(sorted(set(names) - set(BY_CLIENTS))), "none",
                not set(names) - set(BY_CLIENTS))  # fmt: skip
    passed = _passed({path.partition("::")[0] for path in (ONE, SAME, BLEND, STITCH, CURL, NODE)})
    for name in names:
        cells = {way: BY_CLIENTS[name].format(way=way) for way in WAYS[:3]}
        cells["grpcurl"] = BY_GRPCURL.get(name, QUERIES)
        cells["Node"] = BY_NODE.get(name, f"{NODE}test_node_asks")
        for way, test in cells.items():
            outcome = passed.get(test.rpartition("/")[2], "absent")
            yield Point(f"{name} by {way}", f"{test}: {outcome}", "a test",
                        outcome == "passed")  # fmt: skip


def _served(channel: grpc.Channel) -> set[str]:
    """Return the services of ours that a server's reflection lists."""
    request = reflection_pb2.ServerReflectionRequest(list_services="")
    (answer,) = reflection_pb2_grpc.ServerReflectionStub(channel).ServerReflectionInfo(
        iter([request]), timeout=60.0
    )
    names = {service.name for service in answer.list_services_response.service}
    return {name for name in names if name.startswith("stridewire.")}


def _passed(files: set[str]) -> dict[str, str]:
    """Run test files; return the outcome of each test by file and name."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [sys.executable, "-m", "pytest", "-q", f"--junitxml={report}", *sorted(files)]
        subprocess.run(command, cwd=ROOT, check=False, capture_output=True)
        cases = ElementTree.parse(report).getroot().iter("testcase")
        return {
            f"{case.get('classname', '').rpartition('.')[2]}.py::{case.get('name')}": (
                case[0].tag if len(case) else "passed"
            )
            for case in cases
        }


def valid_sessions() -> Iterator[Point]:
    """200 random valid sessions over the wire and in process."""
    frames = 0

    with serve() as address, Client(address, timeout_s=60.0) as remote:
        local = Client.in_process()

        def same(plan: Any) -> None:
            nonlocal frames
            outcome = play(remote, plan)
            assert_alike(outcome, play(local, plan))
            frames += len(outcome.frames)

        count = _examples(same, plan=plans)
    figure = f"{count} sessions, {frames} frames, all equal"
    yield Point("random valid sessions over the wire and in process", figure, "200 equal",
                count >= 200)  # fmt: skip


def hostile_sessions() -> Iterator[Point]:
    """200 hostile sessions: each ends as the contract says and the next session works."""
    with _channel() as channel:

        def ends(hostile: Any) -> None:
            messages, code = hostile
            call = AnimationServiceStub(channel).Animate(iter(messages), timeout=60.0)
            with suppress(grpc.RpcError):
                list(call)
            assert call.code().name == code, call.details()
            _works(channel)

        def lives(hostile: Any) -> None:
            before, bad, after = hostile
            opening = pb.AnimateRequest(open=pb.Open(characters=[pb.CharacterSpec(id=1)]))
            messages = [opening, *before, *(message for message, _ in bad), *after]
            responses = list(AnimationServiceStub(channel).Animate(iter(messages), timeout=60.0))
            refused = [
                violation.field for response in responses for violation in response.error.violations
            ]
            assert refused == [field for _, field in bad]
            _works(channel)

        ended = _examples(ends, 100, hostile=hostile_ends)
        lived = _examples(lives, 100, hostile=hostile_in_stream)
    yield Point("hostile sessions that end with the status the contract says",
                f"{ended}, the next session worked", "each", ended >= 60)  # fmt: skip
    yield Point("hostile sessions that live on, each bad message refused by its field",
                f"{lived}, the next session worked", "each", lived >= 100)  # fmt: skip
    total = ended + lived
    yield Point("hostile sessions", str(total), "200", total >= 200)


def rigs() -> Iterator[Point]:
    """Live output on a Mixamo and on a CMU skeleton, over gRPC."""
    with serve() as address, Client(address, timeout_s=60.0) as client:
        for name, skeleton in real_rigs():
            figures = measure(client, skeleton)
            angles = (
                f"mean {figures.mean_deg:.2f}°, 95 % within {figures.p95_deg:.2f}°, "
                f"{figures.within_pct:.1f} % within 1°, largest {figures.max_deg:.1f}°"
            )
            yield Point(f"{name}: limb directions", angles, "within 1°", figures.max_deg <= 1.0)
            slide = (
                f"{figures.slide_cm_s:.4f} cm/s, reference {figures.reference_slide_cm_s:.4f} "
                f"(legs of {figures.scale:.4f} its size)"
            )
            yield Point(f"{name}: planted feet slide", slide, "no more than on the reference",
                        figures.slide_cm_s <= figures.reference_slide_cm_s)  # fmt: skip


def replays() -> Iterator[Point]:
    """A recording again, and over two libraries."""
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "session.jsonl"
        captured = Path(folder) / "captured"
        captured.mkdir()
        for name in ("walk1_subject1_long.bvh", "walk1_subject1_walk2.bvh"):
            shutil.copy(next(capture().rglob(name)), captured)
        with serve() as address:
            drive = ["stream", "--script", "random-stick", "--seconds", "20", "--characters", "3"]
            drive += ["--no-realtime", "--address", address]
            _stridewire(*drive, "--record", str(recording), "--json")
        (same,) = _stridewire("replay", str(recording), "--json")["rows"]
        yield Point("a session recorded over gRPC replays", json.dumps(same),
                    "same clips and times, poses to 1e-5", same["same"])  # fmt: skip
        synthetic = ["--library", str(_embedded())]
        rows = _stridewire("replay", str(recording), *synthetic, "--stitch", "none", "--json")
        against = ["--against", str(_embedded()), "--against", str(captured)]
        rows["rows"] += _stridewire("replay", str(recording), *against, "--json")["rows"]
        for row in rows["rows"]:
            yield Point(f"replayed over {row['library']}, stitch {row['stitch']}",
                        json.dumps(row), "differences tabled", row["frames"] == 1200)  # fmt: skip
        names = {row["library"] for row in rows["rows"]}
        yield Point(
            "libraries compared on one recording", str(sorted(names)), "two", len(names) > 1
        )


def _embedded() -> Path:
    from stridewire_engine.building import open_library

    return Path(open_library().path)


def _stridewire(*arguments: str) -> Any:
    command = [sys.executable, "-m", "stridewire", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if not done.stdout:
        raise RuntimeError(f"{' '.join(arguments)}: {done.stderr}")
    return json.loads(done.stdout)


@contextmanager
def _channel() -> Iterator[grpc.Channel]:
    with serve() as address, grpc.insecure_channel(address) as channel:
        yield channel


def _works(channel: grpc.Channel) -> None:
    """Open a session and make a frame."""
    opening = pb.AnimateRequest(open=pb.Open(characters=[pb.CharacterSpec(id=1)]))
    step = pb.AnimateRequest(step=pb.Step(step=1, dt_s=1 / 60))
    responses = list(AnimationServiceStub(channel).Animate(iter([opening, step]), timeout=60.0))
    assert [r.WhichOneof("message") for r in responses] == ["opened", "frame"]


def _examples(check: Callable[..., None], most: int = 200, **strategies: Any) -> int:
    """Run a check on random examples; return how many there were."""
    count = 0

    def counted(**example: Any) -> None:
        nonlocal count
        check(**example)
        count += 1

    profile = settings(
        max_examples=most, deadline=None, derandomize=True, database=None,
        suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    profile(given(**strategies)(counted))()
    return count


if __name__ == "__main__":
    sys.exit(show("surface", [methods, valid_sessions, hostile_sessions, rigs, replays]))
