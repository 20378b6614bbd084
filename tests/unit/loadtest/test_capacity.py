"""Looking for the largest load: doubling and bisecting find it, whatever it is."""

from typing import Any, cast

import pytest

pytest.importorskip("hdrh")

from stridewire_loadtest.capacity import find_capacity, held
from stridewire_loadtest.measurement import Load, Measured
from stridewire_loadtest.served import Served, Usage
from stridewire_loadtest.tally import Tally


def holding(limit: int, asked: list[int]) -> Any:
    """Return a measurement of a server that holds up to a number of characters."""

    def measure(server: Served, load: Load) -> Measured:
        asked.append(load.characters)
        tally = Tally(expected=1000, received=1000, late=0 if load.characters <= limit else 50)
        return Measured(load, tally, Usage([0.0], [0.0], [100.0]))

    return measure


@pytest.mark.parametrize("limit", [1, 2, 63, 64, 65, 700, 5000])
@pytest.mark.parametrize("first", [1, 64, 300])
def test_the_largest_load_is_found(limit: int, first: int) -> None:
    """The largest load that held is within eight per cent of the truth, or the most there is."""
    asked: list[int] = []
    load = Load("crowd", first, seconds=1.0)
    made = find_capacity(cast(Served, None), load, holding(limit, asked), lambda _: None)
    best = max((m.load.characters for m in made if held(m)), default=0)
    assert best <= limit
    assert best >= min(limit, 4096) - max(1, 0.08 * best)
    assert len(asked) == len(set(asked)) < 25


def test_missing_frames_are_late() -> None:
    """A frame that never came counts as late in the row, and such a load is not held."""
    tally = Tally(expected=1000, received=998)
    row = Measured(Load("single", 1, 10.0), tally, Usage([0.0], [0.0], [100.0])).row()
    assert row["late_pct"] == pytest.approx(0.2)
    assert row["dropped_pct"] == pytest.approx(0.2)
    assert not held(Measured(Load("single", 1, 10.0), tally, Usage([0.0], [0.0], [100.0])))


def test_a_late_generator_voids_the_run() -> None:
    """A run whose own controls left late is void, and says what to do."""
    tally = Tally(expected=100, received=100, sent_late=5)
    for _ in range(100):
        tally.sending.record_value(1000)
    measured = Measured(Load("single", 1, 10.0), tally, Usage([0.0], [0.0], [100.0]))
    assert not measured.row()["valid"]
    assert "--processes" in measured.void()[0]
