"""Filters, weights and loops in the tick: one search per filter, the tag's change at once."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stridewire._messages import (
    CharacterSpec,
    Frame,
    Sparse,
    Step,
    Transition,
    TransitionReason,
)
from stridewire.motion import quaternion
from stridewire.motion.clip import Clip, Pose, TagSpan
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building import build_library
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.runtime import Runtime
from stridewire_engine.runtime.settings import TickSettings
from unit.runtime.conftest import DT, opening

Walk = Callable[..., Iterator[Frame]]


def specs(*filters: str) -> list[CharacterSpec]:
    """Return characters with these filters."""
    return [CharacterSpec(10 + i, filter=text) for i, text in enumerate(filters)]


def test_a_filtered_character_plays_nothing_else(runtime: Runtime, walk: Walk) -> None:
    """A character filtered to walks walks, however fast it is to go."""
    session = runtime.open(opening(1, characters=specs("walk & !run")))
    library = runtime.library("")
    for frame in walk(session, 3.0, (0.0, 3.0)):
        for event in frame.events:
            if isinstance(event, Transition):
                entry = library.entry(event.to_clip)
                row = entry.start + round(event.to_time_s * 60)
                assert "walk" in library.tags_at(row)
                assert "run" not in library.tags_at(row)


def test_a_change_of_filter_is_obeyed_in_the_same_frame(runtime: Runtime, walk: Walk) -> None:
    """A walking character told to run by filter leaves its walk at once and says why."""
    session = runtime.open(opening(1, characters=specs("walk")))
    list(walk(session, 2.0, (0.0, 1.3)))
    change = Step(1, DT, sparse=[Sparse(10, filter="run")])
    ((frame, error),) = runtime.advance([(session, change)])
    assert error is None
    (transition,) = [event for event in frame.events if isinstance(event, Transition)]
    assert transition.reason is TransitionReason.FILTER_CHANGE


def test_a_gait_is_a_filter(runtime: Runtime, walk: Walk) -> None:
    """`gait: walk` keeps a character that is to run at a walk, `any` lets it run."""
    session = runtime.open(opening(1))
    runtime.advance([(session, Step(1, DT, sparse=[Sparse(10, gait="walk")]))])
    *_, first, _ = walk(session, 3.0, (0.0, 3.2))
    frames = list(walk(session, 1.0, (0.0, 3.2)))
    slow = np.linalg.norm(frames[-1].root[0, :3] - first.root[0, :3])
    runtime.advance([(session, Step(1, DT, sparse=[Sparse(10, gait="any")]))])
    list(walk(session, 2.0, (0.0, 3.2)))
    frames = list(walk(session, 1.0, (0.0, 3.2)))
    fast = np.linalg.norm(frames[-1].root[0, :3] - frames[0].root[0, :3])
    assert slow + 0.3 < fast


@pytest.mark.parametrize(
    ("filters", "searches"),
    [(("", "", ""), 1), (("walk", "walk", "walk"), 1), (("walk", "", "walk", "idle", ""), 3)],
)
def test_one_search_per_distinct_filter(
    runtime: Runtime, filters: tuple[str, ...], searches: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tick asks the index once for each filter among the searching characters."""
    session = runtime.open(opening(1, characters=specs(*filters)))
    crowd = session.crowd
    calls = []
    original = type(crowd.matcher).search

    def counted(self: object, queries: np.ndarray, *rest: object) -> object:
        calls.append(len(queries))
        return original(self, queries, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(type(crowd.matcher), "search", counted)
    runtime.advance([(session, Step(1, DT))])
    assert len(calls) == searches
    assert sum(calls) == len(filters)


def test_weights_belong_to_a_character(runtime: Runtime) -> None:
    """One character's weights change its costs alone, exactly in proportion."""
    doubled = {
        c.name: 2.0 * c.weight for c in runtime.open(opening(1)).crowd.matcher.schema.channels
    }
    characters = [CharacterSpec(10), CharacterSpec(11, weights=doubled)]
    session = runtime.open(opening(1, characters=characters))
    ((frame, _),) = runtime.advance([(session, Step(1, DT, velocity_xz=[[0.0, 1.0]] * 2))])
    plain, other = [event for event in frame.events if isinstance(event, Transition)]
    assert (plain.to_clip, plain.to_time_s) == (other.to_clip, other.to_time_s)
    assert other.cost == pytest.approx(2.0 * plain.cost)


def test_transitions_explain_themselves(runtime: Runtime, walk: Walk) -> None:
    """With costs, a transition names runners-up in order and why nearer moments were left out."""
    session = runtime.open(opening(1))
    events = [
        event
        for frame in walk(session, 4.0, (0.5, 1.2))
        for event in frame.events
        if isinstance(event, Transition) and event.reason is TransitionReason.BETTER_MATCH
    ]
    assert events
    for event in events:
        assert event.cost + event.bias <= event.stay_cost + 1e-9
        costs = [event.cost, *(match.cost for match in event.runners_up)]
        assert costs == sorted(costs)
        assert len(event.runners_up) == 2
        assert all(e.match.cost <= costs[-1] for e in event.excluded)
    reasons = {excluded.reason for event in events for excluded in event.excluded}
    assert reasons <= {
        "is playing now",
        "is the mirror image of what is playing now",
        "was chosen a moment ago",
    }


def test_a_standing_character_does_not_fidget(runtime: Runtime, walk: Walk) -> None:
    """Asked to stand, a character makes no transition but at the end of its clip."""
    session = runtime.open(opening(3))
    list(walk(session, 2.0, (0.0, 0.0)))
    for frame in walk(session, 10.0, (0.0, 0.0)):
        for event in frame.events:
            if isinstance(event, Transition):
                assert event.reason is TransitionReason.CLIP_END


def test_what_was_just_chosen_is_not_chosen_again(runtime: Runtime, walk: Walk) -> None:
    """Within the reselect history no transition goes back to a moment chosen in it."""
    session = runtime.open(opening(2))
    chosen: dict[int, list[tuple[float, int]]] = {10: [], 11: []}
    library = runtime.library("")
    history = TickSettings().reselect_history
    for i, frame in enumerate(walk(session, 8.0, (1.0, 1.0))):
        for event in frame.events:
            if isinstance(event, Transition):
                row = library.entry(event.to_clip).start + round(event.to_time_s * 60)
                for time, earlier in chosen[event.character]:
                    assert i * DT - time >= history - DT or abs(row - earlier) >= 20
                chosen[event.character].append((i * DT, row))


@pytest.fixture
def loop(tmp_path: Path) -> Runtime:
    """Return a runtime over one looping walk, cut from a synthetic one at equal poses."""
    frames, turn = 121, 0.4
    time = np.arange(frames) / 60.0
    heading = turn * time
    step = 1.2 / 60.0 * np.stack([np.sin(heading), 0 * time, np.cos(heading)], axis=-1)
    root = np.concatenate([np.zeros((1, 3)), np.cumsum(step[:-1], axis=0)])
    swing = 0.5 * np.sin(2 * np.pi * time)[:, None] * np.arange(22)[None] / 22.0
    axes = np.stack([swing, 0 * swing, 0 * swing], axis=-1)
    pose = Pose(
        root,
        quaternion.from_yaw(heading),
        np.stack([0 * time, 0.93 + 0.02 * np.cos(2 * np.pi * time), 0 * time], axis=-1),
        quaternion.from_scaled_axis(axes),
    )
    contacts = np.zeros((frames, 4), np.bool_)
    clip = Clip("loop", REFERENCE, 60.0, pose, contacts, (TagSpan("walk", 0, frames),), loops=True)
    library = build_library([clip, *_standing()], tmp_path / "loop", name="loop", mirror=False)
    return Runtime([library], clock=lambda: 0.0)


def _standing() -> list[Clip]:
    return [replace(clip, tags=()) for clip in synthetic_clips() if clip.name == "idle-1"]


def test_a_loop_goes_on_without_a_seam(loop: Runtime, walk: Walk) -> None:
    """A character on a loop walks its curve lap after lap, without transitions, steps or stops."""
    session = loop.open(opening(1, characters=specs("walk")))
    frames = list(walk(session, 7.0, (0.0, 1.2)))
    state = session.crowd.state
    state.until_search[:] = 1e9
    state.searched_velocity[:] = state.desired_velocity
    frames = []
    for i in range(600):
        state.searched_yaw[:] = state.goal_yaw
        ((frame, _),) = loop.advance([(session, Step(i, DT))])
        frames.append(frame)
        assert not [event for event in frame.events if isinstance(event, Transition)]
    way = np.diff([frame.root[0, :3] for frame in frames], axis=0)
    assert np.allclose(np.linalg.norm(way, axis=1) / DT, 1.2, rtol=0.2)
    swing = np.array([frame.rotations[0, 10] for frame in frames])
    assert np.abs(np.diff(swing, axis=0)).max() < 0.05
    assert state.clip_time[session.rows[0]] <= 2.0


def test_a_loop_may_be_entered_to_its_end(loop: Runtime) -> None:
    """The future of a loop's last frames is its first ones: they are startable and alike."""
    library = loop.library("")
    entry = library.entry("loop")
    rows = slice(entry.start, entry.start + entry.frames)
    assert library.startable[rows].sum() == entry.frames - 1
    features = library.features[rows]
    trajectory = slice(15, 27)
    assert np.allclose(features[119, trajectory], features[1, trajectory], atol=0.05)


def test_searches_that_were_forced_together_fall_apart_again(runtime: Runtime) -> None:
    """After a command to all at once, no later tick searches for more than a third of them."""
    session = runtime.open(opening(64))
    state = session.crowd.state
    step = Step(1, DT, velocity_xz=np.tile([0.0, 1.4], (64, 1)))
    runtime.advance([(session, step)])
    searched = []
    for _ in range(24):
        before = state.until_search[session.rows].copy()
        runtime.advance([(session, step)])
        searched.append(int(np.count_nonzero(state.until_search[session.rows] > before)))
    assert sum(searched[4:]) > 64
    assert max(searched[4:]) <= 21
