"""Playout under injected delay, jitter, loss and breaks: even motion, nothing shown twice."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import Frame, FrameFlag, TagEntered
from stridewire.motion import quaternion
from stridewire.playout import ClockSync, Playout

RATE = 60.0
SPEED = 1.5
OFFSET = 1234.5
"""The receiver's clock is ahead of the session's by so many seconds, plus the network's delay."""


def frame(number: int, speed: float = SPEED) -> Frame:
    """Return a frame of one character that walks evenly and turns."""
    time_s = number / RATE
    one = np.array([4], np.uint32)
    turn = quaternion.from_yaw(np.array([0.5 * time_s])).astype(np.float32)
    root = np.concatenate([np.float32([[0.0, 0.0, speed * time_s]]), turn], axis=1)
    rotations = np.repeat(turn[:, None], 22, axis=1)
    zero = np.zeros(1, np.uint32)
    return Frame(
        *(number, number, time_s, 0.0, one, root, np.zeros((1, 4)), np.zeros((1, 3), np.float32)),
        *(rotations, zero, np.full((1, 2, 3), np.nan), zero),
        events=(TagEntered(4, number, "walk"),),
    )


def play(
    delays_s: np.ndarray, kept: np.ndarray, draw_hz: float = 75.0, playout: Playout | None = None
) -> tuple[Playout, np.ndarray, np.ndarray, list[int]]:
    """Send frames with delays, draw at a rate; return draw times, places and frames of events."""
    playout = playout or Playout()
    sent = np.arange(1, len(delays_s) + 1) / RATE + OFFSET
    arrives = np.maximum.accumulate(sent + delays_s)  # a stream keeps order: late ones hold others
    pending = [(a, i + 1) for i, a in enumerate(arrives) if kept[i]]
    drawn, places, passed = [], [], []
    for now in np.arange(sent[0], arrives[-1], 1.0 / draw_hz):
        while pending and pending[0][0] <= now:
            arrived, number = pending.pop(0)
            playout.add(frame(number), arrived)
        shown = playout.sample(now)
        if shown is not None:
            drawn.append(now)
            places.append(shown.root[0, 2])
            passed += [event.frame for event in shown.events]
    return playout, np.array(drawn), np.array(places), passed


def unevenness(drawn: np.ndarray, places: np.ndarray, of: float = 1.0) -> float:
    """Return what the drawn speed deviates from the true one, in a share of moments; as a share."""
    speed = np.diff(places[150:]) / np.diff(drawn[150:])
    return float(np.quantile(np.abs(speed / SPEED - 1.0), of))


@pytest.mark.parametrize("delay", [0.0, 0.04, 0.2])
def test_a_constant_delay_is_played_evenly_and_no_later_than_need_be(delay: float) -> None:
    """Motion is exact; what is shown is one interval old plus the network's delay and a margin."""
    count = 600
    playout, drawn, places, _ = play(np.full(count, delay), np.ones(count, bool))
    assert unevenness(drawn, places) < 1e-3
    age = drawn[-1] - OFFSET - places[-1] / SPEED
    assert age == pytest.approx(delay + 1.0 / RATE, abs=0.01)
    assert playout.starved == 0


def test_jitter_is_hidden(rng: np.random.Generator) -> None:
    """Delays from 20 to 70 ms at random: drawn speed stays within the slew of the playhead."""
    count = 1200
    delays = 0.02 + rng.uniform(0.0, 0.05, count)
    playout, drawn, places, _ = play(delays, np.ones(count, bool))
    assert unevenness(drawn, places, of=0.98) <= 0.11
    assert playout.starved <= 0.02 * len(drawn)
    assert playout.delay_s < 0.08


def test_without_playout_the_same_jitter_shows(rng: np.random.Generator) -> None:
    """The test can fail: frames drawn as they come jump by whole frames."""
    count = 1200
    delays = 0.02 + rng.uniform(0.0, 0.05, count)
    arrives = np.maximum.accumulate(np.arange(1, count + 1) / RATE + delays)
    drawn = np.arange(1.0, 15.0, 1.0 / 75.0)
    newest = np.searchsorted(arrives, drawn)
    assert unevenness(drawn, SPEED * newest / RATE, of=0.98) > 0.9


def test_lost_frames_are_bridged(rng: np.random.Generator) -> None:
    """One frame in ten never comes: motion goes on through the gap."""
    count = 900
    kept = rng.random(count) > 0.1
    _, drawn, places, passed = play(np.full(count, 0.03), kept)
    assert unevenness(drawn, places, of=0.98) < 0.11
    assert passed == sorted(set(passed))


def test_events_are_handed_out_once_and_in_order(rng: np.random.Generator) -> None:
    """Each frame's events come exactly once."""
    count = 600
    _, _, _, passed = play(0.02 + rng.uniform(0.0, 0.05, count), np.ones(count, bool))
    assert passed == list(range(passed[0], passed[-1] + 1))


def test_after_a_break_the_present_is_shown() -> None:
    """A second without frames: the last pose stays, then the playhead leaps to the present."""
    count = 600
    delays = np.full(count, 0.03)
    delays[300:301] += 1.0
    playout, drawn, places, _ = play(delays, np.ones(count, bool))
    age = drawn[-1] - OFFSET - places[-1] / SPEED
    assert age < 0.3
    assert playout.starved > 30
    assert np.all(np.diff(places) >= -1e-6)


def test_a_teleport_is_not_interpolated() -> None:
    """Between two frames around a teleport nothing lies in between."""
    playout = Playout()
    there = frame(2)
    there.root[0, 2] = 100.0
    there = replace(there, flags=np.array([1 << FrameFlag.TELEPORTED], np.uint32))
    playout.add(frame(1), OFFSET + 1 / RATE)
    playout.add(there, OFFSET + 2 / RATE)
    places = []
    for now in np.linspace(2 / RATE, 4 / RATE, 40):
        shown = playout.sample(OFFSET + now)
        if shown is not None:
            places.append(float(shown.root[0, 2]))
    assert set(np.round(places, 3)) == {np.round(SPEED / RATE, 3), 100.0}


def test_nothing_is_shown_before_the_first_frame() -> None:
    """None without frames, and None until the first one is due."""
    playout = Playout()
    assert playout.sample(5.0) is None
    playout.add(frame(60), OFFSET + 1.0)
    assert playout.sample(OFFSET + 1.0) is None
    playout.add(frame(61), OFFSET + 1.0 + 1.0 / RATE)
    assert playout.sample(OFFSET + 1.0 + 1.0 / RATE) is None
    assert playout.sample(OFFSET + 1.1) is not None


def test_the_clock_follows_the_least_delay() -> None:
    """Delayed frames do not move it; a route that became longer does, after its window."""
    clock = ClockSync(window=10)
    for number in range(20):
        clock.add(number / RATE, OFFSET + number / RATE + (0.1 if number % 3 else 0.02))
    assert clock.ahead_s == pytest.approx(OFFSET + 0.02)
    for number in range(20, 40):
        clock.add(number / RATE, OFFSET + number / RATE + 0.2)
    assert clock.ahead_s == pytest.approx(OFFSET + 0.2)
