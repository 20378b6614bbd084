"""Choice: which characters search in this tick, and whether they stay or jump."""

from typing import NamedTuple

import numpy as np

from stridewire._messages import TransitionReason
from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.springs import wrap_angle
from stridewire_engine.matching.features import trajectory_features
from stridewire_engine.matching.schema import ChannelKind
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import intent, sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.intent import Prediction
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.stitchers import STITCHERS


class Jumps(NamedTuple):
    """The characters that leave what they were playing, and for where; arrays of M rows."""

    characters: Indices
    """Indices of the characters in the tick's rows."""
    from_clip: Indices
    """-1 where the character begins."""
    from_time: Floats
    to_clip: Indices
    to_time: Floats
    cost: Floats
    stay_cost: Floats
    channel_costs: Floats
    """`(M, C)`."""
    reason: Indices
    """Values of `TransitionReason`."""


def due(state: Characters, matcher: Matcher, dt: Floats, settings: TickSettings) -> Indices:
    """Return `(N,)` the reason to search now, 0 for none; paused characters search only to begin.

    Lets the clocks of the searches run by `dt` `(N,)`.
    """
    state.until_search -= dt
    waited = settings.search_interval - state.until_search >= settings.shortest_interval
    change = state.desired_velocity - state.searched_velocity
    turned = np.abs(wrap_angle(state.goal_yaw - state.searched_yaw))
    jumped = (np.hypot(change[:, 0], change[:, 1]) > settings.control_jump) | (
        turned > settings.facing_jump
    )
    reason = np.zeros(len(state), np.int8)
    reason[state.until_search <= 0.0] = TransitionReason.BETTER_MATCH
    reason[jumped & waited] = TransitionReason.CONTROL_CHANGE
    reason[state.force_search] = TransitionReason.FORCED
    reason[_at_end(state, matcher, dt, settings)] = TransitionReason.CLIP_END
    reason[dt <= 0.0] = 0
    reason[state.clip < 0] = TransitionReason.START
    return reason


def choose(
    state: Characters,
    matcher: Matcher,
    prediction: Prediction,
    reason: Indices,
    settings: TickSettings,
) -> Jumps:
    """Search for the characters that have a reason, and decide.

    A character jumps if the best other moment costs less than staying by more than the bias. At the
    end of its clip, and where it begins, it takes the best there is.

    Args:
        state: N rows; its search clocks are set anew.
        matcher: The library's.
        prediction: Where the simulated roots will be, `(N, K, …)` in the world.
        reason: `(N,)` from `due`.
        settings: Biases and intervals.
    """
    searching = np.flatnonzero(reason)
    rows = state.take(searching)
    starting = rows.clip < 0
    playing = sampling.moments(matcher.library, np.maximum(rows.clip, 0), rows.clip_time).nearest
    future = Prediction(prediction.positions[searching], prediction.yaws[searching])
    query = _queries(rows, matcher, playing, intent.to_root_frame(rows, future))
    weights = _weights(matcher, starting)
    excluded = np.where(starting, -1, playing)[:, None]
    found = matcher.search(query, weights, excluded)
    stay = matcher.costs(query, weights, playing[:, None]).sum(axis=-1)[:, 0]
    bias = settings.continuing_bias * matcher.typical_cost
    must = np.isin(reason[searching], (TransitionReason.CLIP_END, TransitionReason.START))
    better = found.costs[:, 0] + bias < stay * (1.0 - settings.least_improvement)
    jump = np.isfinite(found.costs[:, 0]) & (must | better)
    _restart_clocks(state, searching, settings)
    target = found.rows[jump, 0]
    clip = matcher.library.clip_of[target]
    return Jumps(
        characters=searching[jump],
        from_clip=rows.clip[jump],
        from_time=rows.clip_time[jump],
        to_clip=clip.astype(np.int32),
        to_time=(target - matcher.library.clip_starts[clip]) / matcher.library.frame_rate,
        cost=found.costs[jump, 0],
        stay_cost=stay[jump],
        channel_costs=found.channel_costs[jump, 0],
        reason=reason[searching[jump]],
    )


def _at_end(state: Characters, matcher: Matcher, dt: Floats, settings: TickSettings) -> Flags:
    library = matcher.library
    length = (library.clip_frames[np.maximum(state.clip, 0)] - 1) / library.frame_rate
    return np.asarray(state.clip_time + dt > length - settings.clip_end_margin)


def _queries(rows: Characters, matcher: Matcher, playing: Indices, future: Prediction) -> Floats:
    """Build normalised queries `(M, D)`.

    The pose part is the stored features of the frame now playing, so that staying costs nothing
    there; while a transition is being hidden it is what is shown.
    """
    schema = matcher.schema
    query = matcher.library.features[playing].astype(np.float64)
    settled = np.array([stitcher.settled_s for stitcher in STITCHERS])[rows.stitcher]
    shown = (rows.since_jump < settled) | (rows.clip < 0)
    shown_sources = {
        (ChannelKind.POSITION, "LeftFoot", "RightFoot"): rows.shown_ankle,
        (ChannelKind.VELOCITY, "LeftFoot", "RightFoot"): rows.shown_ankle_velocity,
        (ChannelKind.VELOCITY, "Hips"): rows.shown_hips_velocity,
    }
    for channel in schema.channels:
        columns = schema.slice(channel)
        if channel.is_trajectory:
            ahead = [schema.trajectory_times.index(time) for time in channel.times]
            raw = trajectory_features(channel, future.positions[:, ahead], future.yaws[:, ahead])
            query[:, columns] = matcher.normalisation.apply(raw, columns)
        elif (source := shown_sources.get((channel.kind, *channel.joints))) is not None:
            normal = matcher.normalisation.apply(source.reshape(len(rows), -1), columns)
            query[:, columns] = np.where(shown[:, None], normal, query[:, columns])
    return query


def _weights(matcher: Matcher, starting: Flags) -> Floats:
    weights = np.tile(matcher.schema.weights, (len(starting), 1))
    # a character that begins has velocities and a way to go, but no pose yet
    poses = np.array([channel.kind is ChannelKind.POSITION for channel in matcher.schema.channels])
    weights[np.ix_(starting, poses)] = 0.0
    return weights


def _restart_clocks(state: Characters, searched: Indices, settings: TickSettings) -> None:
    # a stagger drawn at the start of a session survives, since the overshoot is carried on
    overshoot = np.clip(state.until_search[searched], -settings.search_interval, 0.0)
    state.until_search[searched] = settings.search_interval + overshoot
    state.searched_velocity[searched] = state.desired_velocity[searched]
    state.searched_yaw[searched] = state.goal_yaw[searched]
    state.force_search[searched] = False
