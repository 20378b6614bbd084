"""Unary services over a real server: search, libraries, clips, server, health, reflection."""

from collections.abc import Iterator

import grpc
import numpy as np
import pytest
from grpc_health.v1 import health_pb2, health_pb2_grpc
from grpc_reflection.v1alpha.proto_reflection_descriptor_database import (
    ProtoReflectionDescriptorDatabase,
)

from stridewire import Client, InvalidRequestError, NotFoundError
from stridewire._messages import ClipTime, DesiredMotion
from stridewire.v1 import library_pb2 as pb
from stridewire.v1 import pose_pb2
from stridewire.v1.library_pb2_grpc import LibraryServiceStub
from stridewire_engine.library import Library

SERVICES = (
    "AnimationService",
    "BlendService",
    "MatchService",
    "LibraryService",
    "ServerService",
)


@pytest.fixture
def channel(address: str) -> Iterator[grpc.Channel]:
    """Return a plain channel to the shared server."""
    with grpc.insecure_channel(address) as opened:
        yield opened


@pytest.fixture
def libraries(channel: grpc.Channel) -> LibraryServiceStub:
    """Return a plain stub of LibraryService."""
    return LibraryServiceStub(channel)


def test_a_search_returns_the_moment_itself_first(client: Client, small_library: Library) -> None:
    """Continuing where the clip goes, nothing fits better than that very moment; costs add up."""
    name = small_library.clips[4].name
    result = client.search(name, 1.5, k=7)
    first, *others = result.matches
    assert (first.clip, first.time_s, first.cost) == (name, 1.5, 0.0)
    assert len(others) == 6
    costs = [match.cost for match in result.matches]
    assert costs == sorted(costs)
    for match in result.matches:
        assert sum(match.channels.values()) == pytest.approx(match.cost, abs=1e-5)


def test_excluded_moments_are_not_found(client: Client, small_library: Library) -> None:
    """Neither the moment nor its neighbourhood of a third of a second is among the matches."""
    name = small_library.clips[4].name
    result = client.search(name, 1.5, k=50, exclude=[ClipTime(name, 1.5)])
    assert not any(m.clip == name and abs(m.time_s - 1.5) < 0.3 for m in result.matches)


def test_what_cannot_be_searched_is_refused(client: Client, small_library: Library) -> None:
    """Unknown clips and libraries, times outside, too many matches, speeds beyond the limit."""
    name = small_library.clips[0].name
    with pytest.raises(NotFoundError, match="has no clip 'moonwalk'"):
        client.search("moonwalk", 0.0)
    with pytest.raises(NotFoundError, match="no library 'nowhere'"):
        client.search(name, 0.0, library="nowhere")
    for wrong in (
        lambda: client.search(name, 1e4),
        lambda: client.search(name, float("nan")),
        lambda: client.search(name, 0.0, k=5000),
        lambda: client.search(name, 0.0, DesiredMotion(99.0, 0.0)),
        lambda: client.search(name, 0.0, DesiredMotion(float("nan"), 0.0)),
    ):
        with pytest.raises(InvalidRequestError) as raised:
            wrong()
        assert len(raised.value.violations) == 1


def test_info_tells_libraries_limits_and_load(client: Client, small_library: Library) -> None:
    """What the server says of itself fits its library and the open session."""
    with client.open_session(5) as session:
        session.step()
        info = client.info()
        assert info.characters >= 5
        assert info.sessions >= 1
    assert info.libraries == (small_library.info(),)
    assert info.limits.max_message_bytes == 1 << 20
    assert "spring" in info.stitchers


def test_clips_are_listed_page_by_page(
    libraries: LibraryServiceStub, small_library: Library
) -> None:
    """All pages together are the library's clips in order; filters by name and tag narrow them."""
    names, token = [], ""
    while True:
        page = libraries.ListClips(pb.ListClipsRequest(page_size=3, page_token=token))
        assert page.total == len(small_library.clips)
        names += [clip.name for clip in page.clips]
        token = page.next_page_token
        if not token:
            break
    assert names == [clip.name for clip in small_library.clips]
    walks = libraries.ListClips(pb.ListClipsRequest(name_contains="walk", tag="walk")).clips
    assert walks
    assert all("walk" in clip.name and "walk" in {t.name for t in clip.tags} for clip in walks)


def test_a_clip_is_given_by_range(libraries: LibraryServiceStub, small_library: Library) -> None:
    """Poses and contacts are the library's, from the first to the last frame of the span."""
    clip = small_library.clip(small_library.clips[2].name)
    span = pose_pb2.ClipSpan(clip=clip.name, start_s=0.5, end_s=1.0)
    response = libraries.GetClip(pb.GetClipRequest(span=span))
    assert response.poses.frames == 31
    rotations = np.array(response.poses.rotations).reshape(31, len(clip.skeleton), 4)
    np.testing.assert_allclose(rotations, clip.pose.rotations[30:61], atol=1e-6)
    root = np.array(response.poses.root).reshape(31, 7)
    np.testing.assert_allclose(root[:, :3], clip.pose.root_position[30:61], atol=1e-6)
    assert len(response.contacts) == 31
    assert response.clip.name == clip.name


@pytest.mark.parametrize(
    ("request_", "code", "says"),
    [
        (pb.ListClipsRequest(page_size=5000), "INVALID_ARGUMENT", "page_size: 5000"),
        (pb.ListClipsRequest(page_token="x"), "INVALID_ARGUMENT", "page_token: 'x'"),
        (pb.ListClipsRequest(library="nowhere"), "NOT_FOUND", "no library 'nowhere'"),
        (pb.GetLibraryRequest(name="nowhere"), "NOT_FOUND", "no library 'nowhere'"),
        (pb.GetSkeletonRequest(library="nowhere"), "NOT_FOUND", "no library 'nowhere'"),
        (
            pb.GetClipRequest(span=pose_pb2.ClipSpan(clip="moonwalk")),
            "NOT_FOUND",
            "no clip 'moonwalk'",
        ),
        (
            pb.GetClipRequest(span=pose_pb2.ClipSpan(clip="idle-1", start_s=3.0, end_s=2.0)),
            "INVALID_ARGUMENT",
            "span: 3 s to 2 s",
        ),
        (
            pb.GetClipRequest(span=pose_pb2.ClipSpan(clip="idle-1", end_s=float("nan"))),
            "INVALID_ARGUMENT",
            "nan",
        ),
    ],
)
def test_what_cannot_be_listed_is_refused(
    libraries: LibraryServiceStub, request_: object, code: str, says: str
) -> None:
    """Each wrong request is answered with code and reason."""
    method = type(request_).__name__.removesuffix("Request")
    with pytest.raises(grpc.RpcError) as raised:
        getattr(libraries, method)(request_)
    assert raised.value.code().name == code
    assert says in raised.value.details()


def test_libraries_and_skeletons(libraries: LibraryServiceStub, small_library: Library) -> None:
    """The library, its seconds by tag, its skeleton."""
    (info,) = libraries.ListLibraries(pb.ListLibrariesRequest()).libraries
    assert (info.name, info.clips) == ("small", len(small_library.clips))
    got = libraries.GetLibrary(pb.GetLibraryRequest(name="small"))
    assert got.library == info
    assert dict(got.seconds_by_tag) == small_library.seconds_by_tag()
    skeleton = libraries.GetSkeleton(pb.GetSkeletonRequest()).skeleton
    assert tuple(skeleton.joints) == small_library.skeleton.names


def test_health_by_service(channel: grpc.Channel) -> None:
    """The server and what it offers are serving."""
    check = health_pb2_grpc.HealthStub(channel).Check

    def state(service: str) -> int:
        return int(check(health_pb2.HealthCheckRequest(service=service)).status)

    serving = health_pb2.HealthCheckResponse.SERVING
    assert state("") == serving
    assert {state(f"stridewire.v1.{name}") for name in SERVICES} == {serving}


def test_reflection_names_every_service(channel: grpc.Channel) -> None:
    """Tools find all services without the proto files."""
    names = set(ProtoReflectionDescriptorDatabase(channel).get_services())
    ours = {f"stridewire.v1.{name}" for name in (*SERVICES, "BlendService", "StitchService")}
    assert ours | {"grpc.health.v1.Health"} <= names
