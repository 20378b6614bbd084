"""Humans use grpcurl and `buf curl`: both list, check, ask and stream without the proto files."""

import json
from collections.abc import Callable

import pytest

from external import ROOT, buf_curl, grpcurl, needs_buf, needs_grpcurl, objects
from stridewire_engine.library import Library

SESSION = (ROOT / "examples" / "grpcurl" / "session.json").read_text()
ANIMATE = "stridewire.v1.AnimationService/Animate"
Curl = Callable[[str, str, str], str]


def ask_with_grpcurl(address: str, method: str, data: str) -> str:
    """Call a method with grpcurl."""
    return grpcurl(address, method, data=data)


@pytest.fixture(
    params=[
        pytest.param(ask_with_grpcurl, id="grpcurl", marks=needs_grpcurl),
        pytest.param(buf_curl, id="buf", marks=needs_buf),
    ]
)
def curl(request: pytest.FixtureRequest) -> Curl:
    """Return a caller of methods by JSON."""
    made: Curl = request.param
    return made


@needs_grpcurl
def test_services_are_listed_and_described(address: str) -> None:
    """`list` names services, `describe` gives a message's fields."""
    assert "stridewire.v1.AnimationService" in grpcurl(address, "list").splitlines()
    assert "velocity_xz" in grpcurl(address, "describe", "stridewire.v1.Step")


def test_health_is_serving(address: str, curl: Curl) -> None:
    """`Health/Check` says SERVING."""
    answer = curl(address, "grpc.health.v1.Health/Check", "{}")
    assert json.loads(answer) == {"status": "SERVING"}


def test_every_query_is_a_one_liner(address: str, curl: Curl, small_library: Library) -> None:
    """GetInfo, ListLibraries, GetLibrary, ListClips, GetClip, GetSkeleton and Search, as JSON."""
    name = small_library.clips[3].name
    library = "stridewire.v1.LibraryService"
    pose = {"clip": {"clip": name, "time_s": 1.0}}
    asked = {
        "stridewire.v1.ServerService/GetInfo": {},
        f"{library}/ListLibraries": {},
        f"{library}/GetLibrary": {"name": "small"},
        f"{library}/ListClips": {"page_size": 2, "tag": "walk"},
        f"{library}/GetClip": {"span": {"clip": name, "end_s": 0.1}},
        f"{library}/GetSkeleton": {},
        "stridewire.v1.MatchService/Search": {"pose": pose, "motion": {"velocity_z": 1}, "k": 3},
    }
    answers = {
        method.partition("/")[2]: json.loads(curl(address, method, json.dumps(query)))
        for method, query in asked.items()
    }
    assert answers["GetInfo"]["libraries"] == answers["ListLibraries"]["libraries"]
    assert answers["GetLibrary"]["library"]["name"] == "small"
    assert len(answers["ListClips"]["clips"]) == 2
    assert answers["GetClip"]["poses"]["frames"] == 7
    assert len(answers["GetSkeleton"]["skeleton"]["joints"]) == 22
    assert len(answers["Search"]["matches"]) == 3


def test_a_search_by_a_pose_is_pasted(address: str, curl: Curl, small_library: Library) -> None:
    """A pose that GetClip gave goes into Search as it is."""
    name = small_library.clips[3].name
    span = {"span": {"clip": name, "start_s": 0.5, "end_s": 0.5}}
    clip = json.loads(curl(address, "stridewire.v1.LibraryService/GetClip", json.dumps(span)))
    query = {"pose": {"inline": clip["poses"]}, "k": 2}
    answer = curl(address, "stridewire.v1.MatchService/Search", json.dumps(query))
    assert len(json.loads(answer)["matches"]) == 2


def test_a_scripted_session_comes_from_a_file(address: str, curl: Curl) -> None:
    """The example's session: frames for its steps, an error for its NaN, characters that change."""
    parts = objects(curl(address, ANIMATE, SESSION))
    assert parts[0]["opened"]["skeleton"]["joints"][0] == "Hips"
    frames = [part["frame"] for part in parts if "frame" in part]
    (error,) = [part["error"] for part in parts if "error" in part]
    # grpcurl keeps the names of the contract, buf uses those of JSON
    steps = [frame.get("applied_step") or frame["appliedStep"] for frame in frames]
    assert steps == [1, 2, 3, 4, 5]
    assert [frame["characters"] for frame in frames] == [[1, 2]] * 2 + [[1, 3]] * 3
    assert error["step"] == 4
    assert error["violations"][0]["field"] == "step.velocity_xz[0]"
    assert frames[-1]["root"][0] == pytest.approx(5.0, abs=0.1)
    assert len(frames[0]["rotations"]) == 2 * 22 * 4


def test_a_blend_is_pasted(address: str, curl: Curl, small_library: Library) -> None:
    """By reference and by the poses that GetClip gave, the same postures come back."""
    name = small_library.clips[3].name

    def moment(time_s: float) -> dict[str, object]:
        span = {"span": {"clip": name, "start_s": time_s, "end_s": time_s}}
        clip = json.loads(curl(address, "stridewire.v1.LibraryService/GetClip", json.dumps(span)))
        return {"inline": clip["poses"]}

    def blend(start: object, end: object) -> list[float]:
        query = {"start": start, "end": end, "weights": [0, 0.5, 1], "duration_s": 0.5}
        answer = curl(address, "stridewire.v1.BlendService/Blend", json.dumps(query))
        poses: dict[str, list[float]] = json.loads(answer)["poses"]
        assert len(poses["rotations"]) == 3 * 22 * 4
        return poses["rotations"]

    referred = [{"clip": {"clip": name, "time_s": time_s}} for time_s in (0.5, 1.0)]
    by_reference = blend(*referred)
    assert by_reference == pytest.approx(blend(moment(0.5), moment(1.0)), abs=1e-4)


def test_many_blends_are_one_call(address: str, curl: Curl, small_library: Library) -> None:
    """BlendMany answers each pair in order."""
    name = small_library.clips[3].name
    start, end = ({"clip": {"clip": name, "time_s": time_s}} for time_s in (0.5, 1.0))
    pairs = [{"start": start, "end": end, "weights": [0.5] * count} for count in (1, 3)]
    answer = curl(address, "stridewire.v1.BlendService/BlendMany", json.dumps({"requests": pairs}))
    frames = [response["poses"]["frames"] for response in json.loads(answer)["responses"]]
    assert frames == [1, 3]
