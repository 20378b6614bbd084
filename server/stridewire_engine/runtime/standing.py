"""Standing: a character that stands and is to go on standing stays in the span that it plays.

Where a clip stands still for a while, playback turns round before the span ends and goes back, and
forth again: a person who sways looks alike either way, and nothing has to be hidden. Who stands
thus needs no transition, however short the clip is.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.springs import damper_exact, wrap_angle
from stridewire_engine.library import Library
from stridewire_engine.runtime import sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings

_STILL_SPEED = 0.2
"""A root slower than this, in m/s, stands."""
_STILL_TURNING = 0.3
"""Unless it turns faster than this, in rad/s."""
_SHORTEST_S = 1 / 3
"""Shorter spans are played through."""
_TURNING_HALFLIFE = 0.2
"""Damper of the pace of playback."""
_ROOM_S = 0.8 * _TURNING_HALFLIFE
"""So many seconds before a span ends playback begins to turn round; it goes on for 0.44 halflives,
and a frame or two pass before it begins."""


class Spans(NamedTuple):
    """The standing spans of a library."""

    first: Indices
    """`(F,)` row at which the span of each row begins, -1 where the row is in none."""
    last: Indices
    """`(F,)` its last row."""

    @classmethod
    def of(cls, library: Library, clip_end_margin: float) -> "Spans":
        """Find them.

        Args:
            library: Whose clips.
            clip_end_margin: Clips are left at the latest so many seconds before their end.
        """
        rows = np.arange(len(library.clip_of))
        clip = library.clip_of
        ends = library.clip_starts[clip] + library.clip_frames[clip] - 1
        after = np.minimum(rows + 1, ends)
        way = library.root_position[after] - library.root_position[rows]
        turn = library.root_yaw[after] - library.root_yaw[rows]
        still = np.hypot(way[:, 0], way[:, 2]) * library.frame_rate < _STILL_SPEED
        still &= np.abs(turn) * library.frame_rate < _STILL_TURNING
        still &= library.contacts[:, 1::2].all(axis=1) & ~library.loops[clip]
        still &= rows <= ends - np.ceil(clip_end_margin * library.frame_rate)
        first, last = _runs(still, clip)
        short = last - first < round(_SHORTEST_S * library.frame_rate)
        return cls(np.where(short, -1, first), np.where(short, -1, last))


def stands(state: Characters, library: Library, spans: Spans, settings: TickSettings) -> Flags:
    """Tell who stands and is asked to go on standing: no search, hence no fidgeting jumps."""
    asked = np.hypot(state.desired_velocity[:, 0], state.desired_velocity[:, 1])
    moving = np.hypot(state.sim_velocity[:, 0], state.sim_velocity[:, 1])
    turn = np.abs(wrap_angle(state.goal_yaw - state.root_yaw))
    wanted = (np.maximum(asked, moving) < settings.idle_speed) & (turn < settings.idle_turn)
    slow = (state.root_speed < settings.idle_speed) | (_span(state, library, spans)[0] >= 0)
    return np.asarray(wanted & slow & ~state.has_path)


def advance(
    state: Characters, library: Library, spans: Spans, dt: Floats, settings: TickSettings
) -> Floats:
    """Return by how many seconds `(N,)` the clips go on; less than nothing where they go back.

    Args:
        state: N rows, all playing; their pace is updated.
        library: That they play.
        spans: Of the library.
        dt: `(N,)` seconds.
        settings: What counts as standing.
    """
    first, last, row = _span(state, library, spans)
    stays = stands(state, library, spans, settings) & (first >= 0)
    room = _ROOM_S * library.frame_rate
    back = (last - row < room) | (state.goes_back & (row - first >= room))
    state.goes_back[...] = stays & back
    wanted = np.where(state.goes_back, -1.0, 1.0)
    state.pace[...] = damper_exact(state.pace, wanted, _TURNING_HALFLIFE, dt)
    return np.asarray(state.pace * dt)


def _span(state: Characters, library: Library, spans: Spans) -> tuple[Indices, Indices, Indices]:
    """Return the first and the last row `(N,)` of the spans that are playing, and the row now."""
    clip = np.maximum(state.clip, 0)
    row = sampling.moments(library, clip, state.clip_time).nearest
    return spans.first[row], spans.last[row], row


def _runs(flags: Flags, clip: Indices) -> tuple[Indices, Indices]:
    """Return for each row the first and the last row of its run within a clip, -1 for none."""
    rows = np.arange(len(flags))
    begins = flags.copy()
    begins[1:] &= ~flags[:-1] | (clip[1:] != clip[:-1])
    ends = flags.copy()
    ends[:-1] &= ~flags[1:] | (clip[1:] != clip[:-1])
    first = np.maximum.accumulate(np.where(begins, rows, -1))
    last = np.minimum.accumulate(np.where(ends, rows, len(rows))[::-1])[::-1]
    return np.where(flags, first, -1), np.where(flags, last, -1)
