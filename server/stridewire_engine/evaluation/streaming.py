"""Streaming for evaluation: the very tick that serves, driven by a script, everything noted.

Characters of all seeds share the ticks. What a transition is forced on, a match of low rank, a root
that is driven faster than the clip, and late labels are made here, around the tick, not in it.
"""

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import reduce
from typing import NamedTuple

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.clip import Clip, Pose
from stridewire.scripts import script
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.library import Library
from stridewire_engine.matching.candidates import CandidateSet
from stridewire_engine.matching.search import Found, Matcher
from stridewire_engine.runtime import TickSettings, refining, sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.tick import Block, Tick
from stridewire_engine.stitchers import DEFAULT_STITCHER, STITCHER_NAMES

RATE = 60.0
PER_SEED = 2
_MAX_SPEED = 20.0
_SPACING = 3.0


class Wanted(NamedTuple):
    """What is asked of S characters in T frames."""

    velocity: Floats
    """`(T, S, 2)` m/s."""
    facing: Floats
    """`(T, S)` radians, NaN for along the velocity."""


class Seams(NamedTuple):
    """Transitions, K of them; beginnings are not among them."""

    frame: Indices
    """`(K,)` first frame that shows the new moment."""
    character: Indices
    from_row: Indices
    """`(K,)` row of the library that was showing, in the frame before."""


@dataclass(frozen=True)
class Stream:
    """What S characters showed in T frames."""

    pose: Pose
    """`(T, S, …)`."""
    positions: Vectors
    """`(T, S, J, 3)` joints in the world, float64."""
    rows: Indices
    """`(T, S)` row of the library that was nearest."""
    moments: sampling.Moments
    """`(T, S)`."""
    since: Indices
    """`(T, S)` frames since the last transition; those since the beginning count from 1000."""
    foot_targets: Vectors
    """`(T, S, 2, 3)`, NaN where not locked."""
    simulated: Floats
    """`(T, S, 4)`."""
    refined: Flags
    """`(T, S)` where a network guided the feet."""
    wanted: Wanted
    seams: Seams

    def clip(self, library: Library, character: int, name: str) -> Clip:
        """Return what one character did, for drawing."""
        return Clip(
            name,
            library.skeleton,
            RATE,
            self.pose[:, character],
            library.contacts[self.rows[:, character]],
        )


def wanted_of(cell: Cell) -> Wanted:
    """Return what the cell's script asks for."""
    asked = script(cell.script)
    frames = round(cell.seconds * RATE)
    velocity = np.empty((frames, len(cell.seeds) * PER_SEED, 2))
    facing = np.empty(velocity.shape[:2])
    times = np.arange(frames)[:, None] / RATE
    for i, seed in enumerate(cell.seeds):
        mine = slice(i * PER_SEED, (i + 1) * PER_SEED)
        velocity[:, mine], facing[:, mine] = asked.controls(times, PER_SEED, seed)
    return Wanted(velocity, facing)


def streams(
    library: Library, matcher: Matcher, cells: Sequence[Cell], wanted: Sequence[Wanted]
) -> Iterator[Stream]:
    """Drive the characters of several cells through the same ticks; yield a stream for each.

    Args:
        library: The library as it is; labels and rows are told of it.
        matcher: Of it.
        cells: That differ in what is asked of their characters and in nothing else of the tick:
            `Cell.tick` is the same.
        wanted: Controls of each.
    """
    first = cells[0]
    settings = forced(first.settings, first.forced_interval_frames)
    rank = first.match_rank
    played = copy(matcher) if rank == 1 else _RankedMatcher(matcher, rank)
    played.library = perturbed(library, first.root_scale, first.label_shift_frames)
    state = begin_all(matcher, cells, wanted, settings)
    tick = Tick(played, settings, _MAX_SPEED, lambda: 0.0)
    sets = {0: played.candidates.everything}
    dt = np.full(len(state), 1.0 / RATE)
    yield from record(library, state, wanted, lambda: tick.step(state, dt, sets))


def begin_all(
    matcher: Matcher, cells: Sequence[Cell], wanted: Sequence[Wanted], settings: TickSettings
) -> Characters:
    """Return the characters of all cells, one cell after the other."""
    parts = [
        begin(matcher, cell, asked, settings) for cell, asked in zip(cells, wanted, strict=True)
    ]
    return reduce(Characters.append, parts)


def begin(matcher: Matcher, cell: Cell, wanted: Wanted, settings: TickSettings) -> Characters:
    """Return characters side by side that look where they are to go; searches are staggered."""
    count = wanted.velocity.shape[1]
    state = Characters.allocate(count, len(matcher.library.skeleton), len(matcher.schema.channels))
    state.responsiveness[:] = cell.responsiveness
    given = dict(cell.weights)
    state.weights[...] = [given.get(c.name, c.weight) for c in matcher.schema.channels]
    lots = [np.random.default_rng(seed).random(PER_SEED) for seed in cell.seeds]
    state.stagger[:] = np.concatenate(lots)[:count]
    state.until_search[:] = state.stagger * settings.search_interval
    state.root_position[:, 0] = _SPACING * np.arange(count)
    state.sim_position[:] = state.root_position[:, ::2]
    state.stitcher[:] = STITCHER_NAMES.index(cell.stitch or DEFAULT_STITCHER)
    state.foot_lock[:] = cell.foot_lock
    heading = np.arctan2(wanted.velocity[0, :, 0], wanted.velocity[0, :, 1])
    heading = np.where(np.isnan(wanted.facing[0]), heading, wanted.facing[0])
    for angle in (state.root_yaw, state.sim_yaw, state.goal_yaw):
        angle[:] = heading.astype(np.float32)  # as a session places its characters
    return state


def record(
    library: Library, state: Characters, wanted: Sequence[Wanted], step: Callable[[], Block]
) -> Iterator[Stream]:
    """Step once a frame, note what is shown and which moment is playing; yield stream by stream.

    Args:
        library: That plays.
        state: The characters, in the order of `wanted`.
        wanted: Of each stream, all of the same length.
        step: Makes a frame.
    """
    blocks: list[_Shown] = []
    playing: list[_Playing] = []
    seams = []
    clip_before, time_before = state.clip.copy(), state.clip_time.copy()
    velocity = np.concatenate([asked.velocity for asked in wanted], axis=1)
    facing = np.concatenate([asked.facing for asked in wanted], axis=1)
    for frame in range(len(velocity)):
        state.desired_velocity[:] = velocity[frame]
        state.desired_facing[:] = facing[frame]
        block = step()
        blocks.append(_Shown(*(np.array(getattr(block, name)) for name in _Shown._fields)))
        playing.append(_Playing(state.clip.copy(), state.clip_time.copy(), refining.guided(state)))
        if block.jumps is not None:
            who = block.jumps.characters[block.jumps.from_clip >= 0]
            old = sampling.moments(library, clip_before[who], time_before[who]).nearest
            seams.append(Seams(np.full(len(who), frame), who, old))
        clip_before, time_before = playing[-1].clip, playing[-1].time
    shown = _Shown(*(np.stack(part) for part in zip(*blocks, strict=True)))
    played = _Playing(*(np.stack(part) for part in zip(*playing, strict=True)))
    joined = Seams(*(np.concatenate(part) for part in zip(*seams, strict=True)))
    start = 0
    for asked in wanted:
        stop = start + asked.facing.shape[1]
        yield _stream(library, shown, played, joined, asked, slice(start, stop))
        start = stop


class _Shown(NamedTuple):
    """What is kept of a tick's block; float32."""

    root: Floats
    hips: Floats
    rotations: Floats
    foot_targets: Floats
    simulated_root: Floats


class _Playing(NamedTuple):
    """What is kept of the state after a tick."""

    clip: Indices
    time: Floats
    refined: Flags


def _stream(
    library: Library,
    shown: _Shown,
    played: _Playing,
    seams: Seams,
    wanted: Wanted,
    who: slice,
) -> Stream:
    """Return the stream of some of the characters, in float64."""
    mine = _Shown(*(part[:, who].astype(np.float64) for part in shown))
    pose = Pose(mine.root[..., :3], mine.root[..., 3:], mine.hips, mine.rotations)
    at = sampling.moments(library, played.clip[:, who], played.time[:, who])
    inside = (seams.character >= who.start) & (seams.character < who.stop)
    here = Seams(seams.frame[inside], seams.character[inside] - who.start, seams.from_row[inside])
    return Stream(
        pose,
        kinematics.forward_world(library.skeleton, pose)[0],
        at.nearest,
        at,
        _since(here, mine.root.shape[:2]),
        mine.foot_targets,
        mine.simulated_root,
        played.refined[:, who],
        wanted,
        here,
    )


def forced(settings: TickSettings, interval_frames: int) -> TickSettings:
    """Return settings under which every search is a jump and comes every so many frames."""
    if not interval_frames:
        return settings
    return replace(
        settings,
        search_interval=interval_frames / RATE,
        continuing_bias=-1e6,
        least_improvement=0.0,
        control_jump=np.inf,
        facing_jump=np.inf,
        idle_speed=0.0,
    )


def perturbed(library: Library, root_scale: float, label_shift_frames: int) -> Library:
    """Return the library with roots that go further and with contact labels that come late."""
    if root_scale == 1.0 and not label_shift_frames:
        return library
    other = copy(library)
    other.root_position = library.root_position * np.float32(root_scale)
    other.contacts = library.contacts.copy()
    for entry in library.clips:
        frames = np.arange(entry.frames) - label_shift_frames
        rows = entry.start + np.clip(frames, 0, entry.frames - 1)
        other.contacts[entry.start : entry.start + entry.frames] = library.contacts[rows]
    return other


class _RankedMatcher(Matcher):
    """Finds the k-th best match instead of the best."""

    def __init__(self, matcher: Matcher, rank: int) -> None:
        self.__dict__.update(vars(matcher))
        self._rank_wanted = rank

    def search(
        self,
        queries: Floats,
        weights: Floats,
        excluded: Indices,
        k: int = 1,
        candidates: CandidateSet | None = None,
    ) -> Found:
        found = super().search(queries, weights, excluded, self._rank_wanted, candidates)
        return Found(found.rows[:, -1:], found.costs[:, -1:], found.channel_costs[:, -1:])


def _since(seams: Seams, shape: tuple[int, ...]) -> Indices:
    frames = np.arange(shape[0])[:, None]
    last = np.full(shape, -1000)
    last[seams.frame, seams.character] = seams.frame
    last = np.maximum.accumulate(last, axis=0)
    return np.asarray(frames - last)


def under_root(stream: Stream, local: Vectors) -> Vectors:
    """Place points `(T, S, K, 3)` of the root's frame under the streamed root."""
    turn = stream.pose.root_rotation[:, :, None]
    return quaternion.rotate(turn, local) + stream.pose.root_position[:, :, None]
