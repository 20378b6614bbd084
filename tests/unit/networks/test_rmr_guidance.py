"""The refiner's numbers: told in the plan's own frame, nothing before a seam, labels by default."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire_engine.networks.rmr import Plans, Refiner, seams_of
from stridewire_engine.networks.rmr.features import INPUTS, inputs
from stridewire_engine.networks.rmr.guidance import CURVES, PLANTED, basis
from unit.networks.rmr_plans import StandIn, plans


def moved(plan: Plans, yaw: float) -> Plans:
    """Return the plans somewhere else in the world."""
    turn, away = quaternion.from_yaw(np.array(yaw)), np.array([3.0, 0.0, -7.0])

    def go(points: np.ndarray) -> np.ndarray:
        return quaternion.rotate(np.broadcast_to(turn, (*points.shape[:-1], 4)), points) + away

    return replace(
        plan,
        root=go(plan.root),
        yaw=plan.yaw + yaw,
        hips=go(plan.hips),
        toes=go(plan.toes),
        ankles=go(plan.ankles),
        clip_toes=go(plan.clip_toes),
    )


def test_features_do_not_depend_on_the_place() -> None:
    """A plan elsewhere in the world reads the same."""
    plan = plans()
    assert inputs(plan).shape == (3, 60, INPUTS)
    np.testing.assert_allclose(inputs(moved(plan, 2.0)), inputs(plan), atol=1e-4)


def test_a_network_that_says_nothing_changes_nothing() -> None:
    """Zeros leave the clips' labels and no offset."""
    plan = plans()
    said = Refiner(StandIn()).refine(plan)
    np.testing.assert_array_equal(said.planted > 0.5, plan.contacts)
    assert not said.toe_offset.any()
    assert not said.foot_turn.any()


def test_nothing_happens_before_the_first_seam() -> None:
    """Frames that were sent keep labels and places, whatever the network says."""
    plan = plans(seam=20)
    said = Refiner(StandIn(np.ones(CURVES), np.full(PLANTED, 9.0))).refine(plan)
    assert not said.toe_offset[:, :21].any()
    np.testing.assert_array_equal(said.planted[:, :20], plan.contacts[:, :20])
    assert (said.planted[:, 20:] > 0.99).all()
    np.testing.assert_allclose(np.linalg.norm(said.toe_offset[:, 40:], axis=-1), 0.1 * 3**0.5)


def test_offsets_turn_with_the_plan() -> None:
    """What the network says in the plan's frame is told in the world."""
    ahead = np.zeros(CURVES)
    ahead[2] = 1.0
    plan = plans()
    said = Refiner(StandIn(ahead)).refine(plan)
    yaw = plan.yaw[:, 40]
    expected = 0.1 * np.stack([np.sin(yaw), 0.0 * yaw, np.cos(yaw)], axis=-1)
    np.testing.assert_allclose(said.toe_offset[:, 40, 0], expected, atol=1e-12)
    assert not said.toe_offset[:, :, 1].any()


def test_curves_are_smooth() -> None:
    """One control point moves a few tokens, by a curve without corners."""
    weights = basis(60)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)
    alone = weights[:, 7]
    assert (alone > 0.0).sum() == 16
    assert np.abs(np.diff(alone, n=2)).max() < 0.1


def test_seams_are_found() -> None:
    """Each frame knows its last seam; those before the first know the first."""
    starts = np.zeros((1, 8), bool)
    starts[0, [0, 3, 5]] = True
    np.testing.assert_array_equal(seams_of(starts), [[3, 3, 3, 3, 3, 5, 5, 5]])
    with pytest.raises(ValueError, match="no seam"):
        seams_of(np.zeros((1, 8), bool))


def test_odd_windows_are_refused() -> None:
    """The network reads four frames at once."""
    with pytest.raises(ValueError, match="multiple of 4"):
        Refiner(StandIn()).refine(plans(frames=58))
