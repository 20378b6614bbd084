"""Re-planting: feet that stand off their place are put right, one after the other."""

import numpy as np

from stridewire._messages import CharacterSpec, Open, Step
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime

DT = 1 / 60


def test_standing_feet_step_to_their_place_one_at_a_time(small_library: Library) -> None:
    """Feet that stand a foot's length aside come back within three seconds, lifted, in turn."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(Open([CharacterSpec(1, stitcher="stance")], seed=5))
    state = session.crowd.state
    for i in range(120):
        runtime.advance([(session, Step(i, DT))])
    aside = np.array([[[0.16, 0.0, 0.0], [-0.12, 0.0, 0.0]]])
    state.toe_shown += aside
    state.toe_gap += aside
    state.lock_point += aside
    height = state.toe_shown[0, :, 1].copy()
    steps, heights, targets = [], [], []
    for i in range(180):
        ((frame, _),) = runtime.advance([(session, Step(i, DT))])
        steps.append(state.toe_step[0] > 0.0)
        heights.append(state.toe_shown[0, :, 1] - height)
        targets.append(frame.foot_targets[0, :, 0])
        # bits of left foot and left toe
        assert (int(frame.contacts[0]) & 3 == 0) == steps[-1][0]
    assert np.any(steps, axis=0).all()
    assert not np.all(steps, axis=1).any()
    assert (np.max(heights, axis=0) > 0.01).all()
    assert np.abs(state.toe_gap[0, :, [0, 2]]).max() < 0.03
    # the lock is let go for the step and taken up where the foot comes to stand
    assert np.isnan(targets).any(axis=0).all()
    assert np.abs(targets[-1] - state.toe_shown[0, :, 0]).max() < 0.01


def test_feet_in_their_place_never_step(small_library: Library) -> None:
    """Standing as the clip stands takes no step."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(Open([CharacterSpec(1, stitcher="stance")], seed=5))
    for i in range(180):
        runtime.advance([(session, Step(i, DT))])
        assert not session.crowd.state.toe_step.any()
