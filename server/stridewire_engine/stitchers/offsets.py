"""Offsets: how one motion is handed over to another, in value and in rate."""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.springs import decay_spring_damper_exact
from stridewire_engine.stitchers.stitcher import Motion, Sample, StitchState


class Shown(NamedTuple):
    """The motion that is shown at a jump."""

    hips: Vectors
    """`(N, 3)`."""
    hips_velocity: Vectors
    """`(N, 3)`."""
    rotations: Quaternions
    """`(N, J, 4)`."""
    angular_velocity: Vectors
    """`(N, J, 3)`."""


def hand_over(state: StitchState, source: Motion, target: Motion) -> Shown:
    """Turn the offsets from the source into offsets from the target; return what is shown.

    Value and rate of what is shown do not change by it.
    """
    offset = quaternion.from_scaled_axis(state.offset_rotations)
    angular_velocity = quaternion.scaled_axis_to_velocity(
        state.offset_rotations, state.offset_angular_velocity
    ) + quaternion.rotate(offset, source.angular_velocity)
    shown = Shown(
        source.hips + state.offset_hips,
        source.hips_velocity + state.offset_hips_velocity,
        quaternion.multiply(offset, source.rotations),
        angular_velocity,
    )
    state.offset_hips[...] = shown.hips - target.hips
    state.offset_hips_velocity[...] = shown.hips_velocity - target.hips_velocity
    new_offset = quaternion.absolute(
        quaternion.multiply(shown.rotations, quaternion.conjugate(target.rotations))
    )
    state.offset_rotations[...] = quaternion.to_scaled_axis(new_offset)
    state.offset_angular_velocity[...] = quaternion.scaled_axis_from_velocity(
        state.offset_rotations,
        angular_velocity - quaternion.rotate(new_offset, target.angular_velocity),
    )
    return shown


def decay(state: StitchState, halflife: float, dt: Floats) -> None:
    """Let the offsets decay as critically damped springs."""
    state.offset_hips[...], state.offset_hips_velocity[...] = decay_spring_damper_exact(
        state.offset_hips, state.offset_hips_velocity, halflife, dt[:, None]
    )
    state.offset_rotations[...], state.offset_angular_velocity[...] = decay_spring_damper_exact(
        state.offset_rotations, state.offset_angular_velocity, halflife, dt[:, None, None]
    )


def add(state: StitchState, sample: Sample) -> tuple[Vectors, Quaternions]:
    """Add the offsets to the sampled pose."""
    turn = quaternion.from_scaled_axis(state.offset_rotations)
    return (
        sample.hips + state.offset_hips,
        np.asarray(quaternion.multiply(turn, sample.rotations)),
    )
