"""The stitcher `none`: the new clip at once, seam and all."""

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire_engine.stitchers.stitcher import Motion, StitchState


class Cut:
    """Hides nothing; for comparison and for callers that stitch themselves."""

    name = "none"
    settled_s = 0.0
    keeps_root_velocity = False

    def begin(self, state: StitchState, source: Motion, target: Motion) -> None:
        """Forget what was added."""
        for offset in (state.hips, state.hips_velocity, state.rotations, state.angular_velocity):
            offset[...] = 0.0

    def apply(
        self, state: StitchState, hips: Vectors, rotations: Quaternions, dt: Floats
    ) -> tuple[Vectors, Quaternions]:
        """Return the sampled pose."""
        return hips, rotations
