"""Over gRPC and in this process, blocking and awaited, the same messages give the same frames."""

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from stridewire import Client
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    ClipTime,
    DesiredMotion,
    Detail,
    Frame,
    GroundPose,
    Pacing,
    Sparse,
    Trajectory,
)
from stridewire._session import Session
from stridewire.scripts import script
from stridewire_engine.library import Library

POSE_TOLERANCE = 1e-5
"""Metres and quaternion components: float32 on the way, and rows that lie elsewhere in memory."""

COST_TOLERANCE = 1e-4
"""Relative; costs are made of squared differences of such numbers."""

Play = Callable[[Session], list[Frame]]


def follow_a_script(session: Session) -> list[Frame]:
    """Ask for what a script asks for."""
    controls = script("random-stick").controls
    return [session.step(*controls(i / 60.0, len(session.characters), 5)) for i in range(240)]


def hitch_and_pause(session: Session) -> list[Frame]:
    """Step by uneven times, none at all and too much."""
    steps = [0.016, 0.034, 0.0, 0.0, 0.1, 0.9, 0.005, 0.016] * 10
    return [session.step(velocity=(0.5, 1.0), facing=0.3, dt=dt) for dt in steps]


def come_and_go(session: Session) -> list[Frame]:
    """Add, remove, change, teleport and correct characters on the way."""
    frames = [session.step(velocity=(0.0, 1.2)) for _ in range(30)]
    session.edit(add=[CharacterSpec(50, GroundPose((3.0, 0.0, 1.0), 1.0))], remove=[1])
    frames += [session.step(velocity=(1.0, 0.0)) for _ in range(30)]
    session.edit(update=[CharacterUpdate(CharacterSpec(50, stitcher="none"), ("stitcher",))])
    session.teleport(50, (-4.0, 0.5, 2.0), 2.0)
    session.correct_root(0, (0.3, 0.0, 0.3), 0.1)
    return frames + [session.step() for _ in range(60)]


def follow_paths(session: Session) -> list[Frame]:
    """Give trajectories, force searches, refuse nonsense."""
    path = Trajectory(np.float32([[0, 1], [1, 2], [2, 2]]), np.float32([0.5, 1.5, 2.5]))
    frames = [session.step(sparse=[Sparse(0, trajectory=path), Sparse(2, force_search=True)])]
    frames += [session.step(dt=1 / 30) for _ in range(60)]
    frames.append(session.step(velocity=[[np.nan, 0.0]] * len(session.characters)))
    return frames


@pytest.mark.parametrize("detail", [Detail.EVENTS, Detail.COSTS, Detail.NONE])
@pytest.mark.parametrize("play", [follow_a_script, hitch_and_pause, come_and_go, follow_paths])
def test_frames_are_the_same(
    either: Client, small_library: Library, play: Play, detail: Detail
) -> None:
    """Counters, times, events and flags are equal, poses within the tolerance, errors equal."""
    runs = []
    for target in (either, Client.in_process(small_library.path)):
        with target.open_session(3, detail=detail, seed=11) as session:
            runs.append((play(session), [error.violations for error in session.errors]))
    (over_wire, refused_over_wire), (here, refused_here) = runs
    assert refused_over_wire == refused_here
    for a, b in zip(over_wire, here, strict=True):
        assert (a.frame, a.applied_step, a.time_s) == (b.frame, b.applied_step, b.time_s)
        assert a.characters.tolist() == b.characters.tolist()
        assert a.flags.tolist() == b.flags.tolist()
        assert a.contacts.tolist() == b.contacts.tolist()
        assert_same_events(a, b)
        for name in ("root", "root_delta", "hips", "rotations", "foot_targets"):
            np.testing.assert_allclose(getattr(a, name), getattr(b, name), atol=POSE_TOLERANCE)
        assert (a.simulated_root is None) == (b.simulated_root is None)


def assert_same_events(a: Frame, b: Frame) -> None:
    """Compare kinds, clips and times exactly, costs within the poses' tolerance."""
    costs_a: list[float] = []
    costs_b: list[float] = []
    assert [told(e, costs_a) for e in a.events] == [told(e, costs_b) for e in b.events]
    np.testing.assert_allclose(costs_a, costs_b, rtol=COST_TOLERANCE, atol=POSE_TOLERANCE)


def told(value: object, costs: list[float], name: str = "") -> object:
    """Return what can be compared exactly; every cost, however deep, is put aside."""
    if is_dataclass(value):
        inner = {field.name: getattr(value, field.name) for field in fields(value)}
        return type(value), {key: told(item, costs, key) for key, item in inner.items()}
    if isinstance(value, Mapping):
        return {key: told(item, costs, name) for key, item in value.items()}
    if isinstance(value, tuple | list):
        return [told(item, costs, name) for item in value]
    if isinstance(value, float) and not name.endswith("time_s"):
        costs.append(value)
        return None
    return value


def test_searches_are_the_same(either: Client, small_library: Library) -> None:
    """The same clips and times in the same order, costs as float32."""
    here = Client.in_process(small_library.path)
    name = small_library.clips[3].name
    for intent in (None, DesiredMotion(0.5, 1.2), DesiredMotion(0.0, 0.0, 1.0)):
        exclude = [ClipTime(name, 1.5)]
        a, b = (target.search(name, 1.5, intent, k=9, exclude=exclude) for target in (either, here))
        assert [(m.clip, m.time_s, m.tags) for m in a.matches] == [
            (m.clip, m.time_s, m.tags) for m in b.matches
        ]
        assert [m.cost for m in a.matches] == pytest.approx([m.cost for m in b.matches], rel=1e-6)
        assert (a.library, a.content_hash) == (b.library, b.content_hash)


def test_paced_sessions_have_the_same_surface(either: Client) -> None:
    """With server pacing frames are evenly timed and follow the newest control."""
    with either.open_session(pacing=Pacing.SERVER, rate_hz=120.0) as session:
        session.control(velocity=(0.0, 1.0))
        number = session.control(velocity=(0.0, 1.4))
        times = []
        for frame in session.frames():
            times.append(frame.time_s)
            if frame.applied_step == number and len(times) >= 20:
                break
    np.testing.assert_allclose(np.diff(times), 1.0 / 120.0, atol=1e-9)
