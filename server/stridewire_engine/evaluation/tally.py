"""Tallies: figures kept by unit (a character, a clip), so that they pool and have intervals.

A mean is pooled as a ratio of sums, a percentile by adding histograms. Intervals come from drawing
whole units with replacement (cluster bootstrap), since frames of one unit are not independent.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from stridewire.motion.array_types import Floats

DRAWS = 1000
"""Draws of a bootstrap interval."""
_BINS = 400


class Tally(Protocol):
    """One figure of S units."""

    def value(self, draw: Floats) -> Floats:
        """Return the pooled figure under `(R, S)` counts of how often each unit is taken."""

    @property
    def units(self) -> int:
        """Number of units, S."""

    def data(self) -> dict[str, Any]:
        """Return plain lists for JSON; `from_data` undoes it."""


@dataclass(frozen=True)
class Mean:
    """A ratio of sums."""

    total: Floats
    """`(S,)`."""
    weight: Floats
    """`(S,)`."""

    @classmethod
    def of(cls, values: Floats, scale: float = 1.0) -> "Mean":
        """Average `(T, S, …)` values over all but the second axis; NaN is not counted."""
        axes = (0, *range(2, values.ndim))
        counted = ~np.isnan(values)
        total = np.where(counted, values, 0.0).sum(axis=axes, dtype=np.float64)
        return cls(scale * total, counted.sum(axis=axes).astype(np.float64))

    def relative_to(self, other: "Mean") -> "Mean":
        """Return the ratio of two means over the same frames, still by unit."""
        return Mean(self.total, other.total)

    def value(self, draw: Floats) -> Floats:
        """Return the pooled mean; NaN where nothing was counted."""
        weight = draw @ self.weight
        return np.where(
            weight > 0.0, draw @ self.total / np.where(weight > 0.0, weight, 1.0), np.nan
        )

    @property
    def units(self) -> int:
        """Number of units."""
        return len(self.total)

    def data(self) -> dict[str, Any]:
        """Return plain lists."""
        return {"total": self.total.tolist(), "weight": self.weight.tolist()}


@dataclass(frozen=True)
class Percentile:
    """A percentile over all frames, by histograms."""

    counts: Floats
    """`(S, B)` values of each unit in each of B even bins."""
    low: float
    high: float
    """Range of the bins; values outside are counted in the outermost."""
    percent: float

    @classmethod
    def of(cls, values: Floats, percent: float, low: float, high: float) -> "Percentile":
        """Count `(T, S, …)` values; NaN is not counted."""
        by_unit = np.moveaxis(values, 1, 0).reshape(values.shape[1], -1)
        counts = np.empty((len(by_unit), _BINS))
        for unit, row in enumerate(by_unit):
            inside = np.clip(row[~np.isnan(row)], low, high)
            counts[unit] = np.histogram(inside, _BINS, (low, high))[0]
        return cls(counts, low, high, percent)

    def value(self, draw: Floats) -> Floats:
        """Return the pooled percentile, to half a bin; NaN where nothing was counted."""
        used = np.flatnonzero(self.counts.any(axis=0))
        if not len(used):
            return np.full(len(draw), np.nan)
        summed = np.cumsum(draw @ self.counts[:, used], axis=-1)
        whole = summed[..., -1:]
        last = len(used) - 1
        bin_of = used[np.minimum((summed < 0.01 * self.percent * whole).sum(axis=-1), last)]
        middle = self.low + (bin_of + 0.5) * (self.high - self.low) / _BINS
        return np.where(whole[..., 0] > 0.0, middle, np.nan)

    @property
    def units(self) -> int:
        """Number of units."""
        return len(self.counts)

    def data(self) -> dict[str, Any]:
        """Return plain lists."""
        return {
            "counts": self.counts.astype(int).tolist(),
            "low": self.low,
            "high": self.high,
            "percent": self.percent,
        }


def from_data(data: dict[str, Any]) -> Tally:
    """Return the tally of plain lists."""
    if "total" in data:
        return Mean(np.array(data["total"]), np.array(data["weight"]))
    return Percentile(np.array(data["counts"], float), data["low"], data["high"], data["percent"])


def pool(tallies: Sequence[Tally]) -> Tally:
    """Join the units of tallies of one figure."""
    first = tallies[0]
    if isinstance(first, Mean):
        means = [t for t in tallies if isinstance(t, Mean)]
        return Mean(
            np.concatenate([t.total for t in means]), np.concatenate([t.weight for t in means])
        )
    assert isinstance(first, Percentile)
    counts = np.concatenate([t.counts for t in tallies if isinstance(t, Percentile)])
    return Percentile(counts, first.low, first.high, first.percent)


def value(tally: Tally) -> float:
    """Return the figure alone."""
    return float(tally.value(np.ones((1, tally.units)))[0])


def interval(tally: Tally, seed: int = 0) -> tuple[float, float, float]:
    """Return the figure and its 95 % bootstrap interval over units."""
    drawn = tally.value(_draws(tally.units, seed))
    if np.isnan(drawn).all():
        return value(tally), np.nan, np.nan
    low, high = np.nanpercentile(drawn, (2.5, 97.5))
    return value(tally), float(low), float(high)


def ratio(above: Tally, below: Tally, seed: int = 0) -> tuple[float, float, float]:
    """Return the ratio of two figures and its 95 % interval; units are drawn in pairs."""
    one = np.ones((1, above.units))
    value = above.value(one)[0] / below.value(np.ones((1, below.units)))[0]
    draws = _draws(above.units, seed)
    other = draws if below.units == above.units else _draws(below.units, seed + 1)
    drawn = above.value(draws) / below.value(other)
    low, high = np.nanpercentile(drawn, (2.5, 97.5))
    return float(value), float(low), float(high)


@lru_cache(maxsize=4)
def _draws(units: int, seed: int) -> Floats:
    rng = np.random.default_rng(seed)
    return rng.multinomial(units, np.full(units, 1.0 / units), DRAWS).astype(np.float64)
