"""Strain: when the runtime is told to give way, and when it need not any more."""

import pytest

from stridewire_engine.runtime.settings import LEVELS
from stridewire_server.strain import Strain

PERIOD = 1.0 / 60.0


class Thread:
    """A thread that works for a share of each sixtieth of a second."""

    def __init__(self) -> None:
        self.now = self.worked_s = 0.0
        self.strain = Strain(0.0, 0.0)

    def work(self, seconds: float, share: float) -> int:
        """Go on; return the level then."""
        for _ in range(max(1, round(seconds / PERIOD))):
            self.now += PERIOD
            self.worked_s += share * PERIOD
            self.strain.note(self.now, self.worked_s)
        return self.strain.level


@pytest.mark.parametrize("share", [0.1, 0.5, 0.75])
def test_work_that_fits_asks_nobody_to_give_way(share: float) -> None:
    """Up to three quarters of the time are fine for ever."""
    assert Thread().work(10.0, share) == 0


def test_it_rises_level_by_level_and_stops() -> None:
    """A thread that always works leads to the last level within a second, never beyond."""
    thread = Thread()
    levels = [thread.work(PERIOD, 1.0) for _ in range(60)]
    assert sorted(set(levels)) == list(range(LEVELS))
    assert levels == sorted(levels)
    assert thread.work(5.0, 1.0) == LEVELS - 1


def test_it_is_over_within_a_second() -> None:
    """A second after the load has fallen nothing gives way any more."""
    thread = Thread()
    assert thread.work(3.0, 1.0) == LEVELS - 1
    assert thread.work(1.0, 0.3) == 0


def test_a_single_hitch_is_none() -> None:
    """A tenth of a second of nothing but work among rest changes nothing."""
    thread = Thread()
    thread.work(1.0, 0.2)
    thread.work(0.1, 1.0)
    assert thread.work(1.0, 0.2) == 0
