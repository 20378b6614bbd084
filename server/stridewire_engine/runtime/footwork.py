"""Footwork: the stitchers `stance` and `refine` of a whole tick in one compiled pass.

It does what `legs_ahead`, `refining.guide` and `Stance.apply` do together, without the arrays in
between.
"""

import numpy as np

from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.compiled import footing, lookahead
from stridewire_engine.compiled.footing import Toes
from stridewire_engine.compiled.lookahead import Plays
from stridewire_engine.compiled.moments import Clips
from stridewire_engine.compiled.stance import Body, LegJoints, Scene, stance
from stridewire_engine.library import Library
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.lookahead import LegTracks, fading
from stridewire_engine.stitchers import STITCHER_NAMES, STITCHERS, Sample
from stridewire_engine.stitchers.legs import Legs

_REFINE = STITCHER_NAMES.index("refine")
_MINE = np.array([stitcher.plants_feet for stitcher in STITCHERS])


def clips_of(library: Library, tracks: LegTracks) -> Clips:
    """Return what kernels read of a library."""
    return Clips(
        library.clip_starts,
        library.clip_frames,
        library.loops,
        library.laps,
        library.root_position,
        library.root_yaw,
        library.hips,
        library.rotations,
        library.contacts,
        *tracks,
        frame_rate=float(library.frame_rate),
    )


class Footwork:
    """What one library's characters need for it."""

    def __init__(
        self, library: Library, legs: Legs, tracks: LegTracks, root_halflife: float
    ) -> None:
        """Take what does not change.

        Args:
            library: That they play.
            legs: Of its skeleton.
            tracks: Of the library.
            root_halflife: Of the damper of the root's velocity difference.
        """
        times = np.array(STITCHERS[_REFINE].looks_ahead)
        own_pace = np.zeros(len(library.skeleton), np.bool_)
        own_pace[np.append(legs.joints, legs.toe)] = True
        joints = LegJoints(*legs, own_pace=own_pace)
        self._scene = Scene(
            clips_of(library, tracks),
            joints,
            times,
            fading(times, root_halflife),
            FRAME_RATE,
            lookahead.scratch(len(times)),
            footing.scratch(),
        )

    def apply(self, state: Characters, sample: Sample, pull: Floats, dt: Floats) -> Flags:
        """Turn sampled poses into shown ones, in place, and tell whose `(N,)` they were.

        Args:
            state: N rows, clip times and roots already moved.
            sample: What their clips show; hips and rotations are overwritten.
            pull: `(N, 3)` x, z, yaw a second that roots go beyond their clips.
            dt: `(N,)` seconds.
        """
        mine = _MINE[state.stitched_by]
        stance(
            self._scene,
            Body(*(getattr(state, name) for name in Body._fields)),
            Toes(*(getattr(state, name) for name in Toes._fields)),
            Plays(*(getattr(state, name) for name in Plays._fields)),
            np.flatnonzero(mine),
            state.stitched_by == _REFINE,
            state.root_position,
            state.root_yaw,
            sample.begins,
            pull,
            sample.contacts,
            dt,
            sample.hips,
            sample.rotations,
        )
        return mine
