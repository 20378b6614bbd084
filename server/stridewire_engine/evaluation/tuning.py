"""Tuning: a seeded search for settings and weights, and its front of quality against response.

Objectives, both to be small, over the scripts that may be tuned on and stance with foot lock:

- *flaws* = transitions a second + 5 x jump share in % + |log2 jerk ratio| + lag behind the clip in
  decimetres: what one sees of the seams;
- *following error* in metres: what a player feels.

Sliding is no objective: the stitcher that plants feet keeps it below the captured whatever the
settings are.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.bench import Measurement
from stridewire_engine.evaluation.cell import TUNING_SEEDS, Cell
from stridewire_engine.evaluation.table import pooled
from stridewire_engine.runtime import TickSettings
from stridewire_engine.runtime.response import NEUTRAL

TUNED_SCRIPTS = ("stroll", "sprint", "stop-and-go", "u-turns", "strafe", "circle", "idle")
SETTING_RANGES = {
    "velocity_halflife": (0.1, 0.4),
    "facing_halflife": (0.1, 0.4),
    "search_interval": (0.08, 0.3),
    "continuing_bias": (0.1, 3.0),
    "least_improvement": (0.03, 0.5),
    "reselect_history": (0.3, 1.5),
    "root_halflife": (0.06, 0.25),
    "adjust_position_halflife": (0.1, 0.5),
    "adjust_yaw_halflife": (0.1, 0.5),
    "adjust_share": (0.03, 0.25),
}
WEIGHT_RANGES = {
    "foot-position": (0.2, 2.0),
    "hips-velocity": (0.3, 3.0),
    "trajectory-position": (0.3, 4.0),
    "trajectory-direction": (0.5, 8.0),
}
"""The weight of foot velocities stays 1: a common factor changes nothing but biases."""
_FIGURES = (
    "transitions_per_s", "jump_pct", "jerk_ratio", "clip_lag_cm", "following_error_m",
    "sliding_c_cm_s", "float_cm",
)  # fmt: skip
_SECONDS = 8.0


@dataclass(frozen=True)
class Candidate:
    """What is tried."""

    settings: TickSettings
    weights: tuple[tuple[str, float], ...] = ()
    """Of channels; the others have the schema's."""
    responsiveness: float = NEUTRAL

    def data(self) -> dict[str, float]:
        """Return what a search may change, as plain numbers for JSON."""
        chosen = {name: getattr(self.settings, name) for name in SETTING_RANGES}
        return {name: round(value, 4) for name, value in {**chosen, **dict(self.weights)}.items()}

    @classmethod
    def of(cls, data: Mapping[str, float]) -> "Candidate":
        """Return the candidate of such numbers."""
        changed: dict[str, Any] = {name: data[name] for name in SETTING_RANGES if name in data}
        weights = tuple((name, data[name]) for name in WEIGHT_RANGES if name in data)
        return cls(replace(TickSettings(), **changed), weights)


@dataclass(frozen=True)
class Trial:
    """A candidate and how good it is."""

    candidate: Candidate
    flaws: float
    following_error_m: float
    figures: Mapping[str, float]

    def data(self) -> dict[str, Any]:
        """Return plain numbers for JSON."""
        return {
            "flaws": round(self.flaws, 4),
            "following_error_m": round(self.following_error_m, 4),
            **{name: round(value, 4) for name, value in self.figures.items()},
            **self.candidate.data(),
        }


Measure = Callable[[Sequence[Cell]], Mapping[Cell, Measurement]]


def search(
    measure: Measure, trials: int, seed: int = 0, begin: Candidate | None = None
) -> Iterator[Trial]:
    """Yield the beginning and then so many candidates, each drawn near a good one or anywhere.

    A third of them is drawn log-evenly from the ranges; the others change about a third of the
    numbers of a member of the front found so far, each by a factor of about 1.35.

    Args:
        measure: Measures cells of the library that is tuned on.
        trials: How many candidates.
        seed: Of the draws.
        begin: Where to begin; the defaults if none is given.
    """
    rng = np.random.default_rng(seed)
    found = [try_out(measure, begin or Candidate(TickSettings()))]
    yield found[0]
    ranges = {**SETTING_RANGES, **WEIGHT_RANGES}
    for number in range(trials):
        if number % 3 == 0:
            drawn = {name: _draw(rng, *bounds) for name, bounds in ranges.items()}
        else:
            best = front(found)
            parent = best[rng.integers(len(best))].candidate.data()
            drawn = _varied(rng, parent, ranges)
        found.append(try_out(measure, Candidate.of(drawn)))
        yield found[-1]


def try_out(
    measure: Measure, candidate: Candidate, seeds: tuple[int, ...] = TUNING_SEEDS[:3]
) -> Trial:
    """Measure a candidate on the tuned scripts."""
    cells = [
        Cell(
            script, stitch="stance", seeds=seeds, seconds=_SECONDS,
            settings=candidate.settings, weights=candidate.weights,
            responsiveness=candidate.responsiveness,
        )
        for script in TUNED_SCRIPTS
    ]  # fmt: skip
    found = measure(cells)
    both = pooled([found[cell] for cell in cells], "all")
    figures = {name: tally.value(both[name]) for name in _FIGURES}
    flaws = (
        figures["transitions_per_s"]
        + 5.0 * figures["jump_pct"]
        + abs(float(np.log2(figures["jerk_ratio"])))
        + 0.1 * figures["clip_lag_cm"]
    )
    return Trial(candidate, flaws, figures["following_error_m"], figures)


def front(trials: Sequence[Trial]) -> list[Trial]:
    """Return the trials that none of the others beats in both objectives, best response first."""
    ordered = sorted(trials, key=lambda t: (t.following_error_m, t.flaws))
    best: list[Trial] = []
    for trial in ordered:
        if not best or trial.flaws < best[-1].flaws:
            best.append(trial)
    return best


def decide(candidates: Sequence[Trial], begin: Trial) -> Trial:
    """Return the candidate that is best beside the beginning: the sum of both ratios is smallest.

    Args:
        candidates: Measured on the library that decides.
        begin: What they are to be better than, measured there, too.
    """
    return min(
        [begin, *candidates],
        key=lambda t: t.flaws / begin.flaws + t.following_error_m / begin.following_error_m,
    )


def _varied(
    rng: np.random.Generator, parent: dict[str, float], ranges: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    """Change about a third of a parent's numbers, within the ranges."""
    varied = dict(parent)
    for name, (low, high) in ranges.items():
        factor, chosen = np.exp(rng.normal(0.0, 0.3)), rng.random() < 0.35
        if chosen:
            before = parent.get(name, float(np.sqrt(low * high)))
            varied[name] = float(np.clip(before * factor, low, high))
    return varied


def _draw(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))
