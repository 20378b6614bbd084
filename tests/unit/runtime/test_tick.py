"""The tick: characters go where they are sent, their poses continue, and nothing grows with N."""

import gc
import sys
import tracemalloc
from collections.abc import Callable, Iterator
from copy import copy
from types import FrameType

import numpy as np
import pytest

from stridewire._messages import (
    ClipEnd,
    Frame,
    Open,
    Step,
    TagEntered,
    Transition,
    TransitionReason,
)
from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session, TickSettings
from unit.runtime.conftest import DT, opening

Walk = Callable[..., Iterator[Frame]]

WAITING = ("threading.py", "concurrent/futures/_base.py", "concurrent/futures/thread.py")


def joints(frame: Frame) -> np.ndarray:
    """Return the joints `(N, J, 3)` in the world."""
    pose = Pose(frame.root[:, :3], frame.root[:, 3:], frame.hips, frame.rotations)
    return kinematics.forward_world(REFERENCE, pose)[0]


def open_session(runtime: Runtime, count: int, **changes: object) -> Session:
    """Open a session of so many characters."""
    return runtime.open(opening(count, **changes))


def test_a_character_walks_where_it_is_sent(runtime: Runtime, walk: Walk) -> None:
    """After three seconds it moves at about the desired speed, in its direction, facing along."""
    frames = list(walk(open_session(runtime, 1), 4.0, (0.0, 1.4)))
    way = frames[-1].root[0, [0, 2]] - frames[-61].root[0, [0, 2]]
    assert np.linalg.norm(way) == pytest.approx(1.4, rel=0.15)
    assert abs(np.arctan2(way[0], way[1])) < np.radians(10)
    assert abs(quaternion.to_yaw(frames[-1].root[0, 3:])) < np.radians(20)


def test_characters_with_different_controls_go_different_ways(runtime: Runtime) -> None:
    """Rows of one session do not share controls."""
    session = open_session(runtime, 2)
    velocity = np.array([[0.0, 1.4], [1.4, 0.0]])
    for i in range(240):
        ((frame, _),) = runtime.advance([(session, Step(i, DT, velocity_xz=velocity))])
    moved = frame.root[:, [0, 2]] - [[0.0, 0.0], [3.0, 0.0]]
    assert moved[0, 1] > 2.0
    assert abs(moved[0, 0]) < 1.0
    assert moved[1, 0] > 2.0
    assert abs(moved[1, 1]) < 1.0


def test_a_standing_character_stays_where_it_is(runtime: Runtime, walk: Walk) -> None:
    """Without a desired velocity a character drifts less than a hand's breadth in five seconds."""
    frames = list(walk(open_session(runtime, 3), 5.0, (0.0, 0.0)))
    assert np.linalg.norm(frames[-1].root[:, :3] - frames[0].root[:, :3], axis=1).max() < 0.1


def test_poses_are_unit_and_finite(runtime: Runtime, walk: Walk) -> None:
    """Every quaternion that is sent has unit length, every number is finite."""
    for frame in walk(open_session(runtime, 4), 3.0, (1.0, 1.0)):
        assert np.allclose(np.linalg.norm(frame.rotations, axis=-1), 1.0, atol=1e-5)
        assert np.allclose(np.linalg.norm(frame.root[:, 3:], axis=-1), 1.0, atol=1e-5)
        assert np.isfinite(frame.hips).all()


def test_transitions_do_not_pop(runtime: Runtime, walk: Walk) -> None:
    """With the spring no joint's step changes more at a transition than it ever does in a clip."""
    session = open_session(runtime, 4)
    frames = [*walk(session, 2.0, (0.0, 1.4)), *walk(session, 2.0, (1.4, 0.0))]
    assert any(isinstance(event, Transition) for frame in frames[1:] for event in frame.events)
    positions = np.stack([joints(frame) for frame in frames])
    change = np.linalg.norm(np.diff(positions, n=2, axis=0), axis=-1) / DT
    library = runtime.library("")
    captured = []
    for entry in library.clips:
        world, _ = kinematics.forward_world(REFERENCE, library.clip(entry.name).pose)
        captured.append(np.linalg.norm(np.diff(world, n=2, axis=0), axis=-1).max() / DT)
    assert change.max() < 1.5 * max(captured)


def test_a_cut_pops_where_the_spring_does_not(runtime: Runtime) -> None:
    """The stitcher `none` shows the seams that `spring` hides."""
    largest = {}
    for name in ("none", "spring"):
        specs = [spec for spec in opening(1).characters]
        session = runtime.open(Open([type(specs[0])(10, stitcher=name, foot_lock=False)], seed=7))
        positions = []
        for i in range(300):
            velocity = [[0.0, 1.4]] if i < 150 else [[-1.4, 0.0]]
            ((frame, _),) = runtime.advance([(session, Step(i, DT, velocity_xz=velocity))])
            positions.append(joints(frame)[0] - frame.root[0, :3])
        steps = np.linalg.norm(np.diff(np.array(positions), axis=0), axis=-1)
        largest[name] = steps[1:].max()
    assert largest["none"] > 2.0 * largest["spring"]


def test_planted_feet_stay_put(runtime: Runtime, walk: Walk) -> None:
    """Where a foot is locked, the toe that is sent stays within centimetres of its lock point."""
    frames = list(walk(open_session(runtime, 4), 4.0, (0.0, 1.4)))
    toes = np.stack([joints(frame)[:, [4, 8]] for frame in frames])
    targets = np.stack([frame.foot_targets for frame in frames])
    locked = ~np.isnan(targets[..., 0])
    assert 0.2 < locked.mean() < 0.95
    offset = np.linalg.norm((targets - toes)[..., [0, 2]], axis=-1)[locked]
    assert np.percentile(offset, 95) < 0.04


def test_without_foot_lock_no_target_is_sent(runtime: Runtime) -> None:
    """`foot_lock` off means no locked feet."""
    specs = opening(1).characters
    session = runtime.open(Open([type(specs[0])(1, foot_lock=False)]))
    for i in range(60):
        ((frame, _),) = runtime.advance([(session, Step(i, DT, velocity_xz=[[0, 1.4]]))])
        assert np.isnan(frame.foot_targets).all()


def test_root_deltas_add_up_to_the_root(runtime: Runtime, walk: Walk) -> None:
    """Applying every root delta one after the other gives the root that is sent."""
    frames = list(walk(open_session(runtime, 1), 3.0, (1.0, 1.0)))
    position, yaw = np.zeros(3), 0.0
    for frame in frames:
        delta = frame.root_delta[0].astype(np.float64)
        turn = quaternion.from_yaw(np.array(yaw))
        position = position + quaternion.rotate(turn, delta[:3])
        yaw += delta[3]
    assert np.allclose(position, frames[-1].root[0, :3], atol=1e-3)
    assert np.isclose(yaw, quaternion.to_yaw(frames[-1].root[0, 3:]), atol=1e-3)


def test_a_pause_repeats_the_pose(runtime: Runtime, walk: Walk) -> None:
    """A step of no time gives the same pose again, to the last bit, however often."""
    session = open_session(runtime, 2)
    *_, before = walk(session, 1.0, (0.0, 1.4))
    for i in range(20):
        ((frame, _),) = runtime.advance([(session, Step(i, 0.0))])
        assert np.array_equal(frame.rotations, before.rotations)
        assert np.array_equal(frame.root, before.root)
    assert frame.time_s == before.time_s


def test_a_hitch_keeps_the_character_on_its_way(runtime: Runtime, walk: Walk) -> None:
    """Steps of a quarter of a second move it about as far as fifteen of a sixtieth."""
    session = open_session(runtime, 1)
    *_, before = walk(session, 2.0, (0.0, 1.4))
    *_, after = walk(session, 2.0, (0.0, 1.4), dt=0.25)
    assert after.root[0, 2] - before.root[0, 2] == pytest.approx(2.8, rel=0.25)


def test_events_tell_transitions_with_costs(runtime: Runtime, walk: Walk) -> None:
    """A transition says from where to where, why, and its cost by channel adds up."""
    events = [e for frame in walk(open_session(runtime, 2), 4.0, (0.0, 1.4)) for e in frame.events]
    transitions = [event for event in events if isinstance(event, Transition)]
    starts = [t for t in transitions if t.reason is TransitionReason.START]
    assert {t.character for t in starts} == {10, 11}
    assert all(t.from_clip == "" for t in starts)
    names = {clip.name for clip in runtime.library("").clips}
    for transition in transitions:
        assert transition.to_clip in names
        assert sum(transition.channels.values()) == pytest.approx(transition.cost, rel=1e-6)
    later = [t for t in transitions if t.reason is TransitionReason.BETTER_MATCH]
    assert all(t.cost < t.stay_cost for t in later)
    assert any(isinstance(event, TagEntered) and event.tag == "walk" for event in events)


def test_a_control_jump_is_searched_at_once(runtime: Runtime, walk: Walk) -> None:
    """A sudden command is answered by a transition within a few frames."""
    session = open_session(runtime, 1)
    list(walk(session, 2.0, (0.0, 0.0)))
    for i, frame in enumerate(walk(session, 0.5, (0.0, 3.0))):
        changes = [e for e in frame.events if isinstance(e, Transition)]
        if changes:
            assert changes[0].reason is TransitionReason.CONTROL_CHANGE
            assert i <= 4
            return
    pytest.fail("no transition within half a second of the command")


def test_a_clip_is_left_before_its_end(small_library: Library) -> None:
    """Playback never runs out: the end of a clip is an event and a transition in time."""
    finite = copy(small_library)
    finite.loops = np.zeros_like(small_library.loops)
    stubborn = TickSettings(continuing_bias=1e6)
    runtime = Runtime([finite], clock=lambda: 0.0, settings=stubborn)
    session, velocity = runtime.open(opening(2)), [[0.0, 1.4]] * 2
    steps = [Step(i, DT, velocity_xz=velocity) for i in range(1200)]
    frames = [runtime.advance([(session, step)])[0][0] for step in steps]
    assert any(isinstance(event, ClipEnd) for frame in frames for event in frame.events)
    positions = np.stack([joints(frame) for frame in frames[60:]])
    moving = np.linalg.norm(np.diff(positions, axis=0), axis=-1).max(axis=(1, 2))
    assert np.count_nonzero(moving == 0.0) < 5


def test_a_character_alone_is_bit_for_bit_what_it_is_again(small_library: Library) -> None:
    """The same inputs give the same bytes."""
    streams = []
    for _ in range(2):
        runtime = Runtime([small_library], clock=lambda: 0.0)
        session = runtime.open(opening(3))
        frames = [
            runtime.advance([(session, Step(i, DT, velocity_xz=[[0, 1.4]] * 3))])[0][0]
            for i in range(120)
        ]
        streams.append(np.stack([frame.rotations for frame in frames]).tobytes())
    assert streams[0] == streams[1]


def test_neighbours_do_not_change_a_character(small_library: Library) -> None:
    """Alone or among other sessions in one tick: the same clips and times, poses to 1e-5."""
    alone, crowded = (Runtime([small_library], clock=lambda: 0.0) for _ in range(2))
    single, among = alone.open(opening(2)), crowded.open(opening(2))
    other = crowded.open(opening(30, seed=3))
    for i in range(200):
        step = Step(i, DT, velocity_xz=[[0.0, 1.4], [1.0, 0.0]])
        noise = Step(i, DT, velocity_xz=np.tile([-1.0, 0.5], (30, 1)))
        ((expected, _),) = alone.advance([(single, step)])
        (_, _), (frame, _) = crowded.advance([(other, noise), (among, step)])
        assert [e for e in frame.events if isinstance(e, Transition)] == pytest.approx(
            [e for e in expected.events if isinstance(e, Transition)]
        )
        assert np.allclose(frame.rotations, expected.rotations, atol=1e-5)
        assert np.allclose(frame.root, expected.root, atol=1e-5)


def python_calls(runtime: Runtime, session: Session, step: Step) -> int:
    """Count the calls of Python and C functions during one tick."""
    count = 0

    def hook(frame: FrameType, event: str, argument: object) -> None:
        nonlocal count
        # how often a thread looks before the other one is done is chance
        waits = frame.f_code.co_filename.endswith(WAITING)
        count += event in ("call", "c_call") and not waits

    gc.disable()
    sys.setprofile(hook)
    try:
        runtime.advance([(session, step)])
    finally:
        sys.setprofile(None)
        gc.enable()
    return count


@pytest.mark.parametrize("phase", ["playing", "searching", "starting"])
def test_calls_per_tick_do_not_grow_with_characters(small_library: Library, phase: str) -> None:
    """At 8 and 256 characters in the same situation a tick makes exactly as many Python calls."""
    counts = []
    for characters in (8, 256):
        runtime = Runtime([small_library], clock=lambda: 0.0)
        session = runtime.open(opening(characters))
        state = session.crowd.state
        velocity = np.tile([0.0, 1.4], (characters, 1))
        if phase != "starting":
            for i in range(90):
                runtime.advance([(session, Step(i, DT, velocity_xz=velocity))])
            state.until_search[:] = 0.5 * DT if phase == "searching" else 1.0
            for name in ("clip", "clip_time", "since_jump", "stitcher"):
                array = getattr(state, name)
                array[:] = array[0]
        counts.append(python_calls(runtime, session, Step(100, DT, velocity_xz=velocity)))
    assert counts[0] == counts[1] > 100


def test_memory_does_not_grow(small_library: Library) -> None:
    """After warming up, a thousand ticks leave no more memory in use than before."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(opening(2))
    steps = [
        Step(i, DT, velocity_xz=np.tile(v, (2, 1)))
        for i, v in enumerate([(0.0, 1.4), (1.0, 0.0), (0.0, 0.0), (-1.0, -1.0)])
    ]
    tracemalloc.start()
    try:
        for i in range(1300):
            if i == 300:
                gc.collect()
                before = tracemalloc.get_traced_memory()[0]
            runtime.advance([(session, steps[(i // 60) % 4])])
        gc.collect()
        grown = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert grown < 64 * 1024
