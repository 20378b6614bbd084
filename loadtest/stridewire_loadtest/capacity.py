"""The largest load that a server holds: doubled until it fails, then bisected."""

from collections.abc import Callable
from dataclasses import replace

from stridewire_loadtest.measurement import Load, Measured
from stridewire_loadtest.served import Served

LATE_BAR_PCT = 0.1
"""A load is held where at most this share of frames is late or missing."""
_LARGEST = {"streams": 1024}
_LARGEST_CROWD = 4096
_STEP = 0.08
"""Bisection ends when the answer is known to this part of itself."""

Measure = Callable[[Served, Load], Measured]


def find_capacity(
    server: Served, load: Load, measure: Measure, told: Callable[[Measured], None]
) -> list[Measured]:
    """Return all measurements made on the way, in their order.

    Args:
        server: Running.
        load: Where to begin; its number of characters is varied.
        measure: Puts a load on a server.
        told: Called with each measurement.
    """
    made: list[Measured] = []

    def holds(characters: int) -> bool:
        made.append(measure(server, replace(load, characters=characters)))
        told(made[-1])
        return held(made[-1])

    low, high = 0, _LARGEST.get(load.scenario, _LARGEST_CROWD) + 1
    probe = min(max(1, load.characters), high - 1)
    while low < probe < high:
        if holds(probe):
            low = probe
            probe = min(2 * low, high - 1) if high > 2 * low else _between(low, high)
        else:
            high = probe
            probe = _between(low, high)
        if high - low <= max(1, _STEP * low):
            break
    return made


def held(measured: Measured) -> bool:
    """Tell whether a load was held."""
    row = measured.row()
    return bool(row["late_pct"] <= LATE_BAR_PCT and row["valid"])


def _between(low: int, high: int) -> int:
    return (low + high) // 2
