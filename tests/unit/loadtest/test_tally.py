"""Tallies: what counts as late, that processes can pass them on, and that sums lose nothing."""

import pickle

import pytest

pytest.importorskip("hdrh")

from stridewire_loadtest.tally import LATE_S, Tally


def seen(*latencies_s: float) -> Tally:
    """Return a tally of frames in one second."""
    tally = Tally(expected=len(latencies_s))
    for latency in latencies_s:
        tally.note(latency, 0)
    return tally


def test_late_begins_after_a_sixtieth() -> None:
    """A frame at the limit is in time, one beyond it is late."""
    assert seen(LATE_S).late == 0
    assert seen(LATE_S + 1e-6).late == 1


def test_sums_hold_what_their_parts_held() -> None:
    """Counts add up, and the largest latency survives the sum and the way between processes."""
    total = Tally()
    for part in (seen(0.001, 0.002), seen(0.5)):
        total.add(pickle.loads(pickle.dumps(part)))
    assert (total.expected, total.received, total.late) == (3, 3, 1)
    assert total.late_by_second == {0: 1}
    assert total.frames.get_max_value() == pytest.approx(500_000, rel=1e-3)
    assert total.frames.get_total_count() == 3


def test_equal_poses_are_found() -> None:
    """The share is that of the worst step: three of four characters in the same pose."""
    tally = Tally(poses={60: [b"a", b"b"], 120: [b"a", b"b", b"a", b"a"]})
    assert tally.distinct_pct() == 50.0
    assert Tally(poses={60: [b"a", b"b"]}).distinct_pct() == 100.0


def test_the_words_of_an_error_are_kept_for_a_few() -> None:
    """Every failure is counted, the first five are told."""
    tally = Tally()
    for number in range(7):
        tally.fail(f"error {number}\nand more")
    assert tally.refused == 7
    assert tally.examples == [f"error {number}" for number in range(5)]
