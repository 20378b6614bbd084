"""Passes: the stages of a tick in four compiled calls, each over all characters.

They do what `intent`, `standing`, `choice.due`, `sampling`, `root`, `lookahead`, `refining.guide`,
`Stance.apply` and `feet` do, without the arrays in between.
"""

from typing import NamedTuple, TypeVar

import numpy as np

from stridewire._messages import TransitionReason
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire_engine.compiled import feet, footing, intent, lookahead, playback, showing
from stridewire_engine.compiled.feet import Locks, Shown
from stridewire_engine.compiled.footing import Toes
from stridewire_engine.compiled.intent import Halflives, Reasons, Turns, Wants
from stridewire_engine.compiled.jumping import Handed, Leaps, hand_over
from stridewire_engine.compiled.lookahead import Plays
from stridewire_engine.compiled.moments import Clips
from stridewire_engine.compiled.playback import Moves, Played, Pull
from stridewire_engine.compiled.showing import Seen, Told
from stridewire_engine.compiled.stance import BODY_HALFLIFE, Body, LegJoints, Scene, stance
from stridewire_engine.compiled.turns import rate
from stridewire_engine.library import Library
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.intent import Prediction
from stridewire_engine.runtime.lookahead import LegTracks, fading
from stridewire_engine.runtime.response import QUALITY, RESPONSE, Multiples
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.runtime.standing import Spans
from stridewire_engine.stitchers import STITCHER_NAMES, STITCHERS, Sample
from stridewire_engine.stitchers.legs import Legs

_REFINE = STITCHER_NAMES.index("refine")
_MINE = np.array([stitcher.plants_feet for stitcher in STITCHERS])
_REASONS = Reasons(*(int(TransitionReason[name.upper()]) for name in Reasons._fields))
ColumnsT = TypeVar("ColumnsT", bound=NamedTuple)


class Passes:
    """The compiled passes over one library."""

    def __init__(
        self,
        library: Library,
        legs: Legs,
        tracks: LegTracks,
        spans: Spans,
        times: Floats,
        settings: TickSettings,
    ) -> None:
        """Take what does not change.

        Args:
            library: That is played.
            legs: Of its skeleton.
            tracks: Of its legs.
            spans: Where it stands.
            times: `(K,)` seconds ahead that searches look.
            settings: Of the tick.
        """
        self._library, self._times, self._settings = library, times, settings
        self._clips = clips_of(library, tracks)
        self._spans = playback.Spans(*spans)
        self._legs = joints_of(legs, len(library.skeleton))
        ahead = np.array(STITCHERS[_REFINE].looks_ahead)
        self._scene = Scene(
            self._clips,
            self._legs,
            ahead,
            fading(ahead, settings.root_halflife),
            np.array([rate(BODY_HALFLIFE, float(time)) for time in ahead]),
            FRAME_RATE,
            lookahead.scratch(len(ahead)),
            footing.scratch(),
        )
        self._halflives = Halflives(
            settings.velocity_halflife, settings.facing_halflife, _ends(QUALITY), _ends(RESPONSE)
        )
        self._turns = _numbers(Turns, settings)
        self._pull = _numbers(Pull, settings)

    def look(
        self, state: Characters, dt: Floats, settings: TickSettings
    ) -> tuple[Prediction, Indices]:
        """Set goals and return where simulated roots will be and who searches why."""
        count, ahead = len(state), len(self._times)
        future = Prediction(np.empty((count, ahead, 2)), np.empty((count, ahead)))
        reason = np.empty(count, np.int8)
        intent.look(
            columns(Wants, state), self._clips, self._spans.first, self._times, self._halflives,
            _numbers(Turns, settings), _REASONS, dt, *future, reason,
        )  # fmt: skip
        return future, reason

    def hand_over(self, state: Characters, leaps: Leaps) -> None:
        """Hand over characters that jump and whose stitchers plant feet."""
        hand_over(columns(Handed, state), self._clips, leaps)

    def play(self, state: Characters, dt: Floats) -> Played:
        """Advance clips and roots and return what the clips show."""
        count, joints = len(state), self._clips.rotations.shape[1]
        played = Played(
            np.empty(count, np.int64),
            np.empty(count, np.float32),
            np.empty((count, 3), np.float32),
            np.empty((count, joints, 4), np.float32),
            np.empty((count, 4), np.bool_),
            np.empty((count, 3)),
            np.empty((count, 4)),
        )
        playback.play(
            columns(Wants, state), columns(Moves, state), self._clips, self._spans,
            self._halflives, self._turns, self._pull, dt, played,
        )  # fmt: skip
        return played

    def stitch(self, state: Characters, sample: Sample, pull: Floats, dt: Floats) -> Flags:
        """Turn sampled poses into shown ones, in place, and tell whose `(N,)` they were.

        Args:
            state: N rows, clip times and roots already moved.
            sample: What their clips show; hips and rotations are overwritten.
            pull: `(N, 3)` x, z, yaw a second that roots go beyond their clips.
            dt: `(N,)` seconds.
        """
        mine = _MINE[state.stitched_by]
        stance(
            self._scene, columns(Body, state), columns(Toes, state), columns(Plays, state),
            np.flatnonzero(mine), state.stitched_by == _REFINE, state.root_position,
            state.root_yaw, sample.begins, pull, sample.contacts, dt, sample.hips,
            sample.rotations,
        )  # fmt: skip
        return mine

    def plant(
        self, state: Characters, hips: Vectors, rotations: Floats, contacts: Flags, dt: Floats
    ) -> None:
        """Lock toes and remember what is shown; rotations and contacts are changed in place."""
        feet.plant(
            columns(Locks, state), columns(Shown, state), self._legs,
            _MINE[state.stitched_by], self._settings.foot_halflife,
            self._settings.unlock_distance, dt, hips, rotations, contacts,
        )  # fmt: skip

    def tell(self, state: Characters, played: Played) -> Told:
        """Return what a block tells of the state; contacts and tags are noted for the next one."""
        count = len(state)
        told = Told(
            np.empty((count, 7), np.float32),
            np.empty((count, 4), np.float32),
            np.empty((count, 2, 3), np.float32),
            np.empty((count, 4), np.float32),
            np.empty(count, np.uint64),
            np.empty((count, 4), np.bool_),
        )
        showing.tell(
            columns(Seen, state), self._library.tag_bits, played.rows, played.weight,
            played.delta, played.contacts, told,
        )  # fmt: skip
        return told


def joints_of(legs: Legs, count: int) -> LegJoints:
    """Return what kernels read of the legs of a skeleton of so many joints."""
    own_pace = np.zeros(count, np.bool_)
    own_pace[np.append(legs.joints, legs.toe)] = True
    return LegJoints(*legs, own_pace=own_pace)


def clips_of(library: Library, tracks: LegTracks | None = None) -> Clips:
    """Return what kernels read of a library; those that read no legs need no tracks."""
    none = np.empty((0, 2, 3), np.float32)
    hips, ankles, toes = tracks or (none, none, none)
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
        hips,
        ankles,
        toes,
        float(library.frame_rate),
    )


def _ends(multiples: Multiples) -> tuple[float, float]:
    return float(multiples.velocity_halflife), float(multiples.facing_halflife)


def columns(kind: type[ColumnsT], state: Characters) -> ColumnsT:
    """Return the columns that a kernel asks for."""
    return kind(*[getattr(state, name) for name in kind._fields])


def _numbers(kind: type[ColumnsT], settings: TickSettings) -> ColumnsT:
    """Return the settings that a kernel asks for."""
    return kind(*[getattr(settings, name) for name in kind._fields])
