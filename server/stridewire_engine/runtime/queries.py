"""Queries by hand: what fits a moment or a pose and an intent, outside of any session."""

from collections.abc import Iterator

import numpy as np

from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import (
    ClipTime,
    DesiredMotion,
    Limits,
    SearchQuery,
    SearchResult,
    Trajectory,
)
from stridewire.motion.clip import Pose
from stridewire_engine.library import Library
from stridewire_engine.matching.explanation import Exclusion, explain
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import admission, controls, inline_pose, intent, query, sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings

_MAX_K = 1000
_MAX_EXCLUDED = 64


def search(
    matcher: Matcher, asked: SearchQuery, limits: Limits, settings: TickSettings
) -> SearchResult:
    """Return the k best moments, no two of them in one neighbourhood, and the excluded better ones.

    Raises:
        InvalidRequestError: If a field is out of range.
        NotFoundError: If there is no such clip.
    """
    wrong = [*_violations(asked, limits, matcher)]
    if wrong:
        raise InvalidRequestError.of(*wrong)
    library = matcher.library
    weights = admission.merged_weights(asked.weights, matcher.schema)
    if isinstance(asked.pose, Pose):
        row, features = None, inline_pose.features(matcher, asked.pose)
        weights = weights * inline_pose.known(matcher.schema, asked.intent is not None)
        if not weights.any():
            raise InvalidRequestError.of(Violation("weights", inline_pose.NOTHING_TO_COMPARE))
    else:
        row = row_of(library, "pose.clip", asked.pose)
        features = library.features[row : row + 1].astype(np.float64)
    if asked.intent is not None:
        query.set_trajectory(matcher, features, _future(matcher, row, asked, settings))
    exclusions = [
        Exclusion(row_of(library, f"exclude[{i}]", moment), f"exclude[{i}]")
        for i, moment in enumerate(asked.exclude)
    ]
    among = matcher.candidates.get(asked.filter, "filter")
    matches, excluded = explain(matcher, features[0], weights, exclusions, asked.k, among)
    return SearchResult(
        matches, library.name, library.manifest.content_hash, excluded, among.is_exact
    )


def row_of(library: Library, path: str, moment: ClipTime) -> int:
    """Return the library's row nearest to a moment.

    Raises:
        NotFoundError: If there is no such clip.
        InvalidRequestError: If the time lies outside of it.
    """
    if moment.library not in ("", library.name):
        raise InvalidRequestError.of(
            Violation(f"{path}.library", f"{moment.library!r}; searched is {library.name!r}")
        )
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


def _violations(asked: SearchQuery, limits: Limits, matcher: Matcher) -> Iterator[Violation]:
    if not 1 <= asked.k <= _MAX_K:
        yield Violation("k", f"{asked.k}; allowed are 1 to {_MAX_K}, 0 means 5")
    if len(asked.exclude) > _MAX_EXCLUDED:
        yield Violation("exclude", f"{len(asked.exclude)} moments; allowed are {_MAX_EXCLUDED}")
    if isinstance(asked.pose, Pose):
        yield from inline_pose.check("pose.inline", asked.pose, matcher.library.skeleton)
    if isinstance(asked.intent, DesiredMotion):
        yield from _check_motion(asked.intent, limits)
    elif isinstance(asked.intent, Trajectory):
        yield from admission.check_trajectory("trajectory", asked.intent)
    yield from admission.check_filter("filter", asked.filter, matcher)
    yield from admission.check_weights("weights", asked.weights, matcher.schema)


def _check_motion(motion: DesiredMotion, limits: Limits) -> Iterator[Violation]:
    for name in ("velocity_x", "velocity_z"):
        value = getattr(motion, name)
        if not abs(value) <= limits.max_speed:
            yield Violation(f"motion.{name}", f"{value} m/s; allowed are ±{limits.max_speed:g}")
    if motion.facing_yaw is not None and not np.isfinite(motion.facing_yaw):
        yield Violation("motion.facing_yaw", "allowed are finite radians")


def _future(
    matcher: Matcher, row: int | None, asked: SearchQuery, settings: TickSettings
) -> intent.Prediction:
    """Predict in the frame of the pose's root, with the very springs of the tick.

    Without a row, whose velocity would be known, the pose moves as it is asked to already.
    """
    library = matcher.library
    state = Characters.allocate(1, len(library.skeleton), len(matcher.schema.channels))
    if isinstance(asked.intent, Trajectory):
        controls.follow(state, 0, asked.intent)
    elif isinstance(asked.intent, DesiredMotion):
        state.desired_velocity[0] = asked.intent.velocity_x, asked.intent.velocity_z
        state.sim_velocity[...] = state.desired_velocity
        if row is not None:
            at = sampling.Moments(np.array([row]), np.zeros(1, np.float32))
            velocity = sampling.root_velocity(library, at)
            state.sim_velocity[...] = velocity[:, :2]
            state.sim_yaw_velocity[...] = velocity[:, 2]
        if asked.intent.facing_yaw is not None:
            state.desired_facing[0] = asked.intent.facing_yaw
    goal = intent.set_goals(state, np.inf)
    return intent.predict(state, goal, np.array(matcher.schema.trajectory_times), settings)
