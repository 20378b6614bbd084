"""Re-planting: a standing character puts feet that stand off their place right, one at a time.

While a clip stands its feet never swing, so what they are off by after a transition would stay.
Once both feet have been planted for a while and will be, the foot that is further off takes a step
of its own: for a moment it is not planted, neither now nor as far as one looks ahead.
"""

import numpy as np

from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.stitchers.stitcher import Sample, StitchState

_FARTHEST = 0.08
"""Metres from the clip's toe at which a foot is put right."""
_WAIT_S = 0.25
"""Not so soon after a transition."""
STEP_S = 0.4
STEP_HALFLIFE = 0.06
"""Spring of a foot that steps; it need not wait for the clip's foot to move."""
_AT_REST = 0.02
"""No foot steps before both have stood: share of a swing that is left."""


def lift_feet(state: StitchState, sample: Sample, dt: Floats) -> Sample:
    """Return the sample with feet that take a step of their own not planted.

    Args:
        state: N characters; steps begin and go on.
        sample: What the clips show; looks ahead, else no step is taken.
        dt: `(N,)` seconds.
    """
    if sample.ahead is None:
        return sample
    state.toe_step[...] = np.maximum(state.toe_step - dt[:, None], 0.0)
    gap = np.hypot(state.toe_gap[..., 0], state.toe_gap[..., 2])
    steps = (_may_step(state, sample) & (dt > 0.0))[:, None] & (gap > _FARTHEST)
    steps &= gap >= gap.max(axis=1, keepdims=True)
    # of two feet that are equally far off the left one goes first
    steps[:, 1] &= ~steps[:, 0]
    state.toe_step[steps] = STEP_S
    up = state.toe_step > 0.0
    # a foot on its way may be caught by the clip's next step, which then takes over
    still = state.toe_step[:, None] > sample.ahead.times[:, None]
    ahead = sample.ahead._replace(contacts=sample.ahead.contacts & ~still)
    return sample._replace(contacts=sample.contacts & ~up, ahead=ahead)


def _may_step(state: StitchState, sample: Sample) -> Flags:
    assert sample.ahead is not None
    free = True if sample.guide is None else ~np.asarray(sample.guide.guided)
    stands = free & sample.contacts.all(axis=1) & sample.ahead.contacts.all(axis=(1, 2))
    rests = (state.toe_step <= 0.0).all(axis=1) & (state.toe_swing < _AT_REST).all(axis=1)
    return np.asarray(stands & rests & (state.stitch_time > _WAIT_S))
