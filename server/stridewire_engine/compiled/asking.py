"""Asking for kernels: what characters search for, under which weights, and what is left out.

The counterpart of `runtime.query` and of what `choice.consider` prepares.
"""

import math
from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.moments import Clips, moment, nearest
from stridewire_engine.compiled.turns import wrap_angle

STORED, LOCAL, VELOCITY, WAY_X, WAY_Z, SINE, COSINE = range(7)
"""Where a number of a query comes from."""


class Searches(NamedTuple):
    """Columns of characters that a search reads."""

    clip: Indices
    clip_time: Floats
    since_jump: Floats
    stitched_by: Indices
    shown_local: Vectors
    shown_velocity: Vectors
    root_position: Vectors
    root_yaw: Floats
    weights: Floats
    responsiveness: Floats
    recent: Indices
    recent_time: Floats
    time: Floats


class Numbers(NamedTuple):
    """The D numbers of a query in C channels."""

    source: Indices
    """`(D,)`."""
    at: Indices
    """`(D, 2)` joint and axis, or time ahead."""
    mean: Floats
    """`(D,)`."""
    deviation: Floats
    """`(D,)`."""
    channel_of: Indices
    """`(D,)`."""
    is_trajectory: Flags
    """`(C,)`."""
    is_pose: Flags
    """`(C,)` channels that a character which begins has nothing for."""


class Stored(NamedTuple):
    """What a search reads of a library of F frames in C clips."""

    features: Floats
    """`(F, D)` normalised."""
    clip_of: Indices
    twins: Indices
    """`(C,)` the mirrored clip, -1 for none."""


class Asked(NamedTuple):
    """What M characters ask; arrays that are written."""

    playing: Indices
    """`(M,)` rows."""
    queries: Floats
    """`(M, D)` normalised."""
    weights: Floats
    """`(M, C)`."""
    excluded: Indices
    """`(M, 2 + R)` rows: playing, its mirror image, recent choices; -1 for none."""
    stay_costs: Floats
    """`(M, C)` of going on, without the bias of the row that plays."""


@kernel
def ask(
    searches: Searches,
    clips: Clips,
    stored: Stored,
    numbers: Numbers,
    rows: Indices,
    positions: Floats,
    yaws: Floats,
    settled: Floats,
    ends: tuple[float, float],
    history: float,
    asked: Asked,
) -> None:
    """Write what characters ask.

    Args:
        searches: Of N characters.
        clips: Of the library.
        stored: Of the library.
        numbers: Of queries.
        rows: `(M,)` who searches.
        positions: `(N, K, 2)` of the simulated roots ahead, in the world.
        yaws: `(N, K)`.
        settled: `(S,)` seconds after which a stitcher shows the clip again.
        ends: Multiples of trajectory weights at responsiveness 0 and 1.
        history: Seconds within which a choice is not made again.
        asked: Out.
    """
    for i in range(len(rows)):
        row = rows[i]
        starts = searches.clip[row] < 0
        at, weight = moment(clips, max(searches.clip[row], 0), searches.clip_time[row])
        playing = nearest(at, weight)
        asked.playing[i] = playing
        hides = starts or searches.since_jump[row] < settled[searches.stitched_by[row]]
        for d in range(len(numbers.source)):
            asked.queries[i, d] = _number(
                searches, stored, numbers, row, playing, d, hides, positions, yaws
            )
        _weigh(searches, numbers, row, starts, ends, asked.weights[i])
        _exclude(searches, clips, stored, row, playing, starts, history, asked.excluded[i])
        _stay(stored, numbers, asked, i, playing)


@kernel
def _number(
    searches: Searches,
    stored: Stored,
    numbers: Numbers,
    row: int,
    playing: int,
    d: int,
    hides: bool,
    positions: Floats,
    yaws: Floats,
) -> float:
    """Return a number of a query, normalised in float32 as the library's are."""
    source, first, second = numbers.source[d], numbers.at[d, 0], numbers.at[d, 1]
    if source == STORED or (source <= VELOCITY and not hides):
        return float(stored.features[playing, d])
    raw = 0.0
    if source == LOCAL:
        raw += searches.shown_local[row, first, second]
    elif source == VELOCITY:
        raw += searches.shown_velocity[row, first, second]
    elif source >= SINE:
        turn = wrap_angle(yaws[row, first] - searches.root_yaw[row])
        raw = math.sin(turn) if source == SINE else math.cos(turn)
    else:
        x = positions[row, first, 0] - searches.root_position[row, 0]
        z = positions[row, first, 1] - searches.root_position[row, 2]
        sine, cosine = math.sin(searches.root_yaw[row]), math.cos(searches.root_yaw[row])
        raw = x * cosine - z * sine if source == WAY_X else x * sine + z * cosine
    return float(np.float32((raw - numbers.mean[d]) / numbers.deviation[d]))


@kernel
def _weigh(
    searches: Searches,
    numbers: Numbers,
    row: int,
    starts: bool,
    ends: tuple[float, float],
    weights: Floats,
) -> None:
    responsiveness = searches.responsiveness[row]
    factor = ends[0] ** max(1.0 - 2.0 * responsiveness, 0.0)
    factor *= ends[1] ** max(2.0 * responsiveness - 1.0, 0.0)
    for channel in range(len(weights)):
        weights[channel] = searches.weights[row, channel]
        if numbers.is_trajectory[channel]:
            weights[channel] *= factor
        if starts and numbers.is_pose[channel]:
            weights[channel] = 0.0


@kernel
def _exclude(
    searches: Searches,
    clips: Clips,
    stored: Stored,
    row: int,
    playing: int,
    starts: bool,
    history: float,
    excluded: Indices,
) -> None:
    excluded[0] = excluded[1] = -1
    if not starts:
        clip = stored.clip_of[playing]
        twin = stored.twins[clip]
        excluded[0] = playing
        if twin >= 0:
            excluded[1] = clips.starts[twin] + playing - clips.starts[clip]
    for past in range(searches.recent.shape[1]):
        young = searches.time[row] - searches.recent_time[row, past] < history
        excluded[2 + past] = searches.recent[row, past] if young else -1


@kernel
def _stay(stored: Stored, numbers: Numbers, asked: Asked, i: int, playing: int) -> None:
    costs, queries = asked.stay_costs, asked.queries
    for channel in range(costs.shape[1]):
        costs[i, channel] = 0.0
    for d in range(queries.shape[1]):
        off = stored.features[playing, d] - queries[i, d]
        costs[i, numbers.channel_of[d]] += off * off
    for channel in range(costs.shape[1]):
        costs[i, channel] *= asked.weights[i, channel]
