"""The look inside: told only when asked for, and true to what the frames then show."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import Detail, Open, Step
from stridewire_engine.runtime import Runtime
from stridewire_engine.runtime.inside import AHEAD_S
from unit.runtime.conftest import DT, one, opening


def plain(**given: object) -> Open:
    """Return an Open of two characters that show what their clips hold."""
    asked = opening(2, **{"detail": Detail.INSIDE, **given})
    bare = [replace(spec, stitcher="none", foot_lock=False) for spec in asked.characters]
    return replace(asked, characters=bare)


def test_only_those_who_ask_are_told(runtime: Runtime) -> None:
    """INSIDE tells all that COSTS tells; without it there is nothing."""
    for detail in Detail:
        frame, _ = one(runtime, runtime.open(opening(1, detail=detail)), Step(1, DT))
        assert (frame.inside is not None) == (detail is Detail.INSIDE)
        assert (frame.simulated_root is not None) == (detail >= Detail.COSTS)


@pytest.mark.parametrize("height_m", [0.0, 1.2])
def test_the_sampled_pose_is_what_a_cut_shows(runtime: Runtime, height_m: float) -> None:
    """Without stitcher and foot lock the sampled pose is the frame's own, whatever the size."""
    asked = plain()
    asked = replace(asked, characters=[replace(s, height_m=height_m) for s in asked.characters])
    session = runtime.open(asked)
    for i in range(60):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=np.float32([[0, 1.4]] * 2)))
        assert frame.inside is not None
        np.testing.assert_allclose(frame.inside.rotations, frame.rotations, atol=1e-5)
        np.testing.assert_allclose(frame.inside.hips, frame.hips, atol=1e-5)


def test_the_ways_ahead_begin_at_the_roots_and_come_true(runtime: Runtime) -> None:
    """A tenth of a second later the roots are within centimetres of what was told."""
    session = runtime.open(plain())
    step = Step(0, DT, velocity_xz=np.float32([[0.3, 1.3], [-1.0, 0.9]]))
    for _ in range(120):
        frame, _ = one(runtime, session, step)
    before = frame.inside
    assert before is not None
    assert before.predicted.shape == before.captured.shape == (2, len(AHEAD_S), 3)
    for _ in range(round(AHEAD_S[0] / DT)):
        frame, _ = one(runtime, session, step)
    assert frame.simulated_root is not None
    assert np.abs(before.predicted[:, 0, :2] - frame.simulated_root[:, [0, 2]]).max() < 0.05
    assert np.abs(before.captured[:, 0, :2] - frame.root[:, [0, 2]]).max() < 0.08
