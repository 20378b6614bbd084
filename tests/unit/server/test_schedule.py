"""Due times: an even grid, a bounded catch-up after a hitch, one grid for all."""

import numpy as np
import pytest

from stridewire_server.streaming.schedule import MAX_CATCH_UP, Schedule


@pytest.mark.parametrize("rate_hz", [10.0, 59.94, 60.0, 240.0])
def test_due_times_are_even(rate_hz: float) -> None:
    """A punctual session is due once a period, without drift."""
    now, due = 1000.003, []
    schedule = Schedule(rate_hz, now)
    for _ in range(1000):
        now = schedule.next_due(now)
        due.append(now)
    np.testing.assert_allclose(np.diff(due), 1.0 / rate_hz, rtol=1e-6)
    assert 0.0 <= due[0] - 1000.003 < 1.0 / rate_hz


def test_sessions_of_one_rate_are_due_together() -> None:
    """Whenever they began, their due times are the same instants."""
    a, b = Schedule(60.0, 5.001), Schedule(60.0, 5.012)
    first = {a.next_due(5.001) for _ in range(50)}
    second = {b.next_due(5.012) for _ in range(50)}
    assert len(first & second) >= 49


def test_a_short_hitch_is_caught_up() -> None:
    """Three periods late: three frames at once, then on time again."""
    schedule = Schedule(60.0, 0.0)
    schedule.next_due(0.0)
    late = 3.5 / 60.0
    due = [schedule.next_due(late) for _ in range(4)]
    assert sum(time <= late for time in due) == 3
    assert due[-1] > late


def test_a_long_hitch_is_let_go() -> None:
    """A second late: no more than the catch-up is made up for."""
    schedule = Schedule(60.0, 0.0)
    schedule.next_due(0.0)
    due = [schedule.next_due(1.001) for _ in range(20)]
    assert sum(time <= 1.001 for time in due) == MAX_CATCH_UP
