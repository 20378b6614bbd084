"""The query: what a character's next moment should look like, as normalised features."""

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine import compiled
from stridewire_engine.compiled.asking import Asked
from stridewire_engine.matching.features import trajectory_features
from stridewire_engine.matching.schema import Channel, ChannelKind
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import intent, sampling
from stridewire_engine.runtime.asking import asking_of, needs_pose
from stridewire_engine.runtime.characters import SHOWN_JOINTS, Characters
from stridewire_engine.runtime.intent import Prediction
from stridewire_engine.runtime.response import multiples
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.stitchers import STITCHERS


def ask(
    state: Characters,
    searching: Indices,
    matcher: Matcher,
    prediction: Prediction,
    settings: TickSettings,
) -> Asked:
    """Return what characters ask, and what going on costs them.

    Args:
        state: N rows.
        searching: `(M,)` which of them search.
        matcher: The library's.
        prediction: Where the simulated roots of all rows will be, in the world.
        settings: How long choices are remembered.
    """
    if compiled.ENABLED:
        return asking_of(matcher).ask(state, searching, prediction, settings.reselect_history)
    rows, library = state.borrow(searching), matcher.library
    starting = rows.clip < 0
    playing = sampling.moments(library, np.maximum(rows.clip, 0), rows.clip_time).nearest
    future = Prediction(prediction.positions[searching], prediction.yaws[searching])
    queries = build(rows, matcher, playing, future)
    weights = _weights(matcher, rows, starting)
    excluded = _excluded(matcher, rows, playing, starting, settings)
    stay_costs = matcher.costs(queries, weights, playing[:, None])[:, 0]
    return Asked(playing, queries, weights, excluded, stay_costs)


def build(rows: Characters, matcher: Matcher, playing: Indices, future: Prediction) -> Floats:
    """Build normalised queries `(M, D)`, float64.

    The pose part is the stored features of the frame now playing, so that staying costs nothing
    there; while a transition is being hidden it is what is shown, as far as that is known (feet,
    toes, hips).

    Args:
        rows: M characters.
        matcher: The library's.
        playing: `(M,)` rows of the library now playing.
        future: Where the simulated roots will be at the schema's times, in the world.
    """
    features = matcher.library.features[playing].astype(np.float64)
    settled = np.array([stitcher.settled_s for stitcher in STITCHERS])[rows.stitched_by]
    hiding = ((rows.since_jump < settled) | (rows.clip < 0))[:, None]
    for channel in matcher.schema.channels:
        columns = matcher.schema.slice(channel)
        shown = _shown(rows, channel)
        if shown is not None:
            normal = matcher.normalisation.apply(shown, columns)
            features[:, columns] = np.where(hiding, normal, features[:, columns])
    set_trajectory(matcher, features, intent.to_root_frame(rows, future))
    return features


def set_trajectory(matcher: Matcher, features: Floats, future: Prediction) -> None:
    """Write where the root is to go into normalised features `(M, D)`; the past stays as it is.

    Args:
        matcher: The library's.
        features: Changed in place.
        future: At the schema's times ahead, in the root's frame.
    """
    times = matcher.schema.trajectory_times
    for channel in matcher.schema.channels:
        if not channel.is_trajectory:
            continue
        ahead = [time for time in channel.times if time > 0.0]
        which = [times.index(time) for time in ahead]
        raw = trajectory_features(channel, future.positions[:, which], future.yaws[:, which])
        start = matcher.schema.slice(channel).start
        places = np.array([2 * channel.times.index(time) for time in ahead], np.intp)
        columns = start + np.stack([places, places + 1], axis=-1).reshape(-1)
        features[:, columns] = matcher.normalisation.apply(raw, columns)


def _shown(rows: Characters, channel: Channel) -> Floats | None:
    """Return what is shown of a channel, raw `(M, …)`; None where it is not known."""
    if not channel.joints or not set(channel.joints) <= set(SHOWN_JOINTS):
        return None
    which = [SHOWN_JOINTS.index(joint) for joint in channel.joints]
    if channel.kind is ChannelKind.POSITION:
        return rows.shown_local[:, which].reshape(len(rows), -1)
    if channel.kind is ChannelKind.VELOCITY:
        return rows.shown_velocity[:, which].reshape(len(rows), -1)
    return None


def _excluded(
    matcher: Matcher,
    rows: Characters,
    playing: Indices,
    starting: Flags,
    settings: TickSettings,
) -> Indices:
    """Return rows `(M, E)` whose neighbourhood is not to be chosen; -1 for none."""
    library = matcher.library
    twin = library.twins[library.clip_of[playing]]
    frame = playing - library.clip_starts[library.clip_of[playing]]
    mirrored = np.where(twin >= 0, library.clip_starts[twin] + frame, -1)
    own = np.where(starting[:, None], -1, np.stack([playing, mirrored], axis=1))
    young = rows.time[:, None] - rows.recent_time < settings.reselect_history
    return np.concatenate([own, np.where(young, rows.recent, -1)], axis=1)


def _weights(matcher: Matcher, rows: Characters, starting: Flags) -> Floats:
    weights = rows.weights.copy()
    channels = matcher.schema.channels
    trajectories = np.array([channel.is_trajectory for channel in channels])
    weights[:, trajectories] *= np.asarray(multiples(rows.responsiveness).trajectory)[:, None]
    poses = np.array([needs_pose(channel) for channel in channels])
    weights[np.ix_(starting, poses)] = 0.0
    return weights
