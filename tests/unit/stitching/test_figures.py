"""The report's figures are the judge's."""

import numpy as np
import pytest

from stridewire.motion import kinematics
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.evaluation import metrics
from stridewire_engine.library import Library
from stridewire_engine.stitching.alignment import lay
from stridewire_engine.stitching.figures import figures, leg_paths
from unit.stitching.clips import cuts_of


def test_figures_agree_with_the_judges_definitions(small_library: Library) -> None:
    """Sliding C and A, jerk of toes and knees, over all frames of clips laid end to end."""
    plan = lay(cuts_of(small_library))
    everything = np.ones(len(plan), bool)
    found = figures(plan, leg_paths(plan, plan.hips, plan.rotations), everything)
    places, _ = kinematics.forward_world(REFERENCE, plan.pose(slice(None)).astype(np.float64))
    toes = places[:, REFERENCE.indices(["LeftToe", "RightToe"])]
    knees = places[:, REFERENCE.indices(["LeftLeg", "RightLeg"])]
    speed = 100.0 * metrics.planar_speed(toes, 60.0)
    height = toes[..., 1] - plan.legs.toe_height
    expected = {
        "sliding_c_cm_s": metrics.sliding_c(speed, plan.contacts),
        "sliding_a_cm_s": metrics.sliding_a(speed, height),
        "toe_jerk": metrics.jerk(toes, 60.0),
        "knee_jerk": metrics.jerk(knees, 60.0),
    }
    for name, values in expected.items():
        assert getattr(found, name) == pytest.approx(np.nanmean(values), rel=2e-3), name
    step = 100.0 * metrics.velocity_step(toes, 60.0)
    at_seams = [step[seam : seam + 2].max() for seam in plan.seams]
    assert found.seam_step_cm_s == pytest.approx(np.mean(at_seams), rel=1e-3)
