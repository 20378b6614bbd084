"""The stance stitcher, live: feet stay through transitions, and it costs no call a character."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, GroundPose, Open, Step
from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.evaluation.figures import Figures, Judged
from stridewire_engine.evaluation.streaming import streams, wanted_of
from stridewire_engine.evaluation.tally import interval
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import Runtime
from stridewire_engine.stitchers import STITCHERS

CELL = Cell("stroll", foot_lock=False, forced_interval_frames=20, seeds=(1, 2), seconds=5.0)
NAMES = [stitcher.name for stitcher in STITCHERS]


@pytest.fixture(scope="module")
def judged(small_library: Library) -> dict[str, Figures]:
    """Return the figures of spring and stance under forced transitions."""
    captured, matcher, asked = Captured(small_library), Matcher(small_library), wanted_of(CELL)
    out = {}
    for name in ("spring", "stance"):
        cell = replace(CELL, stitch=name)
        made = next(streams(small_library, matcher, [cell], [asked]))
        out[name] = Judged(made, captured).streamed(np.ones(made.since.shape, bool))
    return out


def value(figures: Figures, name: str) -> float:
    """Return a figure without its interval."""
    return interval(figures[name])[0]


def test_planted_feet_stay_through_transitions(judged: dict[str, Figures]) -> None:
    """Sliding, with and without labels, is a small part of the spring's."""
    for figure, most in (("sliding_c_cm_s", 0.3), ("sliding_a_cm_s", 0.7)):
        assert value(judged["stance"], figure) < most * value(judged["spring"], figure)


def test_the_price_is_bounded(judged: dict[str, Figures]) -> None:
    """Knees jerk a little more, toes no more, nothing floats away from the clip."""
    assert value(judged["stance"], "knee_jerk") < 1.6 * value(judged["spring"], "knee_jerk")
    assert value(judged["stance"], "toe_jerk") < 1.1 * value(judged["spring"], "toe_jerk")
    assert value(judged["stance"], "clip_lag_cm") < 20.0


def runtime_of(library: Library, count: int) -> tuple[Runtime, object]:
    """Return a runtime with characters that are stitched by stance."""
    runtime = Runtime([library], clock=lambda: 0.0)
    specs = [CharacterSpec(i, GroundPose((3.0 * i, 0, 0)), stitcher="stance") for i in range(count)]
    return runtime, runtime.open(Open(specs, seed=5))


def test_a_pause_repeats_the_pose(small_library: Library) -> None:
    """A step of no time shows the same again, and what follows is as if there had been none."""
    frames = []
    for pause in (0, 5):
        runtime, session = runtime_of(small_library, 2)
        for i in range(90):
            step = Step(i, 1 / 60, velocity_xz=np.tile([0.0, 1.4], (2, 1)))
            ((frame, _),) = runtime.advance([(session, step)])  # type: ignore[list-item]
            for _ in range(pause if i == 60 else 0):
                ((same, _),) = runtime.advance([(session, Step(i, 0.0))])  # type: ignore[list-item]
                assert np.allclose(same.rotations, frame.rotations, atol=1e-6)
        frames.append(frame)
    assert np.allclose(frames[0].rotations, frames[1].rotations, atol=1e-4)


def test_a_change_of_stitcher_takes_effect_at_a_transition(small_library: Library) -> None:
    """Stitchers changed at random never make a joint jump further than none changed."""
    from stridewire._messages import CharacterUpdate, Edit

    steps = []
    for changing in (False, True):
        runtime, session = runtime_of(small_library, 1)
        names = np.random.default_rng(3).choice(["spring", "stance", "quintic", "dead-blend"], 300)
        toes = []
        for i, name in enumerate(names):
            if changing and i % 7 == 0:
                update = CharacterUpdate(CharacterSpec(0, stitcher=str(name)), ("stitcher",))
                assert runtime.edit(session, Edit(update=[update])) is None  # type: ignore[arg-type]
            velocity = [[0.0, 1.4]] if i % 100 < 60 else [[1.4, 0.0]]
            step = Step(i, 1 / 60, velocity_xz=velocity)
            ((frame, _),) = runtime.advance([(session, step)])  # type: ignore[list-item]
            toes.append(frame.rotations[0])
        steps.append(np.abs(np.diff(np.array(toes), axis=0)).max())
    assert steps[1] < 2.0 * steps[0]
