"""What was tried to make the live refiner better than `stance`, and what it costs the tick.

Tried on libraries that one may decide on, other seeds than those of reports.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from unittest import mock

import numpy as np
from judge_results import library
from points import Point
from refiner_live import CONDITIONS, SCRIPTS, Parts

from stridewire._messages import CharacterSpec, Detail, GroundPose, Open, Step, Transition
from stridewire.motion.array_types import Floats
from stridewire_engine.building import embedded_library
from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.bench import Bench
from stridewire_engine.evaluation.cell import TUNING_SEEDS, Cell
from stridewire_engine.evaluation.table import pooled
from stridewire_engine.networks.rmr import Guidance, Plans
from stridewire_engine.runtime import Runtime, refining

LIBRARIES = ("lafan1-dev", "cmu-seen")
_SEEDS = TUNING_SEEDS[:3]
_FIGURES = (
    "sliding_c_cm_s", "sliding_a_cm_s", "knee_jerk", "clip_lag_cm", "truth_error_cm",
)  # fmt: skip
_CONDITION = "every 20 frames"
_CHARACTERS = 256
_WARM, _FRAMES = 30, 90
_TURNING = 1.0 / 60.0
"""Share of the characters that are led elsewhere in a frame."""
_QUARTER = 0.25
Followed = Callable[[Plans, Guidance], Guidance]


def _labels(plans: Plans) -> Floats:
    return plans.contacts.astype(np.float64)


def _with_labels(share: float, planted: Callable[[Plans, Guidance], Floats]) -> Followed:
    """Return a way that leads swings by a share of the offsets."""
    return lambda plans, said: said._replace(
        planted=planted(plans, said), toe_offset=share * said.toe_offset
    )


def _own(plans: Plans, said: Guidance) -> Floats:
    return said.planted


def _both(plans: Plans, said: Guidance) -> Floats:
    return np.maximum(said.planted, plans.contacts)


def _no_heights(plans: Plans, said: Guidance) -> Guidance:
    return said._replace(toe_offset=said.toe_offset * np.array([1.0, 0.0, 1.0]))


def _nearer_counts_more(plans: Plans, said: Guidance) -> Guidance:
    share = np.clip(2.0 - said.distance, 0.0, 1.0)[:, None, None]
    planted = share * said.planted + (1.0 - share) * plans.contacts
    return said._replace(planted=planted, toe_offset=share[..., None] * said.toe_offset)


WAYS: Mapping[str, Followed] = {
    "all that the network says": _with_labels(1.0, _own),
    "its contacts alone": _with_labels(0.0, _own),
    "its targets alone": _with_labels(1.0, lambda plans, said: _labels(plans)),
    "without heights": _no_heights,
    "the less the further from the training data": _nearer_counts_more,
    "half of its targets": _with_labels(0.5, _own),
    "its contacts or the clip's": _with_labels(1.0, _both),
    "a third of its targets, its contacts or the clip's": _with_labels(1.0 / 3.0, _both),
    "half of its targets, its contacts or the clip's (kept)": refining.followed,
    "the network silent": _with_labels(0.0, lambda plans, said: _labels(plans)),
}


def remedies() -> Iterator[Point]:
    """Ways to follow the network; ratios to stance's."""
    for name in LIBRARIES:
        bench = Bench(library(name).path)
        stance = _streamed(bench, "stance")
        for way, followed in WAYS.items():
            with mock.patch.object(refining, "followed", followed):
                refine = _streamed(bench, "refine")
            yield Point(f"{way}; {_CONDITION}, {name}", _beside(refine, stance))


def tick_cost() -> Iterator[Point]:
    """What the refiner adds to the tick of 256 characters, two transitions a second each."""
    runs = [[_tick_s(stitcher) for stitcher in ("stance", "refine")] for _ in range(3)]
    stance, refine = np.median([[s for s, _ in run] for run in runs], axis=0)
    jumps = np.mean([[n for _, n in run] for run in runs], axis=0)
    added = (refine - stance) / (_FRAMES / 60.0)
    rate = jumps[1] / _CHARACTERS / (_FRAMES / 60.0)
    yield Point(
        f"refine beside stance, {_CHARACTERS} characters, {rate:.2f} transitions a second each",
        f"{1e3 * stance / _FRAMES:.2f} and {1e3 * refine / _FRAMES:.2f} ms a tick: "
        f"{added:.3f} of a core, {added * 2.0 / rate:.3f} at two transitions a second",
        "at most a quarter of a core at two transitions a second",
        added * 2.0 / rate <= _QUARTER,
    )


def _streamed(bench: Bench, stitcher: str) -> Parts:
    way = Cell("", stitch=stitcher, foot_lock=False, seeds=_SEEDS, **CONDITIONS[_CONDITION])
    return list(bench.measure_all([replace(way, script=script) for script in SCRIPTS]))


def _beside(ours: Parts, theirs: Parts) -> str:
    refine, stance = pooled(ours, "all"), pooled(theirs, "all")
    told = []
    for figure in _FIGURES:
        value, low, high = tally.ratio(refine[figure], stance[figure])
        told.append(f"{figure} {value:.2f} [{low:.2f}, {high:.2f}]")
    return ", ".join(told)


def _tick_s(stitcher: str) -> tuple[float, int]:
    """Return the processor seconds of some ticks, and the transitions in them."""
    runtime = Runtime([embedded_library()])
    specs: Sequence[CharacterSpec] = [
        CharacterSpec(i, GroundPose((2.0 * i, 0.0, 0.0)), stitcher=stitcher)
        for i in range(_CHARACTERS)
    ]
    session = runtime.open(Open(specs, seed=1, detail=Detail.EVENTS))
    rng = np.random.default_rng(0)
    way = rng.uniform(-2.0, 2.0, (_CHARACTERS, 2))
    began, frames = 0.0, []
    for number in range(_WARM + _FRAMES):
        if number == _WARM:
            frames.clear()
            began = time.thread_time()
        some = rng.random(_CHARACTERS) < _TURNING
        way[some] = rng.uniform(-2.0, 2.0, (int(some.sum()), 2))
        ((frame, _),) = runtime.advance([(session, Step(number, 1.0 / 60.0, velocity_xz=way))])
        frames.append(frame)
    passed = time.thread_time() - began
    # events are made when they are read, so that they cost nothing above
    return passed, sum(isinstance(e, Transition) for frame in frames for e in frame.events)
