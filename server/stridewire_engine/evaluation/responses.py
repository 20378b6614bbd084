"""Responsiveness: how long a commanded change takes, beside how long the library's own ones take.

Streamed time counts from the command until the sent root shows 90 % of the change; the library's
from leaving the old speed or heading by 10 % to reaching 90 %. Speeds are averaged over 0.2 s in
both.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.mirror import MIRRORED
from stridewire_engine.evaluation.bench import Bench
from stridewire_engine.evaluation.cell import REPORT_SEEDS, Cell
from stridewire_engine.evaluation.streaming import PER_SEED, RATE, Wanted
from stridewire_engine.evaluation.tally import DRAWS
from stridewire_engine.library import Library
from stridewire_engine.runtime import TickSettings
from stridewire_engine.runtime.response import NEUTRAL

LEAST_EVENTS = 8
"""A library that holds fewer of a change has no own time for it."""
_SMOOTHING = 13
_COMMAND_S, _LONGEST_S = 3.0, 4.0
_TURN = 0.5 * np.pi
_TURNING_RATE = 0.3
_MOVING = 0.5
_SPRING_RISE = 3.358
"""`y t` between 10 % and 90 % of a critically damped step."""


@dataclass(frozen=True)
class Change:
    """A commanded change of speed or heading."""

    name: str
    speed_before: float
    speed_after: float
    turn: float = 0.0
    """Radians."""


CHANGES = (
    Change("idle-walk", 0.0, 1.3),
    Change("walk-jog", 1.3, 2.5),
    Change("turn-90", 1.3, 1.3, _TURN),
)


def measure_responses(
    bench: Bench,
    settings: TickSettings,
    seeds: tuple[int, ...] = REPORT_SEEDS,
    responsiveness: float = NEUTRAL,
) -> Iterator[dict[str, Any]]:
    """Yield one flat row for each change."""
    streamed = streamed_times(bench, settings, seeds, responsiveness)
    for change, times in zip(CHANGES, streamed, strict=True):
        events = library_times(bench.library, change)
        finite = np.minimum(times, _LONGEST_S)
        drawn = np.random.default_rng(0).choice(finite, (DRAWS, len(finite))).mean(axis=1)
        own = float(np.percentile(events, 25.0)) if len(events) >= LEAST_EVENTS else None
        yield {
            "library": bench.library.name,
            "change": change.name,
            "responsiveness": responsiveness,
            "response_s": round(float(np.median(finite)), 3),
            "response_mean_s": round(float(finite.mean()), 3),
            "response_mean_s_low": round(float(np.percentile(drawn, 2.5)), 3),
            "response_mean_s_high": round(float(np.percentile(drawn, 97.5)), 3),
            "never_pct": round(100.0 * float(np.mean(np.isinf(times))), 1),
            "library_p25_s": None if own is None else round(own, 3),
            "events": len(events),
        }


def streamed_times(
    bench: Bench, settings: TickSettings, seeds: tuple[int, ...], responsiveness: float
) -> Iterator[Floats]:
    """Yield for each change the seconds that its characters take from the command to 90 %."""
    same = Cell("", seeds=seeds, settings=settings, responsiveness=responsiveness)
    cells = [replace(same, script=change.name) for change in CHANGES]
    asked = [_wanted(change, seeds) for change in CHANGES]
    made = bench.run_under(cells, [wanted for wanted, _ in asked])
    for change, (_, at), stream in zip(CHANGES, asked, made, strict=True):
        speed = smooth_speed(stream.pose.root_position[..., [0, 2]])
        yaw = np.unwrap(quaternion.to_yaw(stream.pose.root_rotation), axis=0)
        times = np.full(len(at), np.inf)
        for character, frame in enumerate(at):
            reached = _done(change, speed[frame:, character], yaw[frame:, character], character)
            if reached.any():
                times[character] = np.argmax(reached) / RATE
        yield times


def library_times(library: Library, change: Change) -> Floats:
    """Return how long each such change in a library's clips took, mirrored copies left out."""
    times: list[float] = []
    for entry in library.clips:
        if entry.name.endswith(MIRRORED):
            continue
        rows = slice(entry.start, entry.start + entry.frames)
        speed = smooth_speed(library.root_position[rows][:, [0, 2]].astype(np.float64))
        if change.turn:
            times += turns(library.root_yaw[rows].astype(np.float64), speed, change.turn)
        else:
            times += accelerations(speed, change)
    return np.array(times)


def fitted_halflife(library: Library, change: Change) -> float | None:
    """Return the half-life of a control spring that does a change as fast as the library does.

    A critically damped spring `1 - (1 + y t) e^(-y t)` goes from 10 % to 90 % within 3.36 / y, with
    `y = 2 ln2 / h`; as in `measure_responses`, the library's time is its 25th percentile.

    Returns:
        Seconds; None where the library holds too few such events.
    """
    events = library_times(library, change)
    if len(events) < LEAST_EVENTS:
        return None
    return float(np.percentile(events, 25.0)) * 2.0 * float(np.log(2.0)) / _SPRING_RISE


def accelerations(speed: Floats, change: Change) -> list[float]:
    """Return how long each rise of a speed `(T,)` from one level to another took."""
    span = change.speed_after - change.speed_before
    low, high = change.speed_before + 0.1 * span, change.speed_before + 0.9 * span
    found = []
    for end in np.flatnonzero((speed[1:] >= high) & (speed[:-1] < high)) + 1:
        below = np.flatnonzero(speed[:end] <= low)
        if not len(below) or (end - below[-1]) / RATE > _LONGEST_S:
            continue
        before = speed[max(0, below[-1] - 30) : below[-1] + 1].mean()
        if before >= change.speed_before - 0.3 * span:
            found.append((end - below[-1]) / RATE)
    return found


def turns(yaw: Floats, speed: Floats, turn: float) -> list[float]:
    """Return how long each turn of at least 90 % of an angle took while walking."""
    rate = _smooth(np.gradient(yaw) * RATE)
    turning = (np.abs(rate) > _TURNING_RATE) & (speed > _MOVING)
    found = []
    for start, end in _runs(turning):
        gone = np.abs(yaw[start:end] - yaw[start])
        if gone.max() >= 0.9 * turn:
            first, last = np.argmax(gone >= 0.1 * turn), np.argmax(gone >= 0.9 * turn)
            found.append(float(last - first) / RATE)
    return found


def smooth_speed(position: Floats) -> Floats:
    """Return the speed `(T, …)` of positions `(T, …, 2)`, averaged over 0.2 s; m/s."""
    return _smooth(np.linalg.norm(np.gradient(position, axis=0), axis=-1) * RATE)


def _done(change: Change, speed: Floats, yaw: Floats, character: int) -> Flags:
    if change.turn:
        return np.asarray(_side(character) * (yaw - yaw[0]) >= 0.9 * change.turn)
    span = change.speed_after - change.speed_before
    return np.asarray(speed >= change.speed_before + 0.9 * span)


def _side(character: int) -> float:
    return 1.0 if character % 2 else -1.0


def _wanted(change: Change, seeds: tuple[int, ...]) -> tuple[Wanted, list[int]]:
    """Return controls that change once, at a moment of its own for each character."""
    count = PER_SEED * len(seeds)
    frames = round((_COMMAND_S + 1.0 + _LONGEST_S) * RATE)
    lots = np.concatenate([np.random.default_rng(seed).random((PER_SEED, 2)) for seed in seeds])
    at = np.round((_COMMAND_S + lots[:, 0]) * RATE).astype(int)
    heading = 2.0 * np.pi * lots[:, 1]
    after = np.arange(frames)[:, None] >= at
    side = np.array([_side(i) for i in range(count)])
    heading = heading + np.where(after, side * change.turn, 0.0)
    speed = np.where(after, change.speed_after, change.speed_before)[..., None]
    velocity = speed * np.stack([np.sin(heading), np.cos(heading)], axis=-1)
    facing = np.where(speed[..., 0] > 0.0, np.nan, heading)
    return Wanted(velocity, facing), at.tolist()


def _smooth(values: Floats) -> Floats:
    """Average over a window along the first axis, the ends repeated."""
    half = _SMOOTHING // 2
    padded = np.pad(values, ((half, half), *((0, 0),) * (values.ndim - 1)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _SMOOTHING, axis=0)
    return np.asarray(windows.mean(axis=-1))


def _runs(flags: Flags) -> Iterator[tuple[int, int]]:
    edges = np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    yield from zip(starts.tolist(), ends.tolist(), strict=True)
