"""One interface, four ways: every query, and every way to be refused, over every kind of client."""

import asyncio
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from serving import LoopThread, Serve
from stridewire import (
    AsyncClient,
    CharacterSpec,
    Client,
    DesiredMotion,
    InvalidRequestError,
    NotFoundError,
    ProtocolError,
    Trajectory,
)
from stridewire._messages import ClipsQuery
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import Library


def walk(library: Library) -> str:
    """Return the name of a clip that walks."""
    return next(clip.name for clip in library.clips if clip.name.startswith("walk"))


def test_info_tells_version_libraries_limits(either: Client, small_library: Library) -> None:
    """ServerService.GetInfo."""
    info = either.info()
    assert [library.name for library in info.libraries] == ["small"]
    assert info.libraries[0].content_hash == small_library.manifest.content_hash
    assert info.limits.max_characters == 4096
    assert "spring" in info.stitchers


def test_libraries_are_listed(either: Client, small_library: Library) -> None:
    """LibraryService.ListLibraries and GetLibrary."""
    assert either.libraries() == (small_library.info(),)
    details = either.library()
    assert details.info == small_library.info()
    assert details.seconds_by_tag == pytest.approx(small_library.seconds_by_tag())
    with pytest.raises(NotFoundError, match="no library 'nowhere'"):
        either.library("nowhere")


def test_clips_are_listed_over_all_pages(either: Client, small_library: Library) -> None:
    """LibraryService.ListClips: all, those of a name, those of a tag."""
    clips = list(either.clips())
    assert [clip.name for clip in clips] == [entry.name for entry in small_library.clips]
    assert [clip.frames for clip in clips] == [entry.frames for entry in small_library.clips]
    assert all("idle" in clip.name for clip in either.clips(name_contains="idle"))
    tagged = list(either.clips(tag="walk"))
    assert tagged
    assert all("walk" in {tag.name for tag in clip.tags} for clip in tagged)


def test_a_clip_comes_as_a_clip(either: Client, small_library: Library) -> None:
    """LibraryService.GetClip: poses, contacts and tags of a span are the library's."""
    name = walk(small_library)
    whole, there = either.clip(name), small_library.clip(name)
    for block in ("root_position", "root_rotation", "hips", "rotations"):
        np.testing.assert_allclose(
            getattr(whole.pose, block), getattr(there.pose, block), atol=1e-6
        )
    assert whole.contacts.tolist() == there.contacts.tolist()
    assert whole.tags == there.tags
    part = either.clip(name, start_s=0.5, end_s=1.0)
    assert (len(part), part.frame_rate) == (31, 60.0)
    np.testing.assert_array_equal(part.pose.rotations, whole.pose.rotations[30:61])


@pytest.mark.parametrize(
    ("span", "says"),
    [
        ((-0.1, 1.0), "-0.1 s to 1 s"),
        ((1.0, 0.5), "1 s to 0.5 s"),
        ((0.0, 1e6), "goes from 0 to"),
        ((float("nan"), 1.0), "nan s to 1 s"),
    ],
)
def test_a_span_outside_of_a_clip_is_refused(
    either: Client, small_library: Library, span: tuple[float, float], says: str
) -> None:
    """The field is named, what was given and what is allowed."""
    with pytest.raises(InvalidRequestError, match=says) as raised:
        either.clip(walk(small_library), start_s=span[0], end_s=span[1])
    assert [violation.field for violation in raised.value.violations] == ["span"]


def test_the_skeleton_is_the_librarys(either: Client) -> None:
    """LibraryService.GetSkeleton."""
    skeleton = either.skeleton()
    assert (skeleton.names, skeleton.parents) == (REFERENCE.names, REFERENCE.parents)
    np.testing.assert_allclose(skeleton.offsets, REFERENCE.offsets, atol=1e-6)


def test_a_search_by_a_moment_and_a_way(either: Client, small_library: Library) -> None:
    """MatchService.Search by clip and time with a velocity, and with points in time."""
    ways = Trajectory(np.float32([[0, 0.5], [0, 1.0]]), np.float32([0.4, 0.8]))
    for intent in (None, DesiredMotion(0.0, 1.3), ways):
        result = either.search(walk(small_library), 1.0, intent, k=4)
        assert len(result.matches) == 4
        costs = [match.cost for match in result.matches]
        assert costs == sorted(costs)


def test_a_search_by_a_pose_finds_where_it_was_taken(
    either: Client, small_library: Library
) -> None:
    """MatchService.Search by an inline pose: its own moment is among the best."""
    name = walk(small_library)
    pose = small_library.clip(name).pose[90]
    result = either.search(pose, k=20)
    found = [(match.clip, match.time_s) for match in result.matches]
    assert any(clip == name and abs(time_s - 1.5) < 0.05 for clip, time_s in found)
    velocities = [c for c in result.matches[0].channels if "velocity" in c]
    assert all(result.matches[0].channels[channel] == 0.0 for channel in velocities)
    ahead = either.search(pose, intent=DesiredMotion(0.0, 1.3), k=5)
    assert ahead.matches[0].channels["trajectory-position"] >= 0.0


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"rotations": np.zeros((22, 4), np.float32)}, "pose.inline.rotations"),
        ({"rotations": np.float32([[1, 0, 0, 0]] * 21)}, "pose.inline.rotations"),
        ({"hips": np.float32([0, np.nan, 0])}, "pose.inline.hips"),
        ({"root_rotation": np.float32([2, 0, 0, 0])}, "pose.inline.root"),
    ],
)
def test_a_pose_that_is_none_is_refused(
    either: Client, small_library: Library, change: dict[str, Any], field: str
) -> None:
    """Joints, norms and finite numbers are checked and named."""
    pose: Pose = replace(small_library.clip(walk(small_library)).pose[0], **change)
    with pytest.raises(InvalidRequestError) as raised:
        either.search(pose)
    assert [violation.field for violation in raised.value.violations] == [field]


def test_what_has_no_place_on_the_wire_is_refused(address: str) -> None:
    """A negative page size does not reach the server; it is refused with words all the same."""
    with Client(address) as client, pytest.raises(InvalidRequestError, match="ClipsQuery"):
        client._transport.ask(ClipsQuery(page_size=-1))


def test_a_session_that_is_closed_says_so(either: Client) -> None:
    """A control after the end is a ProtocolError; closing twice is harmless."""
    session = either.open_session().__enter__()
    assert session.step(velocity=(0.0, 1.0)).frame == 1
    session.close()
    session.close()
    with pytest.raises(ProtocolError):
        session.control(velocity=(0.0, 1.0))


def test_what_cannot_be_opened_is_refused(either: Client) -> None:
    """Every field is named; a library that is not there is not found."""
    with pytest.raises(InvalidRequestError) as raised:
        either.open_session([CharacterSpec(1), CharacterSpec(1)], rate_hz=1.0).__enter__()
    fields = [violation.field for violation in raised.value.violations]
    assert fields == ["open.rate_hz", "open.characters[1].id"]
    with pytest.raises(NotFoundError):
        either.open_session(library="nowhere").__enter__()


def test_many_sessions_of_asyncio_share_a_loop(serve: Serve, loop_thread: LoopThread) -> None:
    """Sixteen sessions advance side by side on one connection."""
    address = serve()

    async def drive() -> list[int]:
        async with AsyncClient(address, timeout_s=20.0) as client:

            async def one(seed: int) -> int:
                async with client.open_session(2, seed=seed) as session:
                    for _ in range(20):
                        frame = await session.step(velocity=(0.0, 1.2))
                return frame.frame

            return await asyncio.gather(*map(one, range(16)))

    assert loop_thread.call(drive()) == [20] * 16
