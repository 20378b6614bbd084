"""The stitcher `spring`: inertialization by decaying springs.

At a jump the difference between what was shown and the new clip, in value and in rate, becomes an
offset that decays critically damped (Bollo, GDC 2018; Holden, *Spring-It-On*, "Inertialization").
Value and rate of what is shown go on without a step, whenever the jump comes.
"""

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire_engine.stitchers import offsets
from stridewire_engine.stitchers.stitcher import Motion, Roots, Sample, StitchState


class SpringInertialization:
    """Offsets of the hips and of each joint's rotation, decaying with one half-life."""

    name = "spring"
    keeps_root_velocity = True
    plants_feet = False
    looks_ahead: tuple[float, ...] = ()

    def __init__(self, halflife: float = 0.1) -> None:
        """Set the springs' halflife in seconds: 59.7 % of an offset at rest is left after it."""
        self._halflife = halflife
        # a critically damped spring has 10 % left after 2.81 halflives
        self.settled_s = 2.81 * halflife

    def begin(self, state: StitchState, source: Motion, target: Motion, roots: Roots) -> None:
        """Turn the difference between the shown and the new motion into offsets."""
        offsets.hand_over(state, source, target)

    def apply(self, state: StitchState, sample: Sample, dt: Floats) -> tuple[Vectors, Quaternions]:
        """Let the offsets decay by `dt` and add them."""
        offsets.decay(state, self._halflife, dt)
        return offsets.add(state, sample)
