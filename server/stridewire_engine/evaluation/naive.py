"""The naive baseline: what the first afternoon of motion matching gives.

An exact search every frame, a cross-fade of 0.2 s from the old clip, which plays on, to the new
one, and the clip's own root motion: no bias, no adjustment of the root, nothing for the feet.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from stridewire._messages import TransitionReason
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.evaluation.streaming import RATE, Stream, Wanted, begin_all, record
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import TickSettings, choice, intent, sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.tick import Block

_FADE_S = 0.2
_SETTINGS = TickSettings(
    search_interval=0.0, continuing_bias=0.0, least_improvement=0.0, reselect_history=0.0
)


def naive_streams(
    library: Library, matcher: Matcher, cells: Sequence[Cell], wanted: Sequence[Wanted]
) -> Iterator[Stream]:
    """Drive the characters of several cells without any of the tick's care."""
    state = begin_all(matcher, cells, wanted, _SETTINGS)
    tick = _NaiveTick(matcher, state)
    yield from record(library, state, wanted, tick.step)


class _NaiveTick:
    def __init__(self, matcher: Matcher, state: Characters) -> None:
        self._matcher = matcher
        self._state = state
        self._times = np.array(matcher.schema.trajectory_times)
        self._sets = {0: matcher.candidates.everything}
        self._old_clip = np.zeros(len(state), np.int32)
        self._old_time = np.zeros(len(state))
        self._fade = np.full(len(state), 1.0)
        # its queries are always the features of the clip, never of what is shown
        state.since_jump[:] = np.inf

    def step(self) -> Block:
        state, library = self._state, self._matcher.library
        dt = np.full(len(state), 1.0 / RATE)
        state.time += dt
        goal = intent.set_goals(state, 20.0)
        prediction = intent.predict(state, goal, self._times, _SETTINGS)
        nobody = np.zeros(len(state), np.bool_)
        reason = choice.due(state, self._matcher, nobody, dt, _SETTINGS)
        reason = np.where(reason, reason, TransitionReason.BETTER_MATCH)
        jumps = choice.choose(state, self._matcher, self._sets, prediction, reason, _SETTINGS)
        intent.advance(state, goal, dt, _SETTINGS)
        self._jump(jumps)
        hips, rotations, motion = self._play(dt)
        self._move(motion)
        # the simulated root starts from where the character is: no leash, no pull
        state.sim_position[...] = state.root_position[:, ::2]
        contacts = library.contacts[sampling.moments(library, state.clip, state.clip_time).nearest]
        root = np.concatenate([state.root_position, quaternion.from_yaw(state.root_yaw)], axis=1)
        nothing = np.full((len(state), 2, 3), np.nan)
        return Block(
            root, motion, hips, rotations, contacts, contacts, nothing,
            np.zeros((len(state), 4)), np.zeros(len(state), np.uint64), jumps,
            np.ones(len(state), np.bool_), {},
            np.zeros(len(state), np.int8), np.zeros(len(state), np.int8),
        )  # fmt: skip

    def _jump(self, jumps: choice.Jumps) -> None:
        who = jumps.characters
        begins = jumps.from_clip < 0
        self._old_clip[who] = np.where(begins, jumps.to_clip, jumps.from_clip)
        self._old_time[who] = np.where(begins, jumps.to_time, jumps.from_time)
        self._fade[who] = np.where(begins, 1.0, 0.0)
        self._state.clip[who], self._state.clip_time[who] = jumps.to_clip, jumps.to_time

    def _play(self, dt: Floats) -> tuple[Floats, Floats, Floats]:
        """Advance both clips and mix them."""
        state, library = self._state, self._matcher.library
        parts = []
        for clip, time in ((self._old_clip, self._old_time), (state.clip, state.clip_time)):
            before = sampling.moments(library, clip, time)
            time += dt
            after = sampling.moments(library, clip, time)
            parts.append(
                (*sampling.sample_pose(library, after), sampling.root_delta(library, before, after))
            )
        state.clip_time[...] = sampling.wrap_times(library, state.clip, state.clip_time)
        self._fade = np.minimum(self._fade + dt / _FADE_S, 1.0)
        weight = self._fade[:, None].astype(np.float32)
        (hips_a, rotations_a, motion_a), (hips_b, rotations_b, motion_b) = parts
        return (
            hips_a + weight * (hips_b - hips_a),
            quaternion.nlerp(rotations_a, rotations_b, weight),
            motion_a + self._fade[:, None] * (motion_b - motion_a),
        )

    def _move(self, motion: Floats) -> None:
        state = self._state
        sine, cosine = np.sin(state.root_yaw), np.cos(state.root_yaw)
        state.root_position[:, 0] += motion[:, 0] * cosine + motion[:, 1] * sine
        state.root_position[:, 2] += motion[:, 1] * cosine - motion[:, 0] * sine
        state.root_yaw += motion[:, 2]
