"""Tables of posture blends: flat rows by method, duration and weight, with intervals over clips."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.blending import BINS, LINEAR, Measured, Sums

FEWEST = 100
"""Collisions of linear blends below which a duration's share is not measurable."""
WEIGHTS = tuple(round(0.1 * k, 1) for k in range(1, BINS - 1))
_MEANS = ("mse", "position_error_cm", "sliding_c_cm_s")


def rows(data: str, split: str, measured: Measured) -> Iterator[dict[str, Any]]:
    """Yield rows: by duration over all weights, by weight over all durations, and over all.

    Args:
        data: Name of the data set.
        split: Of it.
        measured: Figures by duration and method.
    """
    methods = list(dict.fromkeys(method for _, method in measured))
    durations = list(dict.fromkeys(duration for duration, _ in measured))
    everything = slice(0, BINS)
    for method in methods:
        about = {"data": data, "split": split, "method": method}
        for duration in durations:
            numbers = _numbers(measured, method, [duration], everything)
            yield {**about, "weight": "all", "duration_s": duration, **numbers}
        for tenth, weight in enumerate(WEIGHTS, start=1):
            numbers = _numbers(measured, method, durations, slice(tenth, tenth + 1))
            yield {**about, "weight": weight, "duration_s": 0, **numbers}
        numbers = _numbers(measured, method, durations, everything)
        yield {**about, "weight": "all", "duration_s": 0, **numbers}
        yield {**about, "weight": "all", "duration_s": 0, **mean_share(measured, method)}


def mean_share(measured: Measured, method: str) -> dict[str, Any]:
    """Return the mean over measurable durations of collisions as a share of linear's, in percent.

    Args:
        measured: Figures by duration and method.
        method: Its name.
    """
    durations = [
        duration
        for duration in dict.fromkeys(duration for duration, _ in measured)
        if measured[duration, LINEAR]["collisions"].total.sum() >= FEWEST
    ]
    if not durations:
        return {
            "figure": "mean over durations",
            "durations": 0,
            **_spread("collisions_pct_of_linear"),
        }
    pairs = [
        (_total(measured[d, method]["collisions"]), _total(measured[d, LINEAR]["collisions"]))
        for d in durations
    ]
    units = len(pairs[0][0])
    drawn = np.random.default_rng(0).multinomial(units, np.full(units, 1 / units), tally.DRAWS)
    shares = [
        np.mean([draw @ own / np.maximum(draw @ other, 1.0) for own, other in pairs])
        for draw in (np.ones(units), *drawn)
    ]
    low, high = np.percentile(shares[1:], (2.5, 97.5))
    numbers = _spread("collisions_pct_of_linear", 100.0 * shares[0], 100.0 * low, 100.0 * high)
    return {"figure": "mean over durations", "durations": len(durations), **numbers}


def _numbers(
    measured: Measured, method: str, durations: Sequence[float], bins: slice
) -> dict[str, Any]:
    def mean(name: str, of: str = method) -> tally.Mean:
        parts = Sums.pool(measured[duration, of][name] for duration in durations)
        return tally.Mean(parts.total[:, bins].sum(axis=1), parts.weight[:, bins].sum(axis=1))

    out: dict[str, Any] = {}
    for name in _MEANS:
        out |= _spread(name, *tally.interval(mean(name)))
    ends, linear_ends = mean("end_effector_cm"), mean("end_effector_cm", LINEAR)
    gain = tally.Mean(linear_ends.total - ends.total, ends.weight)
    out |= _spread("end_effector_gain_cm", *tally.interval(gain))
    own, linear = mean("collisions"), mean("collisions", LINEAR)
    out["linear_collisions"] = int(linear.total.sum())
    share = (np.nan,) * 3
    if linear.total.sum() >= FEWEST:
        share = tally.ratio(tally.Mean(100.0 * own.total, own.weight), linear)
    return out | _spread("collisions_pct_of_linear", *share)


def _total(sums: Sums) -> Floats:
    return np.asarray(sums.total.sum(axis=1))


def _spread(
    name: str, value: float = np.nan, low: float = np.nan, high: float = np.nan
) -> dict[str, Any]:
    return {
        f"{name}{suffix}": None if np.isnan(number) else round(float(number), 4)
        for suffix, number in zip(("", "_low", "_high"), (value, low, high), strict=True)
    }
