"""The stitcher `none`: the new clip at once, seam and all."""

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire_engine.stitchers.stitcher import Motion, Roots, Sample, StitchState


class Cut:
    """Hides nothing; for comparison and for callers that stitch themselves."""

    name = "none"
    settled_s = 0.0
    keeps_root_velocity = False
    plants_feet = False
    looks_ahead: tuple[float, ...] = ()

    def begin(self, state: StitchState, source: Motion, target: Motion, roots: Roots) -> None:
        """Forget what was added."""
        for offset in (
            state.offset_hips,
            state.offset_hips_velocity,
            state.offset_rotations,
            state.offset_angular_velocity,
        ):
            offset[...] = 0.0

    def apply(self, state: StitchState, sample: Sample, dt: Floats) -> tuple[Vectors, Quaternions]:
        """Return the sampled pose."""
        return sample.hips, sample.rotations
