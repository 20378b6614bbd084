"""Responsiveness: 0.5 changes nothing, more follows the control sooner, row by row."""

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, CharacterUpdate, Edit, Step
from stridewire_engine.runtime import Runtime
from stridewire_engine.runtime.response import NEUTRAL, QUALITY, RESPONSE, multiples
from unit.runtime.conftest import DT, opening


def test_the_neutral_value_multiplies_by_one() -> None:
    """Exactly, so that nothing changes for who does not set it."""
    assert all(np.array_equal(part, [1.0]) for part in multiples(np.array([NEUTRAL])))


def test_the_ends_are_reached_evenly() -> None:
    """0 and 1 are the ends, a quarter lies at the geometric mean, and the way is monotonic."""
    steps = multiples(np.linspace(0.0, 1.0, 9))
    for found, low, high in zip(steps, QUALITY, RESPONSE, strict=True):
        found = np.asarray(found)
        assert found[0] == pytest.approx(low)
        assert found[-1] == pytest.approx(high)
        assert found[2] == pytest.approx(np.sqrt(low))
        assert len(set(np.sign(np.diff(found)))) == 1


def test_a_responsive_character_is_sent_on_its_way_sooner(runtime: Runtime) -> None:
    """Of two with one control the responsive one's simulated root is ahead after half a second."""
    specs = [CharacterSpec(i, responsiveness=value) for i, value in enumerate((0.0, 1.0))]
    session = runtime.open(opening(2, characters=specs))
    for i in range(30):
        step = Step(i, DT, velocity_xz=np.tile((0.0, 1.4), (2, 1)))
        ((frame, _),) = runtime.advance([(session, step)])
    assert frame.simulated_root is not None
    slow, quick = frame.simulated_root[:, 2]
    assert quick > slow + 0.05


def test_an_edit_changes_it_and_an_absent_value_is_the_default(runtime: Runtime) -> None:
    """A mask that names it takes the value, or the default where there is none."""
    session = runtime.open(opening(1, characters=[CharacterSpec(1, responsiveness=0.9)]))
    row = session.rows[0]
    assert session.crowd.state.responsiveness[row] == pytest.approx(0.9)
    for value, expected in ((0.2, 0.2), (None, NEUTRAL)):
        change = CharacterUpdate(CharacterSpec(1, responsiveness=value), ("responsiveness",))
        assert runtime.edit(session, Edit(update=[change])) is None
        assert session.crowd.state.responsiveness[row] == pytest.approx(expected)
