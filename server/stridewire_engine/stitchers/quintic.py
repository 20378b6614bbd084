"""The stitcher `quintic`: inertialization along polynomials that end in time.

Each offset goes along its own fixed axis by the quintic of Bollo (*Inertialization*, GDC 2018):
value, slope and curvature end at zero, the start has the least jerk. The slope at the start is not
let grow, so the velocity does not continue where an offset would get larger. As in Unreal, time
lost to interruptions shortens what follows, or rapid jumps would melt the pose.
"""

import numpy as np

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire_engine.stitchers import offsets
from stridewire_engine.stitchers.stitcher import Motion, Roots, Sample, StitchState

_SHORTEST_S = 0.1
_TINY = 1e-6


class QuinticInertialization:
    """Offsets of the hips and of each joint's rotation on quintics."""

    name = "quintic"
    keeps_root_velocity = True
    plants_feet = False
    looks_ahead: tuple[float, ...] = ()

    def __init__(self, duration: float = 0.4) -> None:
        """Set in how many seconds an offset is gone at the latest."""
        self._duration = duration
        self.settled_s = duration

    def begin(self, state: StitchState, source: Motion, target: Motion, roots: Roots) -> None:
        """Lay a curve from what is shown to the new motion."""
        offsets.hand_over(state, source, target)
        lost = state.curve_end.max(axis=1) - state.stitch_time
        state.stitch_deficit[...] += np.maximum(lost, 0.0)
        end = np.maximum(self._duration - state.stitch_deficit, _SHORTEST_S)[:, None]
        value, rate = _channels(state)
        length = np.sqrt(np.sum(value * value, axis=-1))
        axis = value / np.maximum(length, _TINY)[..., None]
        speed = np.minimum(np.sum(axis * rate, axis=-1), 0.0)
        state.curve_value[...], state.curve_speed[...] = length, speed
        state.curve_axis[...] = axis
        falling = speed < -_TINY
        soonest = -5.0 * length / np.where(falling, speed, -1.0)
        state.curve_end[...] = np.where(falling, np.minimum(end, soonest), end)

    def apply(self, state: StitchState, sample: Sample, dt: Floats) -> tuple[Vectors, Quaternions]:
        """Move along the curves by `dt` and add them."""
        state.stitch_deficit[...] = np.maximum(state.stitch_deficit - dt, 0.0)
        value, slope = quintic(
            state.curve_value, state.curve_speed, state.curve_end, state.stitch_time[:, None]
        )
        offset, rate = state.curve_axis * value[..., None], state.curve_axis * slope[..., None]
        state.offset_hips[...], state.offset_rotations[...] = offset[:, 0], offset[:, 1:]
        state.offset_hips_velocity[...] = rate[:, 0]
        state.offset_angular_velocity[...] = rate[:, 1:]
        return offsets.add(state, sample)


def quintic(x0: Floats, v0: Floats, end: Floats, time: Floats) -> tuple[Floats, Floats]:
    """Return value and slope at `time` of the quintics from `x0` >= 0, `v0` <= 0 to rest at `end`.

    `a0 = max(0, (-8 v0 T - 20 x0) / T^2)` is the start's curvature of least jerk.
    """
    t1 = np.maximum(end, _TINY)
    a0 = np.maximum(0.0, (-8.0 * v0 * t1 - 20.0 * x0) / t1**2)
    a = -(a0 * t1**2 + 6.0 * v0 * t1 + 12.0 * x0) / (2.0 * t1**5)
    b = (3.0 * a0 * t1**2 + 16.0 * v0 * t1 + 30.0 * x0) / (2.0 * t1**4)
    c = -(3.0 * a0 * t1**2 + 12.0 * v0 * t1 + 20.0 * x0) / (2.0 * t1**3)
    t = np.minimum(time, t1)
    value = ((((a * t + b) * t + c) * t + 0.5 * a0) * t + v0) * t + x0
    slope = (((5.0 * a * t + 4.0 * b) * t + 3.0 * c) * t + a0) * t + v0
    over = time >= t1
    return np.where(over, 0.0, value), np.where(over, 0.0, slope)


def _channels(state: StitchState) -> tuple[Vectors, Vectors]:
    """Return offsets `(N, 1 + J, 3)` of hips and joints and their rates."""
    return (
        np.concatenate([state.offset_hips[:, None], state.offset_rotations], axis=1),
        np.concatenate([state.offset_hips_velocity[:, None], state.offset_angular_velocity], 1),
    )
