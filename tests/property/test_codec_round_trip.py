"""What is encoded for the wire and decoded again is what it was, for every message."""

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

from stridewire._codec import catalogue, queries, requests, responses, status
from stridewire._errors import ERROR_BY_CODE, StridewireError, Violation
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    ClientMessage,
    ClipEnd,
    ClipTime,
    Close,
    ContactChange,
    CorrectionMode,
    DesiredMotion,
    Detail,
    Edit,
    Event,
    ExcludedMatch,
    FallbackReason,
    Frame,
    Ground,
    GroundPose,
    Inside,
    LibraryInfo,
    Limits,
    Match,
    Notice,
    Open,
    Opened,
    Pacing,
    PoseFormat,
    RootCorrection,
    SearchQuery,
    SearchResult,
    ServerInfo,
    ServerMessage,
    Settings,
    Sparse,
    Step,
    StreamError,
    TagEntered,
    Trajectory,
    Transition,
    TransitionReason,
)
from stridewire.motion.array_types import Floats
from stridewire.motion.skeleton import REFERENCE
from stridewire.v1 import animation_pb2 as pb

uint = st.integers(0, 2**32 - 1)
double = st.floats(allow_nan=False)
single = st.floats(width=32, allow_nan=False)
text = st.text(st.characters(exclude_categories=("Cs",)), max_size=8)
name = st.text(st.characters(exclude_categories=("Cs",)), min_size=1, max_size=8)
weights = st.dictionaries(text, single, max_size=3)
# the bytes of a tick's times are kept for its other frames, by value: -0 is no time
times = st.dictionaries(text, single.map(abs), max_size=3)


def block(*shape: int) -> st.SearchStrategy[Floats]:
    """Draw any float32 values, NaN and infinity too."""
    return npst.arrays(np.float32, shape, elements=st.floats(width=32))


def ids(count: int) -> st.SearchStrategy[Any]:
    """Draw ids or masks."""
    return npst.arrays(np.uint32, count)


ground_poses = st.builds(GroundPose, st.tuples(single, single, single), single)
skeletons = st.just(REFERENCE)
specs = st.builds(
    CharacterSpec,
    id=uint,
    root=ground_poses,
    height_m=single,
    stitcher=text,
    filter=text,
    weights=weights,
    responsiveness=st.none() | single,
    foot_lock=st.booleans(),
    rate_divider=uint,
)
opens = st.builds(
    Open,
    characters=st.lists(specs, max_size=3).map(tuple),
    library=text,
    pacing=st.sampled_from(Pacing),
    rate_hz=st.floats(1.0, 1e3) | st.just(float("nan")),
    output_skeleton=st.none() | skeletons,
    format=st.sampled_from(PoseFormat),
    max_frames_in_flight=uint,
    detail=st.sampled_from(Detail),
    seed=uint,
    resume_token=text,
)


@st.composite
def trajectories(draw: st.DrawFn) -> Trajectory:
    """Draw points in time."""
    count = draw(st.integers(1, 4))
    return Trajectory(draw(block(count, 2)), draw(block(count)), draw(st.none() | block(count)))


grounds = st.builds(
    Ground,
    height=single,
    normal=st.tuples(single, single, single),
    foot_heights=st.none() | block(4),
    foot_normals=st.none() | block(4, 3),
)
sparse = st.builds(
    Sparse,
    character=uint,
    trajectory=st.none() | trajectories(),
    filter=st.none() | text,
    gait=st.none() | text,
    root_correction=st.none()
    | st.builds(RootCorrection, ground_poses, st.sampled_from(CorrectionMode)),
    ground=st.none() | grounds,
    force_search=st.booleans(),
)


@st.composite
def steps(draw: st.DrawFn) -> Step:
    """Draw a step for any number of characters."""
    count = draw(st.integers(1, 5))
    return Step(
        step=draw(uint),
        dt_s=draw(st.floats()),
        last_frame=draw(uint),
        client_time_s=draw(double),
        characters=draw(st.none() | ids(count)),
        velocity_xz=draw(st.none() | block(count, 2)),
        facing_yaw=draw(st.none() | block(count)),
        sparse=tuple(draw(st.lists(sparse, max_size=2))),
        ack_only=draw(st.booleans()),
    )


edits = st.builds(
    Edit,
    add=st.lists(specs, max_size=2).map(tuple),
    remove=st.lists(uint, max_size=3).map(tuple),
    update=st.lists(
        st.builds(CharacterUpdate, specs, st.lists(text, max_size=3).map(tuple)), max_size=2
    ).map(tuple),
)
library_infos = st.builds(
    LibraryInfo, text, text, uint, uint, double, st.booleans(), text, text, text
)
limits = st.builds(Limits, uint, double, double, uint, double)
opened = st.builds(
    Opened,
    session=text,
    skeleton=skeletons,
    library=library_infos,
    server_version=text,
    settings=st.builds(
        Settings,
        st.sampled_from(Pacing),
        double,
        uint,
        st.sampled_from(PoseFormat),
        st.sampled_from(Detail),
        uint,
        text,
    ),
    limits=limits,
    models=st.dictionaries(text, text, max_size=2),
    resume_token=text,
)
matches = st.builds(Match, text, double, st.lists(text).map(tuple), single, weights, single)
excluded = st.lists(st.builds(ExcludedMatch, matches, text), max_size=2).map(tuple)
transitions = st.builds(
    Transition,
    character=uint,
    frame=uint,
    from_clip=name,
    from_time_s=double,
    to_clip=name,
    to_time_s=double,
    reason=st.sampled_from(TransitionReason),
    cost=single,
    stay_cost=single,
    channels=weights,
    bias=single,
    runners_up=st.lists(matches, max_size=2).map(tuple),
    excluded=excluded,
    fallback=st.none() | st.sampled_from(FallbackReason),
    refined_frames=uint,
)
events: st.SearchStrategy[Event] = st.one_of(
    transitions,
    st.builds(ContactChange, uint, uint, uint, st.booleans()),
    st.builds(ClipEnd, uint, uint, text),
    st.builds(TagEntered, uint, uint, text),
)


@st.composite
def insides(draw: st.DrawFn, count: int, joints: int) -> Inside:
    """Draw what goes on behind a frame, with at least one time ahead."""
    times = draw(st.integers(1, 3))
    return Inside(
        draw(block(times)),
        draw(block(count, times, 3)),
        draw(block(count, times, 3)),
        draw(block(count, 3)),
        draw(block(count, joints, 4)),
    )


@st.composite
def frames(draw: st.DrawFn) -> Frame:
    """Draw a frame of any number of characters on a skeleton of any size."""
    count, joints = draw(st.integers(1, 3)), draw(st.integers(1, 4))
    return Frame(
        frame=draw(uint),
        applied_step=draw(uint),
        time_s=draw(double),
        client_time_s=draw(double),
        characters=draw(ids(count)),
        root=draw(block(count, 7)),
        root_delta=draw(block(count, 4)),
        hips=draw(block(count, 3)),
        rotations=draw(block(count, joints, 4)),
        contacts=draw(ids(count)),
        foot_targets=draw(block(count, 2, 3)),
        flags=draw(ids(count)),
        simulated_root=draw(st.none() | block(count, 4)),
        inside=draw(st.none() | insides(count, joints)),
        events=tuple(draw(st.lists(events, max_size=3))),
        dropped=draw(uint),
        searches=draw(uint),
        timings_ms=draw(times),
    )


errors = st.builds(
    StreamError, uint, st.lists(st.builds(Violation, text, text), max_size=3).map(tuple), uint
)
notices = st.builds(Notice, st.integers(0, 3), text, double, text)
moments = st.builds(ClipTime, text, double)
searches = st.builds(
    SearchQuery,
    pose=moments,
    intent=st.none()
    | trajectories()
    | st.builds(DesiredMotion, single, single, st.none() | single),
    k=st.integers(1, 1000),
    library=text,
    exclude=st.lists(moments, max_size=2).map(tuple),
    filter=text,
    weights=weights,
)
results = st.builds(
    SearchResult,
    st.lists(matches, max_size=2).map(tuple),
    text,
    text,
    excluded,
    st.booleans(),
)
infos = st.builds(
    ServerInfo,
    text,
    st.lists(library_infos, max_size=2).map(tuple),
    st.dictionaries(text, text, max_size=2),
    limits,
    st.lists(text, max_size=3).map(tuple),
    uint,
    uint,
)


def plain(value: Any) -> Any:
    """Turn dataclasses into what numpy can compare, NaN equal to NaN."""
    if value is REFERENCE or getattr(value, "hash", None) == REFERENCE.hash:
        return REFERENCE.hash
    if is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    return value


def assert_same(got: Any, expected: Any) -> None:
    """Compare kinds, values and shapes."""
    assert type(got) is type(expected)
    np.testing.assert_equal(plain(got), plain(expected))


@given(st.one_of(opens, steps(), edits, st.just(Close())))
def test_messages_of_a_client_survive_the_wire(message: ClientMessage) -> None:
    """Decoding undoes encoding, through real bytes."""
    wire = requests.encode_request(message)
    assert_same(requests.decode_request(type(wire).FromString(wire.SerializeToString())), message)


@given(st.one_of(frames(), opened, errors, notices))
def test_messages_of_a_server_survive_the_wire(message: ServerMessage) -> None:
    """Decoding undoes encoding, through real bytes."""
    wire = responses.encode_response(message)
    assert_same(responses.decode_response(type(wire).FromString(wire.SerializeToString())), message)


@given(searches)
def test_searches_survive_the_wire(query: SearchQuery) -> None:
    """Decoding undoes encoding."""
    assert_same(queries.decode_search(queries.encode_search(query)), query)


@given(results)
def test_search_results_survive_the_wire(result: SearchResult) -> None:
    """Decoding undoes encoding."""
    assert_same(queries.decode_search_result(queries.encode_search_result(result)), result)


@given(infos)
def test_server_info_survives_the_wire(info: ServerInfo) -> None:
    """Decoding undoes encoding."""
    assert_same(catalogue.decode_info(catalogue.encode_info(info)), info)


@given(
    st.sampled_from(sorted(ERROR_BY_CODE)),
    text,
    st.lists(st.builds(Violation, text, text), max_size=3),
    st.none() | st.integers(0, 10**6).map(lambda ms: ms / 1000.0),
)
def test_errors_survive_the_wire(
    code: str, message: str, violations: list[Violation], retry_after_s: float | None
) -> None:
    """Kind, message, violations and the time to wait come back."""
    error = ERROR_BY_CODE[code](message, violations, retry_after_s)
    got: StridewireError = status.decode_error(code, message, status.encode_details(error))
    assert (type(got), str(got), got.violations, got.retry_after_s) == (
        type(error),
        message,
        tuple(violations),
        retry_after_s,
    )


@given(frames())
def test_frames_are_the_same_by_hand(message: Frame) -> None:
    """Bytes written at once hold what the encoder's message holds."""
    written = pb.AnimateResponse.FromString(responses.response_bytes(message))
    # as bytes, for NaN equals nothing
    expected = responses.encode_response(message)
    assert written.SerializeToString(deterministic=True) == expected.SerializeToString(
        deterministic=True
    )
