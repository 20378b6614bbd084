"""Metrics on constructed motions whose sliding, jerk and delays are known exactly."""

import numpy as np
import pytest

from stridewire_engine.evaluation import metrics
from stridewire_engine.evaluation.responses import CHANGES, accelerations, turns

RATE = 60.0


def path(velocity: tuple[float, float, float], frames: int = 31) -> np.ndarray:
    """Return one point `(T, 1, 3)` of constant velocity, m/s."""
    return np.arange(frames)[:, None, None] / RATE * np.array(velocity)


def test_sliding_is_planar_speed() -> None:
    """A toe that moves 3, 4 cm/s over the ground and 1 m/s up slides 5 cm/s."""
    speed = metrics.planar_speed(path((0.03, 1.0, 0.04)), RATE)
    assert np.isnan(speed[0, 0])
    assert np.allclose(speed[1:], 0.05)


def test_sliding_c_counts_planted_frames_alone() -> None:
    """A frame counts where the toe is planted now and was before; skating elsewhere is free."""
    speed = metrics.planar_speed(np.concatenate([path((0, 0, 0), 11), path((6, 0, 0), 5)]), RATE)
    planted = np.arange(16)[:, None] < 11
    counted = metrics.sliding_c(speed, planted)
    assert np.count_nonzero(~np.isnan(counted)) == 10
    assert np.nansum(counted) == 0.0


def test_sliding_a_counts_low_frames_and_b_fades_out() -> None:
    """A takes what is below 2 cm; B takes all of it on the ground, nothing from 2.5 cm on."""
    speed, height = np.full((3, 1), 0.5), np.array([[0.0], [0.0199], [0.025]])
    assert metrics.sliding_a(speed, height)[:, 0] == pytest.approx([0.5, 0.5, np.nan], nan_ok=True)
    weighted = metrics.sliding_b(speed, height)[:, 0]
    assert weighted[0] == 0.5
    assert weighted[0] > weighted[1] > weighted[2] == 0.0


def test_jerk_of_a_cubic_is_six_times_its_coefficient() -> None:
    """X = 2 t³ has a jerk of 12 m/s³, a parabola none."""
    time = np.arange(40)[:, None] / RATE
    zero = 0.0 * time
    assert np.allclose(metrics.jerk(np.stack([2 * time**3, zero, zero], -1), RATE)[3:], 12.0)
    assert np.allclose(metrics.jerk(np.stack([9 * time**2, zero, zero], -1), RATE)[3:], 0.0)


def test_a_kink_is_a_velocity_step() -> None:
    """A point that starts to move at 1.5 m/s steps by 1.5 m/s in one frame and never else."""
    points = np.concatenate([path((0, 0, 0), 10), path((1.5, 0, 0), 10)[1:]])
    step = metrics.velocity_step(points, RATE)[2:, 0]
    assert step.max() == pytest.approx(1.5)
    assert np.count_nonzero(step > 1e-9) == 1


def test_a_delay_is_a_following_error() -> None:
    """At 2 m/s a delay of 0.3 s is 0.6 m at most, and over once the way runs alongside."""
    wanted = np.zeros((240, 1, 2))
    wanted[60:, 0, 1] = 2.0
    done = np.roll(wanted, 18, axis=0)
    done[:18] = 0.0
    position = np.cumsum(done, axis=0) / RATE
    error = metrics.following_error(position, wanted, RATE)[60:, 0]
    assert error.max() == pytest.approx(0.6)
    assert error[-30:].max() == pytest.approx(0.0, abs=1e-9)


def test_half_the_speed_is_half_the_way() -> None:
    """Whoever walks at half of 2 m/s is a metre short every second."""
    wanted = np.full((200, 1, 2), 1.0) * (0.0, 2.0)
    position = np.cumsum(0.5 * wanted, axis=0) / RATE
    assert np.allclose(metrics.following_error(position, wanted, RATE)[60:], 1.0)


def test_float_and_penetration() -> None:
    """Planted toes 5 cm up float by 3, toes 1 cm below the floor are 1 cm in it."""
    planted = np.ones((2, 1), bool)
    height = np.array([[0.05], [-0.01]])
    assert np.allclose(metrics.floating(height, planted)[:, 0], [0.03, 0.0])
    assert np.allclose(metrics.penetration(height, planted)[:, 0], [0.0, 0.01])
    assert np.isnan(metrics.floating(height, ~planted)).all()


def test_locks() -> None:
    """Offsets are planar; the locked share counts planted toes alone."""
    toes, targets = np.zeros((4, 1, 3)), np.full((4, 1, 3), np.nan)
    targets[:2] = (0.03, 0.5, 0.04)
    offset = metrics.lock_offset(toes, targets)[:, 0]
    assert offset == pytest.approx([0.05, 0.05, np.nan, np.nan], nan_ok=True)
    share = metrics.locked_share(targets, np.array([[True], [True], [True], [False]]))
    assert np.nanmean(share) == pytest.approx(2 / 3)


def test_a_straight_leg_is_fully_extended() -> None:
    """1 for a straight knee, 0.7071 for one bent by a right angle with equal bones."""
    hip, straight, bent = np.zeros((1, 3)), np.array([[0.0, -2.0, 0.0]]), np.array([[1.0, -1, 0]])
    knee = np.array([[0.0, -1.0, 0.0]])
    assert metrics.extension(hip, knee, straight)[0] == pytest.approx(1.0)
    assert metrics.extension(hip, knee, bent)[0] == pytest.approx(np.sqrt(0.5))


def test_a_rise_of_one_second_takes_0_8_from_10_to_90_percent() -> None:
    """A linear rise from standing to 1.3 m/s within a second is an event of 0.8 s."""
    speed = np.interp(np.arange(240) / RATE, [1.0, 2.0], [0.0, 1.3])
    assert accelerations(speed, CHANGES[0]) == [pytest.approx(0.8, abs=2.5 / RATE)]
    assert accelerations(speed, CHANGES[1]) == []


def test_a_turn_of_90_degrees_within_a_second_takes_0_8() -> None:
    """Turns count while walking, from 10 to 90 %, either way; smaller ones and standing do not."""
    yaw = np.interp(np.arange(240) / RATE, [1.0, 2.0], [0.0, 0.5 * np.pi])
    walking = np.full(240, 1.3)
    for sign in (1.0, -1.0):
        assert turns(sign * yaw, walking, 0.5 * np.pi) == [pytest.approx(0.8, abs=0.06)]
    assert turns(0.6 * yaw, walking, 0.5 * np.pi) == []
    assert turns(yaw, 0.0 * walking, 0.5 * np.pi) == []
