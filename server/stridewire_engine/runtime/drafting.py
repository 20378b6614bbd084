"""Drafting: plans of transitions for the refiner, made and answered in compiled passes.

They do what `Refining._plans`, the network's `features` and `guidance` do, without the arrays in
between.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Indices, Vectors
from stridewire_engine.compiled.plans import Draft, Past, features, follow
from stridewire_engine.library import Library
from stridewire_engine.networks.rmr import Refiner
from stridewire_engine.networks.rmr.features import INPUTS
from stridewire_engine.networks.rmr.guidance import basis
from stridewire_engine.networks.rmr.plans import FRAME_RATE, WINDOW
from stridewire_engine.runtime.characters import GUIDED_FRAMES, PAST_FRAMES, Characters
from stridewire_engine.runtime.lookahead import LegTracks, fading
from stridewire_engine.runtime.passes import clips_of, columns, joints_of
from stridewire_engine.stitchers.legs import Legs

LED = 0.5
"""Share of the offsets that swings are led by; all of them jerk knees."""
LOWER = 9
"""The reference's first joints: hips and legs."""


class Answer(NamedTuple):
    """What the network said of the coming frames of M transitions."""

    planted: Floats
    """`(M, GUIDED_FRAMES, 2)`."""
    toe_offset: Vectors
    """`(M, GUIDED_FRAMES, 2, 3)` in the world."""
    distance: Floats
    """`(M,)` from the training data."""


class Drafts:
    """Plans over one library."""

    def __init__(
        self, library: Library, tracks: LegTracks, legs: Legs, refiner: Refiner, halflife: float
    ) -> None:
        """Take what does not change; the arguments are those of `Refining`."""
        self._clips = clips_of(library, tracks)
        self._legs = joints_of(legs, len(library.skeleton))
        self._refiner = refiner
        self._fading = fading((np.arange(GUIDED_FRAMES) + 1) / FRAME_RATE, halflife)
        self._draft = Draft(
            np.empty((WINDOW, 8, 3)),
            np.empty(WINDOW),
            np.empty((LOWER, 3)),
            np.empty((1, LOWER, 4)),
        )

    def ask(self, state: Characters, which: Indices) -> Answer:
        """Ask the network about characters `(M,)` whose past is known."""
        count = len(which)
        contacts = np.empty((count, WINDOW, 2), np.bool_)
        told = np.empty((count, WINDOW, INPUTS), np.float32)
        past = columns(Past, state)
        features(self._clips, self._legs, past, which, self._fading, self._draft, contacts, told)
        curves, logits, distance = self._refiner.model.run(told)
        planted = np.empty((count, GUIDED_FRAMES, 2), np.float32)
        offset = np.empty((count, GUIDED_FRAMES, 2, 3), np.float32)
        yaw = state.past_root[which, -1, 3]
        follow(basis(WINDOW), curves, logits, contacts, yaw, PAST_FRAMES, LED, planted, offset)
        return Answer(planted, offset, distance)
