"""Tuning: a seeded search for settings of the tick, and its front of quality against response.

Objectives, both to be small, over the scripts that may be tuned on:

- *flaws* = transitions a second + 5 x jump share in % + |log2 jerk ratio| + lag behind the clip in
  decimetres: what one sees of the seams;
- *following error* in metres: what a player feels.

Sliding is no objective: the stitcher that plants feet keeps it below the captured whatever the
settings are.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.bench import Bench
from stridewire_engine.evaluation.cell import TUNING_SEEDS, Cell
from stridewire_engine.runtime import TickSettings

TUNED_SCRIPTS = ("stroll", "sprint", "stop-and-go", "u-turns", "strafe", "circle", "idle")
_RANGES = {
    "velocity_halflife": (0.15, 0.4),
    "facing_halflife": (0.15, 0.4),
    "search_interval": (0.1, 0.3),
    "continuing_bias": (0.2, 3.0),
    "least_improvement": (0.05, 0.5),
    "reselect_history": (0.3, 1.5),
    "idle_speed": (0.05, 0.2),
    "root_halflife": (0.08, 0.25),
    "adjust_position_halflife": (0.1, 0.5),
    "adjust_yaw_halflife": (0.1, 0.5),
    "adjust_share": (0.03, 0.25),
}


@dataclass(frozen=True)
class Trial:
    """Settings and how good they are."""

    settings: TickSettings
    flaws: float
    following_error_m: float
    figures: Mapping[str, float]

    def data(self) -> dict[str, Any]:
        """Return plain numbers for JSON."""
        changed = {name: round(getattr(self.settings, name), 4) for name in _RANGES}
        return {
            "flaws": round(self.flaws, 4),
            "following_error_m": round(self.following_error_m, 4),
            **{name: round(value, 4) for name, value in self.figures.items()},
            **changed,
        }


def search(bench: Bench, trials: int, seed: int = 0) -> Iterator[Trial]:
    """Yield the defaults and then so many candidates, each drawn near a good one or anywhere.

    Half of them are drawn log-evenly from the ranges; the others change about a third of the
    settings of a member of the front found so far.
    """
    rng = np.random.default_rng(seed)
    found = [try_out(bench, TickSettings())]
    yield found[0]
    for number in range(trials):
        drawn = {name: _draw(rng, *bounds) for name, bounds in _RANGES.items()}
        parent = TickSettings()
        if number % 2:
            best = front(found)
            parent = best[rng.integers(len(best))].settings
            kept = rng.random(len(drawn)) < 0.65
            drawn = {n: v for (n, v), keep in zip(drawn.items(), kept, strict=True) if not keep}
        found.append(try_out(bench, replace(parent, **drawn)))
        yield found[-1]


def try_out(
    bench: Bench, settings: TickSettings, seeds: tuple[int, ...] = TUNING_SEEDS[:3]
) -> Trial:
    """Measure settings on the tuned scripts."""
    names = (
        "transitions_per_s", "jump_pct", "jerk_ratio", "clip_lag_cm", "following_error_m",
        "sliding_c_cm_s", "float_cm",
    )  # fmt: skip
    cells = [
        Cell(script, stitch="stance", seeds=seeds, seconds=8.0, settings=settings)
        for script in TUNED_SCRIPTS
    ]
    parts = [bench.measure(cell)["all"] for cell in cells]
    figures = {name: tally.interval(tally.pool([p[name] for p in parts]))[0] for name in names}
    flaws = (
        figures["transitions_per_s"]
        + 5.0 * figures["jump_pct"]
        + abs(float(np.log2(figures["jerk_ratio"])))
        + 0.1 * figures["clip_lag_cm"]
    )
    return Trial(settings, flaws, figures["following_error_m"], figures)


def front(trials: Sequence[Trial]) -> list[Trial]:
    """Return the trials that none of the others beats in both objectives, best response first."""
    ordered = sorted(trials, key=lambda t: (t.following_error_m, t.flaws))
    best: list[Trial] = []
    for trial in ordered:
        if not best or trial.flaws < best[-1].flaws:
            best.append(trial)
    return best


def _draw(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))
