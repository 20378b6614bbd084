"""The tick: one step of all characters that are due, in the order of the design.

Intent, search, playback, root, stitch, feet. Arrays in, arrays out; no loop over characters.
"""

from bisect import bisect_left
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stridewire._messages import FallbackReason, FrameFlag, TransitionReason
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.contacts import to_mask
from stridewire.motion.root_frame import turn_to_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine import compiled
from stridewire_engine.compiled.jumping import Leaps
from stridewire_engine.compiled.playback import Played
from stridewire_engine.compiled.showing import Told
from stridewire_engine.matching.search import Matcher
from stridewire_engine.networks.rmr.refiner import refiner_if_shipped
from stridewire_engine.runtime import (
    choice,
    feet,
    ground,
    intent,
    refining,
    root,
    sampling,
    standing,
)
from stridewire_engine.runtime.characters import Characters, contiguous
from stridewire_engine.runtime.choice import Jumps, Sets
from stridewire_engine.runtime.lookahead import LegTracks, legs_ahead
from stridewire_engine.runtime.passes import Passes
from stridewire_engine.runtime.settings import LEVELS, TickSettings
from stridewire_engine.stitchers import (
    AUTO,
    STITCH_COLUMNS,
    STITCHER_NAMES,
    STITCHERS,
    Motion,
    Roots,
    Sample,
    StitchState,
    auto,
    stance,
)
from stridewire_engine.stitchers.legs import Legs

_AUTO_FRAMES = 24
"""So many frames of the new clip tell which stitcher hides a transition best."""
_PLANTS = np.array([*(stitcher.plants_feet for stitcher in STITCHERS), False])
"""By index; what `AUTO` will choose is not known yet."""
_SPRING, _STANCE, _REFINE = (STITCHER_NAMES.index(name) for name in ("spring", "stance", "refine"))


@dataclass(frozen=True)
class Block:
    """What a tick made, for N characters in the order of its rows."""

    root: Floats
    """`(N, 7)` float32."""
    root_delta: Floats
    """`(N, 4)` float32."""
    hips: Vectors
    """`(N, 3)` float32."""
    rotations: Quaternions
    """`(N, J, 4)` float32."""
    contacts: Flags
    """`(N, 4)`."""
    contacts_before: Flags
    """`(N, 4)`."""
    foot_targets: Vectors
    """`(N, 2, 3)` float32, NaN where not locked."""
    simulated_root: Floats
    """`(N, 4)` float32."""
    tags_entered: Indices
    """`(N,)` uint64 bits of the library's tags."""
    jumps: Jumps | None
    """Who jumped; None if nobody searched."""
    searched: Flags
    """`(N,)` who searched."""
    timings_ms: dict[str, float]
    fallback: Indices
    """`(N,)` why who asked for `refine` is stitched by `stance`: a `FallbackReason`, or 0."""
    refined_frames: Indices
    """`(N,)` for how many frames a network guided feet after the transition before the last."""
    level: int = 0
    """By how many levels the runtime gave way to load."""

    @cached_property
    def jumped(self) -> "Happened":
        """Who jumped, in the order of `jumps`."""
        return Happened([] if self.jumps is None else self.jumps.characters.tolist())

    @cached_property
    def contacts_changed(self) -> "Happened":
        """Whose contacts changed, and of which joint."""
        rows, joints = np.nonzero(self.contacts != self.contacts_before)
        return Happened(rows.tolist(), joints.tolist())

    @cached_property
    def tags_begun(self) -> "Happened":
        """Who entered tagged spans."""
        return Happened(np.flatnonzero(self.tags_entered).tolist())

    @cached_property
    def searches(self) -> "Happened":
        """Who searched."""
        return Happened(np.flatnonzero(self.searched).tolist())

    @cached_property
    def contact_mask(self) -> Indices:
        """`(N,)` contacts as bits."""
        return to_mask(self.contacts)

    @cached_property
    def flags(self) -> Indices:
        """`(N,)` flags of those whom a network should guide and does not, and of all under load."""
        fallen = (self.fallback > 0).astype(np.uint32) << np.uint32(FrameFlag.FALLBACK)
        return fallen | np.uint32((self.level > 0) << FrameFlag.DEGRADED)


class Happened(NamedTuple):
    """What happened in a tick; sessions ask for their part of it, which is small."""

    rows: list[int]
    """Of the block, ascending."""
    what: Sequence[int] = ()

    def within(self, rows: slice) -> range:
        """Return the places of what happened to some rows."""
        return range(bisect_left(self.rows, rows.start), bisect_left(self.rows, rows.stop))


class Tick:
    """Steps characters over one library."""

    def __init__(
        self,
        matcher: Matcher,
        settings: TickSettings,
        max_speed: float,
        clock: Callable[[], float],
    ) -> None:
        """Prepare what does not change from tick to tick.

        Args:
            matcher: Of the library.
            settings: Half-lives, biases, intervals.
            max_speed: Limit of velocity components, m/s.
            clock: Seconds; only for the timings that are reported.
        """
        self._matcher = matcher
        self._settings = settings
        self._levels = [settings.giving_way(level) for level in range(LEVELS)]
        self._max_speed = max_speed
        self._clock = clock
        self._legs = Legs.of(matcher.library.skeleton)
        self._tracks = LegTracks.of(matcher.library, self._legs)
        self._spans = standing.Spans.of(matcher.library, settings.clip_end_margin)
        self._times = np.array(matcher.schema.trajectory_times)
        self._passes = Passes(
            matcher.library, self._legs, self._tracks, self._spans, self._times, settings
        )
        self._refining: refining.Refining | None = None
        refiner = refiner_if_shipped()
        self._unrefined = (
            FallbackReason.NO_NETWORK if refiner is None else FallbackReason.OTHER_SKELETON
        )
        if refiner is not None and matcher.library.skeleton == REFERENCE:
            self._refining = refining.Refining(
                matcher.library, self._tracks, self._legs, refiner, settings.root_halflife
            )

    def step(self, state: Characters, dt: Floats, sets: Sets, level: int = 0) -> Block:
        """Advance all rows of `state` in place by `dt` `(N,)` seconds and return what is shown.

        Args:
            state: N rows.
            dt: `(N,)`.
            sets: The candidate sets that rows name in `filter`.
            level: By how many levels to give way to load.
        """
        timings = _Timings(self._clock)
        settings = self._levels[level]
        fast = compiled.ENABLED and not state.has_path.any()
        goal: Floats | None = None
        if fast:
            prediction, reason = self._passes.look(state, dt, settings)
        else:
            goal, prediction, reason = self._look(state, dt, settings)
        timings.note("intent")
        jumps = None
        if reason.any():
            jumps = choice.choose(state, self._matcher, sets, prediction, reason, settings)
            if len(jumps.characters):
                self._jump(state, jumps, settings.most_refined)
        timings.note("search")
        played = self._passes.play(state, dt) if goal is None else self._play(state, goal, dt)
        timings.note("playback")
        sample = Sample(
            played.hips,
            played.rotations,
            played.contacts[:, 1::2],
            Roots(state.root_position, state.root_yaw),
            state.time <= dt,
            self._legs,
            None,
        )
        hips, rotations = self._stitch(state, sample, played.motion, played.delta, dt)
        timings.note("stitch")
        rotations = self._plant(state, hips, rotations, played.contacts, dt)
        if state.has_ground.any():
            self._lay(state, hips, rotations, played.delta, dt)
        timings.note("feet")
        block = self._block(state, played, hips, rotations, jumps, reason > 0, timings)
        return replace(block, level=level) if level else block

    def _look(
        self, state: Characters, dt: Floats, settings: TickSettings
    ) -> tuple[Floats, intent.Prediction, Indices]:
        """Return goals `(N, 2)`, where simulated roots will be, and who searches why."""
        library = self._matcher.library
        state.time += dt
        goal = intent.set_goals(state, self._max_speed)
        prediction = intent.predict(state, goal, self._times, settings)
        stands = standing.stands(state, library, self._spans, settings)
        return goal, prediction, choice.due(state, self._matcher, stands, dt, settings)

    def _play(self, state: Characters, goal: Floats, dt: Floats) -> Played:
        """Advance clips and roots and return what the clips show."""
        settings, library = self._settings, self._matcher.library
        intent.advance(state, goal, dt, settings)
        before = sampling.moments(library, state.clip, state.clip_time)
        state.clip_time += standing.advance(state, library, self._spans, dt, settings)
        state.since_jump += dt
        after = sampling.moments(library, state.clip, state.clip_time)
        state.clip_time[...] = sampling.wrap_times(library, state.clip, state.clip_time)
        hips, rotations = sampling.sample_pose(library, after)
        motion = sampling.root_delta(library, before, after)
        delta = root.advance(state, motion, dt, settings)
        state.root_speed[...] = np.where(
            dt > 0.0, np.hypot(delta[:, 0], delta[:, 2]) / np.maximum(dt, 1e-6), state.root_speed
        )
        contacts = library.contacts[after.nearest]
        return Played(after.rows, after.weight, hips, rotations, contacts, motion, delta)

    def _plant(
        self,
        state: Characters,
        hips: Vectors,
        rotations: Quaternions,
        contacts: Flags,
        dt: Floats,
    ) -> Quaternions:
        """Lock toes, remember what is shown, and return `(N, J, 4)` with the legs bent."""
        if compiled.ENABLED:
            self._passes.plant(state, hips, rotations, contacts, dt)
            return rotations
        contacts &= ~np.repeat(state.toe_step > 0.0, 2, axis=1)
        rotations = feet.plant(
            state,
            self._legs,
            hips,
            rotations,
            contacts,
            _PLANTS[state.stitched_by],
            dt,
            self._settings,
        )
        refining.remember(state, contacts, dt)
        return rotations

    def _lay(
        self,
        state: Characters,
        hips: Vectors,
        rotations: Quaternions,
        delta: Floats,
        dt: Floats,
    ) -> None:
        """Lay those who were told of ground onto it, in place."""
        before = state.terrain[:, 0].copy()
        rows = contiguous(np.flatnonzero(state.has_ground))
        told = state.borrow(rows)
        laid = ground.lay(told, self._legs, hips[rows], rotations[rows], dt[rows])
        hips[rows], rotations[rows] = laid.hips, laid.rotations
        state.put(rows, told)
        delta[:, 1] += state.terrain[:, 0] - before

    def consider(
        self, state: Characters, dt: Floats, sets: Sets
    ) -> tuple[Indices, choice.Considered]:
        """Say what a step would search for and find, for every row, whether it would search or not.

        Args:
            state: N rows, which are used up: give a copy.
            dt: `(N,)` seconds.
            sets: As for `step`.

        Returns:
            `(N,)` the reasons to search, 0 for none, and what all rows would find.
        """
        settings, library = self._settings, self._matcher.library
        state.time += dt
        goal = intent.set_goals(state, self._max_speed)
        prediction = intent.predict(state, goal, self._times, settings)
        stands = standing.stands(state, library, self._spans, settings)
        reason = choice.due(state, self._matcher, stands, dt, settings)
        looked = np.where(reason > 0, reason, TransitionReason.BETTER_MATCH)
        return reason, choice.consider(state, self._matcher, sets, prediction, looked, settings)

    def _jump(self, state: Characters, jumps: Jumps, most_refined: int) -> None:
        """Hand the jumping characters over to their stitchers and set them to their new moments."""
        who = jumps.characters
        by = state.stitcher[who]
        rest = np.arange(len(who))
        if compiled.ENABLED:
            planting = _PLANTS[by]
            taken = [getattr(jumps, name)[planting] for name in Leaps._fields]
            self._passes.hand_over(state, Leaps(*taken))
            rest = np.flatnonzero(~planting)
        if len(rest):
            rows = state.borrow(who[rest])
            by[rest] = self._hand_over(rows, jumps.take(rest))
            state.put(who[rest], rows)
        self._begin(state, jumps, by, most_refined)

    def _hand_over(self, rows: Characters, jumps: Jumps) -> Indices:
        """Take what is shown over into offsets from the new moments; return by which stitchers."""
        library = self._matcher.library
        old = sampling.moments(library, np.maximum(jumps.from_clip, 0), jumps.from_time)
        new = sampling.moments(library, jumps.to_clip, jumps.to_time)
        rows.root_offset += sampling.root_velocity(library, old) * rows.pace[:, None]
        rows.root_offset -= sampling.root_velocity(library, new)
        source = sampling.sample_motion(library, old, rows.pace, self._tracks.toes)
        rows.pace[...], rows.goes_back[...] = 1.0, False
        target = sampling.sample_motion(library, new, rows.pace, self._tracks.toes)
        offsets, roots = _stitch_state(rows), Roots(rows.root_position, rows.root_yaw)
        by = self._stitchers(rows, new, source, target)
        leaves = _PLANTS[rows.stitched_by] & ~_PLANTS[by]
        if leaves.any():
            stance.leave(offsets, source, self._legs, leaves)
        for index, stitcher in enumerate(STITCHERS):
            mine = np.flatnonzero(by == index)
            if len(mine):
                part = offsets.borrow(mine)
                stitcher.begin(part, source.take(mine), target.take(mine), roots.take(mine))
                offsets.put(mine, part)
            if not stitcher.keeps_root_velocity:
                rows.root_offset[mine] = 0.0
        rows.clip[...], rows.clip_time[...] = jumps.to_clip, jumps.to_time
        rows.since_jump[...] = 0.0
        rows.recent[:, 1:], rows.recent[:, 0] = rows.recent[:, :-1].copy(), jumps.to_row
        rows.recent_time[:, 1:] = rows.recent_time[:, :-1].copy()
        rows.recent_time[:, 0] = rows.time
        return by

    def _begin(self, state: Characters, jumps: Jumps, by: Indices, most_refined: int) -> None:
        """Begin to hide the transitions by stitchers `(M,)`; the network is asked where wanted."""
        who, begins = jumps.characters, jumps.reason == TransitionReason.START
        if begins.any():
            for name in (*STITCH_COLUMNS, "root_offset"):
                getattr(state, name)[who[begins]] = 0.0
        state.refined_frames[who] = refining.refined_frames(state.borrow(who))
        # there is nothing to hide where a character begins
        state.stitch_time[who] = np.where(begins, np.inf, 0.0)
        state.stitched_by[who] = by
        refines = ~begins & (by == _REFINE)
        state.guide_frames[who] = 0
        state.fallback[who] = np.where(refines, self._unrefined, 0)
        if refines.any() and self._refining is not None:
            self._refining.plan(state, who[refines], most_refined)

    def _stitchers(
        self, rows: Characters, new: sampling.Moments, source: Motion, target: Motion
    ) -> Indices:
        """Return which stitcher `(M,)` hides the transition of each jumping character."""
        chosen = rows.stitcher == AUTO
        if not chosen.any():
            return rows.stitcher
        library, roots = self._matcher.library, Roots(rows.root_position, rows.root_yaw)
        ahead = np.arange(_AUTO_FRAMES)
        clip = library.clip_of[new.rows]
        last = library.clip_starts[clip] + library.clip_frames[clip] - 1
        at = np.minimum(new.nearest[:, None] + ahead, last[:, None])
        gap = rows.toe_shown - roots.to_world(target.toes)
        speed = rows.toe_gap_speed + turn_to_world(
            source.toes_velocity - target.toes_velocity, rows.root_yaw
        )
        spring = auto.spring_will_do(
            gap, speed, library.contacts[at][..., 1::2], ahead / library.frame_rate
        )
        planting = _STANCE if self._refining is None else _REFINE
        return np.where(chosen, np.where(spring, _SPRING, planting), rows.stitcher)

    def _stitch(
        self, state: Characters, sample: Sample, motion: Floats, delta: Floats, dt: Floats
    ) -> tuple[Vectors, Quaternions]:
        """Let each stitcher turn its characters' sampled poses into the shown ones."""
        state.stitch_time += dt.astype(np.float32)
        hips, rotations = sample.hips, sample.rotations
        passed = np.maximum(dt, 1e-6)[:, None]
        pull = (delta[:, [0, 2, 3]] - motion) / passed - state.root_offset
        done = np.zeros(len(state), np.bool_)
        if compiled.ENABLED:
            done = self._passes.stitch(state, sample, pull, dt)
            if done.all():
                return hips, rotations
        small_dt, offsets = dt.astype(np.float32), _stitch_state(state)
        for index, stitcher in enumerate(STITCHERS):
            mine = contiguous(np.flatnonzero((state.stitched_by == index) & ~done))
            if not isinstance(mine, slice) and not len(mine):
                continue
            part, seen = offsets.borrow(mine), sample.take(mine)
            if stitcher.looks_ahead:
                times = np.array(stitcher.looks_ahead)
                rows = state.borrow(mine)
                halflife = self._settings.root_halflife
                seen = seen._replace(
                    ahead=legs_ahead(
                        rows, self._matcher.library, self._tracks, times, pull[mine], halflife
                    )
                )
                if index == _REFINE and refining.guided(rows).any():
                    seen = refining.guide(rows, seen)
            hips[mine], rotations[mine] = stitcher.apply(part, seen, small_dt[mine])
            offsets.put(mine, part)
        return hips, rotations

    def _block(
        self,
        state: Characters,
        played: Played,
        hips: Vectors,
        rotations: Quaternions,
        jumps: Jumps | None,
        searched: Flags,
        timings: "_Timings",
    ) -> Block:
        seen = self._passes.tell if compiled.ENABLED else self._tell
        told = seen(state, played)
        return Block(
            told.root,
            told.root_delta,
            hips,
            rotations,
            played.contacts,
            told.contacts_before,
            told.foot_targets,
            told.simulated_root,
            told.tags_entered,
            jumps,
            searched,
            timings.elapsed_ms,
            np.where(state.stitched_by == _REFINE, state.fallback, 0),
            state.refined_frames.copy(),
        )

    def _tell(self, state: Characters, played: Played) -> Told:
        """Return what a block tells of the state; contacts and tags are noted for the next one."""
        after = sampling.Moments(played.rows, played.weight)
        bits = self._matcher.library.tag_bits[after.nearest]
        entered = bits & ~state.tag_bits
        before = state.contacts.copy()
        state.tag_bits[...] = bits
        state.contacts[...] = played.contacts
        targets = np.where(state.locked[..., None], state.lock_point, np.nan)
        targets[..., 1] += state.terrain[:, 1:3]
        position = state.root_position.copy()
        position[:, 1] += state.terrain[:, 0]
        x, z = state.sim_position.T
        simulated = np.stack([x, position[:, 1], z, state.sim_yaw], axis=1)
        turn = quaternion.from_yaw(state.root_yaw)
        return Told(
            np.concatenate([position, turn], axis=1).astype(np.float32),
            played.delta.astype(np.float32),
            targets.astype(np.float32),
            simulated.astype(np.float32),
            entered,
            before,
        )


def _stitch_state(state: Characters) -> StitchState:
    return StitchState(**{name: getattr(state, name) for name in STITCH_COLUMNS})


class _Timings:
    """Notes how long each stage took."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._last = clock()
        self.elapsed_ms: dict[str, float] = {}

    def note(self, stage: str) -> None:
        now = self._clock()
        self.elapsed_ms[stage] = 1e3 * (now - self._last)
        self._last = now
