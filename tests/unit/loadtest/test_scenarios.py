"""Scenarios: every one asks for at least one character, and shares cover all streams once."""

import pytest

pytest.importorskip("hdrh")

from stridewire_loadtest.beside import guests_of
from stridewire_loadtest.measurement import Load
from stridewire_loadtest.scenarios import FRAME_S, SCENARIO_NAMES


@pytest.mark.parametrize("name", SCENARIO_NAMES)
@pytest.mark.parametrize("characters", [1, 64])
def test_shares_cover_all_streams_once(name: str, characters: int) -> None:
    """Between processes no stream is lost or doubled, and one process goes beside."""
    load = Load(name, characters, processes=3)
    shares = load.shares("127.0.0.1:1")
    numbers = [plan.number for share in shares for plan in share.plans]
    assert sorted(numbers) == list(range(len(load.plans())))
    assert sum(share.goes_beside for share in shares) == 1
    assert all(plan.characters >= 1 for share in shares for plan in share.plans)


def test_phases_are_spread_over_a_frame() -> None:
    """Sixteen streams begin a sixteenth of a frame apart: they don't all ask at once."""
    phases = [plan.phase_s for plan in Load("streams", 16).plans()]
    assert phases == pytest.approx([FRAME_S * i / 16 for i in range(16)])


def test_controls_differ_between_streams_and_repeat_with_the_seed() -> None:
    """Streams of one load are asked for different things, twice the same for the same seed."""
    first, second = (plan.controls() for plan in Load("streams", 2, 1.0, 0.0).plans())
    assert first != second
    assert first == Load("streams", 2, 1.0, 0.0).plans()[0].controls()


@pytest.mark.parametrize(("name", "guests"), [("soak", 8), ("surge", 1), ("crowd", 0)])
def test_guests_bring_controls_for_the_longest_stay(name: str, guests: int) -> None:
    """Nothing is made while the clock runs; a shorter stay uses the same controls."""
    load = Load(name, 64)
    found = guests_of(load.asked(), load.plans()[0])
    assert len(found) == guests
    for guest in found:
        assert len(guest.controls) == guest.plan.steps
        shorter = guest.staying(0.5 * guest.plan.seconds, 77)
        assert shorter.plan.number == 77
        assert shorter.plan.steps < len(shorter.controls)
