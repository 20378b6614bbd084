"""Footing and legs: planted toes stay, gaps close in swing, feet roll where legs are too short."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.stitchers import footing
from stridewire_engine.stitchers.footing import Toes
from stridewire_engine.stitchers.legs import Legs, bend, leg_pose, raise_heels, smooth_min
from unit.stitchers.motions import J, N

DT = np.full(N, 1 / 60)
HALF = np.full((N, 2), 0.1)
LANDING = 0.02


def run(planted: float, speed: float, frames: int, dt: np.ndarray = DT) -> np.ndarray:
    """Return the ways `(frames, N, 2, 3)` of toes whose targets stand 30 cm away."""
    zero = np.zeros((N, 2, 3))
    toes = Toes(zero, zero + np.array([speed, 0.0, 0.0]))
    target = Toes(zero + np.array([0.0, 0.0, 0.3]), zero)
    way = []
    for _ in range(frames):
        gap, rate = toes.position - target.position, toes.velocity - target.velocity
        share = np.full((N, 2), planted)
        toes = footing.step(toes, gap, rate, target, share, HALF, 0.0 * HALF, LANDING, dt)
        way.append(toes.position)
    return np.stack(way)


def test_a_planted_toe_at_rest_stays_whatever_its_target() -> None:
    """Not a hair's breadth, however far off it stands."""
    assert np.array_equal(run(1.0, 0.0, 60), np.zeros((60, N, 2, 3)))


def test_a_toe_that_lands_stops_within_its_way() -> None:
    """At 1 m/s it goes on by the half-life over ln 2, 2.9 cm, and no further."""
    way = run(1.0, 1.0, 60)[..., 0]
    assert np.allclose(way[-1], LANDING / np.log(2.0), atol=1e-4)
    assert np.all(np.diff(way, axis=0) >= 0.0)


def test_a_swinging_toe_reaches_its_target() -> None:
    """A gap of 30 cm is closed to a millimetre within a second, without a step at the start."""
    way = run(0.0, 0.0, 60)[..., 2]
    assert np.allclose(way[-1], 0.3, atol=1e-3)
    assert way[0].max() < 0.01


@pytest.mark.parametrize("planted", [0.0, 1.0])
def test_the_step_does_not_matter(planted: float) -> None:
    """Twice as many steps of half the length lead to the same place."""
    once = run(planted, 0.7, 10)[-1]
    assert np.allclose(run(planted, 0.7, 20, 0.5 * DT)[-1], once, atol=1e-9)


def test_settled_gaps_are_left_alone() -> None:
    """A toe about to land only brakes: its gap is not closed any more."""
    zero = np.zeros((N, 2, 3))
    gap = zero + np.array([0.0, 0.0, 0.3])
    toes = Toes(gap, zero)
    for _ in range(30):
        toes = footing.step(
            toes, toes.position, toes.velocity, Toes(zero, zero), 0.0 * HALF, HALF,
            np.ones((N, 2)), LANDING, DT,
        )  # fmt: skip
    assert np.allclose(toes.position, gap)


def test_fast_feet_close_gaps_sooner() -> None:
    """The half-life falls with the speed of the clip's toe, between its bounds."""
    halflife = footing.swing_halflife(np.array([0.0, 0.5, 5.0]), 0.06, 0.4)
    assert halflife[0] == 0.4
    assert halflife[0] > halflife[1] > halflife[2] > 0.06


def test_feet_roll_so_that_ankles_are_in_reach() -> None:
    """A toe 30 cm behind its hip keeps its place; the heel rises and the leg reaches."""
    legs = Legs.of(REFERENCE)
    hips = np.tile(np.array([0.0, 0.94, 0.0], np.float32), (N, 1))
    rotations = quaternion.identity(N, J)
    pose = leg_pose(legs, hips, rotations)
    toes = pose.toe - np.array([0.0, 0.0, 0.3], np.float32)
    reach = np.full((N, 2), 0.985 * legs.length)
    rolled, ankles = raise_heels(pose, toes, reach)
    assert np.linalg.norm(toes + (pose.ankle - pose.toe) - pose.hip, axis=-1).min() > reach.max()
    assert np.linalg.norm(ankles - pose.hip, axis=-1).max() <= reach.max() + 1e-4
    bent, reached = bend(legs, rolled, rotations, ankles)
    assert np.allclose(reached, ankles, atol=1e-4)
    assert np.allclose(leg_pose(legs, hips, bent).toe, toes, atol=1e-3)


def test_feet_within_reach_do_not_roll() -> None:
    """A bent leg's foot keeps its rotation."""
    legs = Legs.of(REFERENCE)
    hips = np.tile(np.array([0.0, 0.85, 0.0], np.float32), (N, 1))
    pose = leg_pose(legs, hips, quaternion.identity(N, J))
    standing = pose.toe + np.array([0.0, 0.1, 0.0], np.float32)
    rolled, _ = raise_heels(pose, standing, np.full((N, 2), 0.985 * legs.length))
    assert np.allclose(rolled.foot, pose.foot, atol=1e-5)


def test_the_smooth_minimum_is_the_minimum_away_from_the_corner() -> None:
    """And never above it; at the corner it is a quarter of the width below."""
    a = np.array([0.0, 1.0, 0.5])
    b = np.array([1.0, 0.0, 0.5])
    assert smooth_min(a, b, 0.1) == pytest.approx([0.0, 0.0, 0.475])
