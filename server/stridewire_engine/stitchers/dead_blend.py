"""The stitcher `dead-blend`: what was shown goes on by dead reckoning and fades into the new clip.

After Holden's *Dead Blending*: the shown pose is extrapolated with decaying velocity, longer where
it heads for the new clip, and cross-faded. What comes lies between two plausible poses, however far
apart they are and however fast jumps follow each other; motion is damped meanwhile.
"""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire_engine.stitchers import offsets
from stridewire_engine.stitchers.stitcher import Motion, Roots, Sample, StitchState

_SHORTEST_S, _LONGEST_S, _EAGERNESS = 0.1, 1.0, 0.3
_LN2 = float(np.log(2.0))
_HALF_TURN = float(np.pi)


class DeadBlend:
    """Extrapolates and fades."""

    name = "dead-blend"
    keeps_root_velocity = True
    plants_feet = False
    looks_ahead: tuple[float, ...] = ()

    def __init__(self, duration: float = 0.3) -> None:
        """Set the seconds of the fade."""
        self._duration = duration
        self.settled_s = duration

    def begin(self, state: StitchState, source: Motion, target: Motion, roots: Roots) -> None:
        """Remember what is shown, how it moves, and how long to trust that."""
        shown = offsets.hand_over(state, source, target)
        state.dead_hips[...], state.dead_rotations[...] = shown.hips, shown.rotations
        velocity = np.concatenate([shown.hips_velocity[:, None], shown.angular_velocity], axis=1)
        away = -np.concatenate([state.offset_hips[:, None], state.offset_rotations], axis=1)
        safe = np.where(np.abs(velocity) < 1e-4, np.copysign(1e-4, velocity), velocity)
        state.dead_velocity[...] = velocity
        state.dead_halflife[...] = np.clip(_EAGERNESS * away / safe, _SHORTEST_S, _LONGEST_S)

    def apply(self, state: StitchState, sample: Sample, dt: Floats) -> tuple[Vectors, Quaternions]:
        """Extrapolate to now and fade on."""
        time = state.stitch_time[:, None, None]
        rate = _LN2 / np.maximum(state.dead_halflife, _SHORTEST_S)
        way = state.dead_velocity / rate * -np.expm1(-rate * time)
        turned = quaternion.multiply(quaternion.from_scaled_axis(way[:, 1:]), state.dead_rotations)
        missing = quaternion.to_scaled_axis(
            quaternion.multiply(sample.rotations, quaternion.conjugate(turned))
        )
        missing = _same_way(missing, -state.offset_rotations)
        x = np.clip(state.stitch_time / self._duration, 0.0, 1.0)
        left = (1.0 - x * x * (3.0 - 2.0 * x))[:, None]
        self._set(
            state,
            left * (state.dead_hips + way[:, 0] - sample.hips),
            -left[..., None] * missing,
            dt,
        )
        return offsets.add(state, sample)

    def _set(self, state: StitchState, hips: Vectors, rotations: Vectors, dt: Floats) -> None:
        """Write the offsets and, where time passed, how they change."""
        passed = np.maximum(dt, 1e-6)[:, None]
        moved = dt[:, None] > 0.0
        state.offset_hips_velocity[...] = np.where(
            moved, (hips - state.offset_hips) / passed, state.offset_hips_velocity
        )
        state.offset_angular_velocity[...] = np.where(
            moved[..., None],
            (rotations - state.offset_rotations) / passed[..., None],
            state.offset_angular_velocity,
        )
        state.offset_hips[...], state.offset_rotations[...] = hips, rotations


def _same_way(turn: Vectors, before: Vectors) -> Vectors:
    """Return rotation vectors, the long way round where that is the way of the frame before."""
    angle = np.sqrt(np.sum(turn * turn, axis=-1, keepdims=True))
    opposed = np.sum(turn * before, axis=-1, keepdims=True) < 0.0
    around = turn * (1.0 - 2.0 * _HALF_TURN / np.maximum(angle, 1e-6))
    return np.where(opposed & (angle > 0.75 * _HALF_TURN), around.astype(turn.dtype), turn)
