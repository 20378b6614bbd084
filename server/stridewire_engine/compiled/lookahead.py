"""Looking ahead for kernels: where a character's legs will be at some times, guided by a network.

The counterpart of `runtime.lookahead` and `refining.guide`, for one character at a time. Results go
into scratch arrays that serve one character after the other.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.moments import Clips, moment, nearest, root_step
from stridewire_engine.compiled.turns import to_root


class Ahead(NamedTuple):
    """The legs of one character at K times ahead, in the frame of its root as it is now."""

    hips: Vectors
    """`(K, 2, 3)` hip joints."""
    ankles: Vectors
    """`(K, 2, 3)`."""
    toes: Vectors
    """`(K, 2, 3)`."""
    contacts: Flags
    """`(K, 2)`."""


class Plays(NamedTuple):
    """Columns of characters that say what they play and how they are guided."""

    clip: Indices
    clip_time: Floats
    pace: Floats
    root_offset: Floats
    stitch_time: Floats
    guide_frames: Indices
    guide_planted: Floats
    guide_offset: Vectors


_FADE_OUT = 12
_PLANTED = 0.5


@kernel
def look_ahead(
    ahead: Ahead,
    clips: Clips,
    plays: Plays,
    row: int,
    times: Floats,
    faded: Floats,
    pull: Floats,
) -> None:
    """Work out where the legs of the clip that plays will be.

    Args:
        ahead: Is written.
        clips: Of the library.
        plays: Of the characters.
        row: Of the character.
        times: `(K,)` seconds.
        faded: `(K,)` seconds for which the root's velocity difference counts until then.
        pull: `(3,)` x, z, yaw a second that the root goes beyond its clip.
    """
    clip = plays.clip[row]
    now, weight = moment(clips, clip, plays.clip_time[row])
    offset = plays.root_offset
    for k in range(len(times)):
        time = plays.clip_time[row] + plays.pace[row] * times[k]
        then, share = moment(clips, clip, time)
        way_x, way_z, turn = root_step(clips, clip, now, weight, then, share)
        way_x += offset[row, 0] * faded[k] + pull[0] * times[k]
        way_z += offset[row, 1] * faded[k] + pull[1] * times[k]
        turn += offset[row, 2] * faded[k] + pull[2] * times[k]
        sine, cosine = math.sin(turn), math.cos(turn)
        here = nearest(then, share)
        for side in range(2):
            ahead.contacts[k, side] = clips.contacts[here, 2 * side + 1]
            _place(ahead.hips, clips.hip_tracks, k, side, then, share, way_x, way_z, sine, cosine)
            _place(
                ahead.ankles, clips.ankle_tracks, k, side, then, share, way_x, way_z, sine, cosine
            )
            _place(ahead.toes, clips.toe_tracks, k, side, then, share, way_x, way_z, sine, cosine)


@kernel
def _place(
    out: Vectors,
    track: Vectors,
    k: int,
    side: int,
    row: int,
    share: float,
    way_x: float,
    way_z: float,
    sine: float,
    cosine: float,
) -> None:
    """Write a joint of a track, seen from the root before it went its way."""
    ax, ay, az = track[row, side, 0], track[row, side, 1], track[row, side, 2]
    x = ax + share * (track[row + 1, side, 0] - ax)
    z = az + share * (track[row + 1, side, 2] - az)
    out[k, side, 0] = x * cosine + z * sine + way_x
    out[k, side, 1] = ay + share * (track[row + 1, side, 1] - ay)
    out[k, side, 2] = z * cosine - x * sine + way_z


@kernel
def guided(plays: Plays, row: int, frame_rate: float) -> bool:
    """Tell whether a network guides the character's feet now."""
    frame = _frame(plays, row, 0.0, frame_rate)
    return frame >= 0 and frame < plays.guide_frames[row]


@kernel
def lead(
    ahead: Ahead,
    plays: Plays,
    row: int,
    times: Floats,
    frame_rate: float,
    sine: float,
    cosine: float,
) -> None:
    """Write what the network said of the times ahead into the legs there.

    Args:
        ahead: Is changed.
        plays: Of the characters.
        row: Of the character; it is guided.
        times: `(K,)` seconds.
        frame_rate: Of guides.
        sine: Of the root's yaw.
        cosine: Of the root's yaw.
    """
    for k in range(len(times)):
        for side in range(2):
            planted, x, y, z = said(plays, row, side, times[k], ahead.contacts[k, side], frame_rate)
            led = to_root((x, y, z), sine, cosine)
            for axis in range(3):
                ahead.ankles[k, side, axis] += led[axis]
                ahead.toes[k, side, axis] += led[axis]
            ahead.contacts[k, side] = planted > _PLANTED


@kernel
def said(
    plays: Plays, row: int, side: int, time: float, label: bool, frame_rate: float
) -> tuple[float, float, float, float]:
    """Return the share to which a toe stands and its offset in the world at a time ahead.

    What the network said fades into the clip's label towards the end of the guide.
    """
    frame = _frame(plays, row, time, frame_rate)
    frames = plays.guide_planted.shape[1]
    x = min(max((frames - frame) / (_FADE_OUT + 1.0), 0.0), 1.0)
    share = x * x * (3.0 - 2.0 * x)
    at = min(max(frame, 0), frames - 1)
    planted = share * plays.guide_planted[row, at, side] + (1.0 - share) * label
    offset = plays.guide_offset
    return (
        planted,
        share * offset[row, at, side, 0],
        share * offset[row, at, side, 1],
        share * offset[row, at, side, 2],
    )


@kernel
def _frame(plays: Plays, row: int, time: float, frame_rate: float) -> int:
    """Return the frame of the guide at a time ahead."""
    since = min(float(plays.stitch_time[row]), 1e3)
    return int(np.rint((since + time) * frame_rate)) - 1


def scratch(count: int) -> Any:
    """Return room for one character's legs at so many times."""
    shape = (count, 2, 3)
    return Ahead(
        np.empty(shape, np.float32),
        np.empty(shape, np.float32),
        np.empty(shape, np.float32),
        np.empty((count, 2), np.bool_),
    )
