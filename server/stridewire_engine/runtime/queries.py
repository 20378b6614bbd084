"""Queries by hand: what fits a moment of a clip and an intent, outside of any session."""

import numpy as np

from stridewire._errors import InvalidRequestError, NotImplementedYetError, Violation
from stridewire._messages import (
    ClipTime,
    DesiredMotion,
    Limits,
    Match,
    SearchQuery,
    SearchResult,
    Trajectory,
)
from stridewire.motion.array_types import Floats
from stridewire_engine.library import Library
from stridewire_engine.matching.features import trajectory_features
from stridewire_engine.matching.search import NEIGHBOURHOOD_FRAMES, Found, Matcher
from stridewire_engine.runtime import admission, controls, intent, sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings

_MAX_K = 1000
_MAX_EXCLUDED = 64


def search(
    matcher: Matcher, query: SearchQuery, limits: Limits, settings: TickSettings
) -> SearchResult:
    """Return the k best moments, no two of them in one neighbourhood.

    Raises:
        InvalidRequestError: If a field is out of range.
        NotFoundError: If there is no such clip.
        NotImplementedYetError: If a filter or weights are given.
    """
    _check(query, limits)
    library = matcher.library
    row = row_of(library, "pose.clip", query.pose)
    features = library.features[row : row + 1].astype(np.float64)
    if query.intent is not None:
        _set_trajectory(matcher, features, _future(library, row, query, matcher, settings))
    excluded = np.array(
        [[row_of(library, f"exclude[{i}]", moment) for i, moment in enumerate(query.exclude)]],
        np.int64,
    ).reshape(1, -1)
    # neighbours come together, so that many more than k are asked for
    wanted = min(len(matcher), (query.k + 1) * 2 * NEIGHBOURHOOD_FRAMES)
    found = matcher.search(features, matcher.schema.weights[None], excluded, wanted)
    matches = tuple(_match(matcher, found, i) for i in _apart(library, found, query.k))
    return SearchResult(matches, library.name, library.manifest.content_hash)


def row_of(library: Library, path: str, moment: ClipTime) -> int:
    """Return the library's row nearest to a moment.

    Raises:
        NotFoundError: If there is no such clip.
        InvalidRequestError: If the time lies outside of it.
    """
    entry = library.entry(moment.clip)
    length = (entry.frames - 1) / library.frame_rate
    if not 0.0 <= moment.time_s <= length:
        raise InvalidRequestError.of(
            Violation(
                f"{path}.time_s",
                f"{moment.time_s} s; clip {moment.clip!r} lasts from 0 to {length:.3f} s",
            )
        )
    return entry.start + round(moment.time_s * library.frame_rate)


def _check(query: SearchQuery, limits: Limits) -> None:
    for name in ("filter", "weights"):
        if getattr(query, name):
            raise NotImplementedYetError(
                f"{name} {admission.NOT_YET}", [Violation(name, admission.NOT_YET)]
            )
    found = []
    if not 1 <= query.k <= _MAX_K:
        found.append(Violation("k", f"{query.k}; allowed are 1 to {_MAX_K}, 0 means 5"))
    if len(query.exclude) > _MAX_EXCLUDED:
        found.append(
            Violation("exclude", f"{len(query.exclude)} moments; allowed are {_MAX_EXCLUDED}")
        )
    if isinstance(query.intent, DesiredMotion):
        for name in ("velocity_x", "velocity_z"):
            value = getattr(query.intent, name)
            if not abs(value) <= limits.max_speed:
                found.append(
                    Violation(f"motion.{name}", f"{value} m/s; allowed are ±{limits.max_speed:g}")
                )
        if query.intent.facing_yaw is not None and not np.isfinite(query.intent.facing_yaw):
            found.append(Violation("motion.facing_yaw", "allowed are finite radians"))
    if found:
        raise InvalidRequestError.of(*found)
    if isinstance(query.intent, Trajectory):
        admission.check_trajectory("trajectory", query.intent)


def _future(
    library: Library, row: int, query: SearchQuery, matcher: Matcher, settings: TickSettings
) -> intent.Prediction:
    """Predict in the frame of the pose's root, with the very springs of the tick."""
    state = Characters.allocate(1, len(library.skeleton))
    if isinstance(query.intent, Trajectory):
        controls.follow(state, 0, query.intent)
    elif isinstance(query.intent, DesiredMotion):
        at = sampling.Moments(np.array([row]), np.zeros(1, np.float32))
        velocity = sampling.root_velocity(library, at)
        state.sim_velocity[...] = velocity[:, :2]
        state.sim_yaw_velocity[...] = velocity[:, 2]
        state.desired_velocity[0] = query.intent.velocity_x, query.intent.velocity_z
        if query.intent.facing_yaw is not None:
            state.desired_facing[0] = query.intent.facing_yaw
    goal = intent.set_goals(state, np.inf)
    return intent.predict(state, goal, np.array(matcher.schema.trajectory_times), settings)


def _set_trajectory(matcher: Matcher, features: Floats, future: intent.Prediction) -> None:
    for channel in matcher.schema.channels:
        if channel.is_trajectory:
            ahead = [matcher.schema.trajectory_times.index(time) for time in channel.times]
            raw = trajectory_features(channel, future.positions[:, ahead], future.yaws[:, ahead])
            columns = matcher.schema.slice(channel)
            features[:, columns] = matcher.normalisation.apply(raw, columns)


def _apart(library: Library, found: Found, k: int) -> list[int]:
    """Return the indices of the best k finds that are not in a better one's neighbourhood."""
    chosen: list[int] = []
    rows = found.rows[0]
    for i, row in enumerate(rows):
        near = [
            abs(int(row) - int(rows[j])) < NEIGHBOURHOOD_FRAMES
            and library.clip_of[row] == library.clip_of[rows[j]]
            for j in chosen
        ]
        if row >= 0 and not any(near):
            chosen.append(i)
        if len(chosen) == k:
            break
    return chosen


def _match(matcher: Matcher, found: Found, i: int) -> Match:
    library = matcher.library
    row = int(found.rows[0, i])
    entry = library.clips[library.clip_of[row]]
    names = [channel.name for channel in matcher.schema.channels]
    return Match(
        entry.name,
        (row - entry.start) / library.frame_rate,
        library.tags_at(row),
        float(found.costs[0, i]),
        dict(zip(names, found.channel_costs[0, i].tolist(), strict=True)),
    )
