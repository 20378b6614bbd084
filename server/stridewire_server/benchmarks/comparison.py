"""Comparing two pieces of work in one run, by processor time, so that a busy machine hurts little.

Absolute times differ between machines and hours; the ratio of two that take turns hardly does.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from typing import Any

Work = Callable[[], object]
_SHORTEST_S = 0.02
"""A round repeats its work for at least so long: the processor's clock has steps."""


@dataclass(frozen=True)
class Compared:
    """What one part costs, and what its reference does."""

    name: str
    size: str
    """How much of it: characters, rows, queries."""
    unit: str
    """What the value is of, microseconds each."""
    reference: str
    """What it is compared with."""
    value: float
    reference_value: float

    def row(self) -> dict[str, Any]:
        """Return the flat row of `--json`."""
        return {
            "name": self.name,
            "size": self.size,
            "value": round(self.value, 3),
            "unit": self.unit,
            "reference": self.reference,
            "ratio": round(self.value / self.reference_value, 4),
        }


def compare(work: Work, reference: Work, rounds: int) -> tuple[float, float]:
    """Return the processor time of both in microseconds: medians of rounds that take turns."""
    repeats = [_repeats(piece) for piece in (work, reference)]
    taken: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for mine, piece, count in zip(taken, (work, reference), repeats, strict=True):
            mine.append(_processor_us(piece, count))
    return median(taken[0]), median(taken[1])


def _repeats(work: Work) -> int:
    """Return how often to repeat work in a round; its first call warms it up."""
    work()
    return max(1, round(1e6 * _SHORTEST_S / max(_processor_us(work, 1), 1.0)))


def _processor_us(work: Work, count: int) -> float:
    begin = time.process_time()
    for _ in range(count):
        work()
    return 1e6 * (time.process_time() - begin) / count
