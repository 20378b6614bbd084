"""Edits: characters come, go and change while the others go on."""

import numpy as np
import pytest

from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    Edit,
    Step,
)
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_engine.stitchers import DEFAULT_STITCHER, STITCHER_NAMES
from unit.runtime.conftest import DT, one, opening


def test_characters_come_and_go(runtime: Runtime) -> None:
    """Frames follow the roster: order of adding, removed ones gone, rows given back."""
    session = runtime.open(opening(3))
    edit = Edit(add=[CharacterSpec(50)], remove=[11])
    assert runtime.edit(session, edit) is None
    frame, _ = one(runtime, session, Step(1, DT))
    assert frame.characters.tolist() == [10, 12, 50]
    assert frame.rotations.shape == (3, 22, 4)
    assert runtime.info().characters == 3
    runtime.close(session)
    runtime.close(session)
    assert runtime.info().characters == runtime.info().sessions == 0


def test_a_new_character_does_not_disturb_the_others(small_library: Library) -> None:
    """Adding and removing neighbours leaves a character's stream as it would have been."""
    frames = []
    for busy in (False, True):
        runtime = Runtime([small_library], clock=lambda: 0.0)
        session = runtime.open(opening(1))
        for i in range(120):
            if busy and i % 10 == 5:
                runtime.edit(session, Edit(add=[CharacterSpec(100 + i)]))
            if busy and i % 20 == 15:
                runtime.edit(session, Edit(remove=[100 + i - 10]))
            step = Step(i, DT, characters=np.array([10]), velocity_xz=[[0.0, 1.4]])
            frame, _ = one(runtime, session, step)
        frames.append(frame)
    assert np.allclose(frames[0].root[0], frames[1].root[0], atol=1e-5)
    assert np.allclose(frames[0].rotations[0], frames[1].rotations[0], atol=1e-5)


@pytest.mark.parametrize(
    ("edit", "field"),
    [
        (Edit(remove=[99]), "edit.remove[0]"),
        (Edit(remove=[10, 11]), "edit.remove[1]"),
        (Edit(add=[CharacterSpec(10)]), "edit.add[0].id"),
        (Edit(add=[CharacterSpec(20), CharacterSpec(20)]), "edit.add[1].id"),
        (Edit(add=[CharacterSpec(20, filter="(walk")]), "edit.add[0].filter"),
        (Edit(add=[CharacterSpec(20, rate_divider=16)]), "edit.add[0].rate_divider"),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(99), ("stitcher",))]),
            "edit.update[0].spec.id",
        ),
        (Edit(update=[CharacterUpdate(CharacterSpec(10), ())]), "edit.update[0].mask"),
        (Edit(update=[CharacterUpdate(CharacterSpec(10), ("root",))]), "edit.update[0].mask"),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(10, rate_divider=16), ("rate_divider",))]),
            "edit.update[0].spec.rate_divider",
        ),
        (
            Edit(
                update=[CharacterUpdate(CharacterSpec(10, responsiveness=1.5), ("responsiveness",))]
            ),
            "edit.update[0].spec.responsiveness",
        ),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(10, filter="!"), ("filter",))]),
            "edit.update[0].spec.filter",
        ),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(10, stitcher="glue"), ("stitcher",))]),
            "edit.update[0].spec.stitcher",
        ),
    ],
)
def test_bad_edits_are_told_by_path(runtime: Runtime, edit: Edit, field: str) -> None:
    """What is wrong with an edit is left out and named; the rest of it holds."""
    session = runtime.open(opening(2))
    error = runtime.edit(session, edit)
    assert error is not None
    assert [violation.field for violation in error.violations] == [field]
    frame, _ = one(runtime, session, Step(1, DT))
    assert len(frame.characters) >= 1


def test_a_session_holds_no_more_than_its_limit(small_library: Library) -> None:
    """The 4,097th character is refused."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(opening(4096))
    error = runtime.edit(session, Edit(add=[CharacterSpec(1)]))
    assert error is not None
    assert "4096" in error.violations[0].description


def test_updates_change_what_the_mask_names(runtime: Runtime) -> None:
    """Stitcher and foot lock may change while the character runs, and nothing else does."""
    session = runtime.open(opening(1))
    spec = CharacterSpec(10, stitcher="none", foot_lock=False)
    default = STITCHER_NAMES.index(DEFAULT_STITCHER)
    assert runtime.edit(session, Edit(update=[CharacterUpdate(spec, ("foot_lock",))])) is None
    state = session.crowd.state
    row = session.rows[0]
    assert (bool(state.foot_lock[row]), int(state.stitcher[row])) == (False, default)
    assert runtime.edit(session, Edit(update=[CharacterUpdate(spec, ("stitcher",))])) is None
    assert int(state.stitcher[row]) == 1
