"""Characters that are far away: a new pose every n-th tick, no time lost."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import CharacterUpdate, Edit, Frame, Open, Step
from stridewire_engine.runtime import Runtime, Session
from unit.runtime.conftest import DT, one, opening


def divided(every: int, count: int = 3) -> Open:
    """Return an Open whose first character is near and whose others are far away."""
    near, *far = opening(count).characters
    return opening(count, characters=[near, *(replace(s, rate_divider=every) for s in far)])


def walked(runtime: Runtime, session: Session, ticks: int, dt: float = DT) -> list[Frame]:
    """Return the frames of so many ticks straight ahead."""
    velocity = np.tile([0.0, 1.2], (len(session), 1))
    return [one(runtime, session, Step(i, dt, velocity_xz=velocity))[0] for i in range(ticks)]


def changes(frames: list[Frame], row: int) -> list[int]:
    """Return the ticks in which a character's pose was another than before."""
    pairs = zip(frames[1:], frames[:-1], strict=True)
    return [
        i
        for i, (now, before) in enumerate(pairs)
        if not np.array_equal(now.rotations[row], before.rotations[row])
    ]


@pytest.mark.parametrize("every", [2, 4, 15])
def test_poses_change_every_nth_tick(runtime: Runtime, every: int) -> None:
    """A far character's pose changes every n-th tick, a near one's in each."""
    frames = walked(runtime, runtime.open(divided(every)), 90)
    assert len(changes(frames, 0)) == 89
    assert set(np.diff(changes(frames, 1))) == {every}


def test_nothing_moves_between_steps(runtime: Runtime) -> None:
    """Between its steps a far character keeps its root, too, and tells of no motion."""
    frames = walked(runtime, runtime.open(divided(4)), 60)
    moved = {i for i, frame in enumerate(frames[1:]) if np.any(frame.root_delta[1])}
    assert moved <= set(changes(frames, 1))
    still = next(i for i in range(1, 59) if i not in changes(frames, 1))
    assert np.array_equal(frames[still + 1].root[1], frames[still].root[1])
    assert np.array_equal(frames[still + 1].foot_targets[1], frames[still].foot_targets[1], True)


def test_no_time_is_lost(runtime: Runtime) -> None:
    """A far character gets as far as a near one under the same control."""
    session = runtime.open(divided(4))
    root = walked(runtime, session, 240)[-1].root[:, 2]
    assert root[1] == pytest.approx(root[0], abs=0.6)


def test_steps_of_a_crowd_are_spread(runtime: Runtime) -> None:
    """Far characters that were added together are not all stepped in one tick."""
    frames = walked(runtime, runtime.open(divided(4, count=41)), 40)
    moved = [sum(i in changes(frames, row) for row in range(1, 41)) for i in range(20, 32)]
    assert max(moved) < 25


def test_long_ticks_are_not_put_off(runtime: Runtime) -> None:
    """However few ticks that takes, no pose is older than a quarter of a second."""
    frames = walked(runtime, runtime.open(divided(15)), 20, dt=0.1)
    assert max(np.diff(changes(frames, 1))) <= 3


def test_a_pause_holds_far_characters_too(runtime: Runtime) -> None:
    """Ticks in which no time passes bring nobody's turn nearer."""
    session = runtime.open(divided(4))
    walked(runtime, session, 30)
    frames = [one(runtime, session, 0.0)[0] for _ in range(9)]
    assert not changes(frames, 1)


def test_a_character_that_comes_near_is_stepped_again(runtime: Runtime) -> None:
    """An edit changes the number; what is owed by then is made up for at once."""
    session = runtime.open(divided(15, count=2))
    walked(runtime, session, 40)
    far = replace(divided(15, count=2).characters[1], rate_divider=1)
    runtime.edit(session, Edit(update=[CharacterUpdate(far, ("rate_divider",))]))
    assert len(changes(walked(runtime, session, 20), 1)) == 19


def test_contacts_and_tags_are_told_once(runtime: Runtime) -> None:
    """What happens in a far character's step is told in that tick alone."""
    frames = walked(runtime, runtime.open(divided(4)), 120)
    told = [i for i, f in enumerate(frames) for e in f.events if e.character == f.characters[1]]
    stepped = {0, *(i + 1 for i in changes(frames, 1))}
    assert told
    assert set(told) <= stepped
