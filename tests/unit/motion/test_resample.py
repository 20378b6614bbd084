"""Resampling: frames kept, steady motion exact, velocities continuous."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.resample import resample_rotations, resample_values


def test_twice_the_rate_and_back_is_the_same(swaying_clip: Clip) -> None:
    """30 to 60 to 30 frames a second gives the frames again, rotations and values."""
    rotations, hips = swaying_clip.pose.rotations[::2], swaying_clip.pose.hips[::2]
    up = resample_rotations(rotations, 30.0, 60.0)
    assert len(up) == 2 * len(rotations) - 1
    back = resample_rotations(up, 60.0, 30.0)
    np.testing.assert_allclose(np.abs(np.sum(back * rotations, axis=-1)), 1.0)
    values = resample_values(resample_values(hips, 30.0, 60.0), 60.0, 30.0)
    np.testing.assert_allclose(values, hips, atol=1e-12)


def test_missing_frames_are_found_nearly(swaying_clip: Clip) -> None:
    """Every second frame left out comes back to a tenth of a degree in smooth motion."""
    up = resample_rotations(swaying_clip.pose.rotations[::2], 30.0, 60.0)
    error = quaternion.to_scaled_axis(
        quaternion.multiply(up, quaternion.conjugate(swaying_clip.pose.rotations))
    )
    assert np.linalg.norm(error[2:-2], axis=-1).max() < np.radians(0.1)


def test_turning_at_constant_speed_is_exact() -> None:
    """A steady turn is the same steady turn at any rate."""
    axis = np.array([0.0, 0.6, 0.8])
    q = quaternion.from_scaled_axis(axis * (2.5 * np.arange(12)[:, None] / 24.0))
    out = resample_rotations(q, 24.0, 60.0)
    expected = quaternion.from_scaled_axis(axis * (2.5 * np.arange(len(out))[:, None] / 60.0))
    np.testing.assert_allclose(np.abs(np.sum(out * expected, axis=-1)), 1.0, atol=1e-12)


def test_angular_velocity_does_not_jump_at_frames(swaying_clip: Clip) -> None:
    """At the old frames the velocity is continuous; slerp would jump 200 times as much."""
    coarse, fine = 15.0, 6000.0
    q = swaying_clip.pose.rotations[::4]
    factor = round(fine / coarse)
    out = resample_rotations(q, coarse, fine)
    velocity = (
        quaternion.to_scaled_axis(quaternion.multiply(out[1:], quaternion.conjugate(out[:-1])))
        * fine
    )
    knots = np.arange(factor, len(velocity), factor)
    jump = np.abs(velocity[knots] - velocity[knots - 1]).max()
    secants = (
        quaternion.to_scaled_axis(quaternion.multiply(q[1:], quaternion.conjugate(q[:-1]))) * coarse
    )
    assert jump < 0.006 * np.abs(np.diff(secants, axis=0)).max()


@pytest.mark.parametrize(("rate", "new_rate"), [(120.0, 60.0), (24.0, 60.0), (50.0, 60.0)])
def test_the_length_in_seconds_stays(rate: float, new_rate: float) -> None:
    """The last new frame lies within one frame of the old end, and never past it."""
    out = resample_values(np.arange(101.0)[:, None], rate, new_rate)
    end, old_end = (len(out) - 1) / new_rate, 100.0 / rate
    assert old_end - 1.0 / new_rate < end <= old_end + 1e-9
    np.testing.assert_allclose(out[:, 0], np.arange(len(out)) * rate / new_rate, atol=1e-9)


def test_one_frame_cannot_be_resampled() -> None:
    """There is no motion in one frame."""
    with pytest.raises(ValueError, match="at least 2"):
        resample_values(np.zeros((1, 3)), 30.0, 60.0)
