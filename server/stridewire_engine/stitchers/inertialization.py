"""The stitcher `spring`: inertialization by decaying springs.

At a jump the difference between what was shown and the new clip, in value and in rate, becomes an
offset that decays critically damped (Bollo, GDC 2018; Holden, *Spring-It-On*, "Inertialization").
Value and rate of what is shown go on without a step, whenever the jump comes.
"""

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.springs import decay_spring_damper_exact
from stridewire_engine.stitchers.stitcher import Motion, StitchState


class SpringInertialization:
    """Offsets of the hips and of each joint's rotation, decaying with one half-life."""

    name = "spring"
    keeps_root_velocity = True

    def __init__(self, halflife: float = 0.1) -> None:
        """Set the springs' halflife in seconds: 59.7 % of an offset at rest is left after it."""
        self._halflife = halflife
        # a critically damped spring has 10 % left after 2.81 halflives
        self.settled_s = 2.81 * halflife

    def begin(self, state: StitchState, source: Motion, target: Motion) -> None:
        """Turn the difference between the shown and the new motion into offsets."""
        state.hips += source.hips - target.hips
        state.hips_velocity += source.hips_velocity - target.hips_velocity
        offset = quaternion.from_scaled_axis(state.rotations)
        shown_velocity = quaternion.scaled_axis_to_velocity(
            state.rotations, state.angular_velocity
        ) + quaternion.rotate(offset, source.angular_velocity)
        shown = quaternion.multiply(offset, source.rotations)
        new_offset = quaternion.absolute(
            quaternion.multiply(shown, quaternion.conjugate(target.rotations))
        )
        state.rotations[...] = quaternion.to_scaled_axis(new_offset)
        state.angular_velocity[...] = quaternion.scaled_axis_from_velocity(
            state.rotations,
            shown_velocity - quaternion.rotate(new_offset, target.angular_velocity),
        )

    def apply(
        self, state: StitchState, hips: Vectors, rotations: Quaternions, dt: Floats
    ) -> tuple[Vectors, Quaternions]:
        """Let the offsets decay by `dt` and add them."""
        state.hips[...], state.hips_velocity[...] = decay_spring_damper_exact(
            state.hips, state.hips_velocity, self._halflife, dt[:, None]
        )
        state.rotations[...], state.angular_velocity[...] = decay_spring_damper_exact(
            state.rotations, state.angular_velocity, self._halflife, dt[:, None, None]
        )
        turned = quaternion.multiply(quaternion.from_scaled_axis(state.rotations), rotations)
        return hips + state.hips, turned
