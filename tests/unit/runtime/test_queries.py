"""Searching by hand: distinct moments, the tick's own springs, precise refusals."""

import numpy as np
import pytest

from stridewire._errors import InvalidRequestError, NotFoundError
from stridewire._messages import ClipTime, DesiredMotion, SearchQuery, Trajectory
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.runtime import Runtime

START = ClipTime("walk-1.4", 2.0)


def test_the_moment_itself_fits_best(runtime: Runtime) -> None:
    """Without an intent, the referenced moment matches itself at no cost."""
    result = runtime.search(SearchQuery(START))
    best = result.matches[0]
    assert (best.clip, best.time_s, best.cost) == (START.clip, START.time_s, 0.0)
    assert "walk" in best.tags
    assert result.library == "small"


def test_matches_are_distinct_moments_in_order(runtime: Runtime) -> None:
    """No two matches lie within a third of a second of one clip; costs ascend and add up."""
    matches = runtime.search(SearchQuery(START, k=20)).matches
    assert len(matches) == 20
    costs = [match.cost for match in matches]
    assert costs == sorted(costs)
    for i, match in enumerate(matches):
        assert sum(match.channels.values()) == pytest.approx(match.cost)
        for other in matches[:i]:
            assert other.clip != match.clip or abs(other.time_s - match.time_s) > 0.3


def test_excluded_moments_are_left_out(runtime: Runtime) -> None:
    """An excluded moment and its neighbourhood do not come back."""
    for match in runtime.search(SearchQuery(START, exclude=[START])).matches:
        assert match.clip != START.clip or abs(match.time_s - START.time_s) > 0.3


def test_an_intent_changes_the_answer(runtime: Runtime) -> None:
    """Asking for a stop finds moments that stop, asking for speed finds faster ones."""
    library = runtime.library("")
    speeds = []
    for speed in (0.0, 3.0):
        query = SearchQuery(START, DesiredMotion(0.0, speed))
        best = runtime.search(query).matches[0]
        clip = library.clip(best.clip)
        ahead = clip.sample(np.array([best.time_s, best.time_s + 1.0])).root_position
        speeds.append(np.linalg.norm(ahead[1] - ahead[0]))
    assert speeds[0] < 0.8 < speeds[1] - 0.4


def test_a_trajectory_is_an_intent_too(runtime: Runtime) -> None:
    """Points in the pose's frame say where to go: here a turn to the left."""
    path = Trajectory(np.array([[0, 0], [0.4, 0.3], [1.0, 0.4]]), np.array([0.0, 0.5, 1.0]))
    path = Trajectory(path.positions_xz, path.times_s, np.array([0.0, 0.9, 1.5]))
    best = runtime.search(SearchQuery(START, path)).matches[0]
    assert "turn-left" in best.tags or "turn" in best.tags


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"k": 0}, "k"),
        ({"k": 1001}, "k"),
        ({"pose": ClipTime("walk-1.4", -0.1)}, "pose.clip.time_s"),
        ({"pose": ClipTime("walk-1.4", 99.0)}, "pose.clip.time_s"),
        ({"pose": ClipTime("walk-1.4", float("nan"))}, "pose.clip.time_s"),
        ({"exclude": [ClipTime("walk-1.4", 99.0)]}, "exclude[0].time_s"),
        ({"exclude": [START] * 65}, "exclude"),
        ({"intent": DesiredMotion(float("nan"), 0.0)}, "motion.velocity_x"),
        ({"intent": DesiredMotion(0.0, 20.1)}, "motion.velocity_z"),
        ({"intent": DesiredMotion(0.0, 0.0, float("inf"))}, "motion.facing_yaw"),
        ({"intent": Trajectory(np.zeros((0, 2)), np.zeros(0))}, "trajectory.times_s"),
    ],
)
def test_bad_queries_are_refused_by_path(runtime: Runtime, changes: dict, field: str) -> None:
    """Each limit of a query is an error with its path."""
    with pytest.raises(InvalidRequestError) as caught:
        runtime.search(SearchQuery(**{"pose": START, **changes}))
    assert [violation.field for violation in caught.value.violations] == [field]


def test_unknown_clips_and_libraries_are_not_found(runtime: Runtime) -> None:
    """Names that nothing has are refused with near ones."""
    with pytest.raises(NotFoundError, match=r"walk-1\.4"):
        runtime.search(SearchQuery(ClipTime("walk-1.5", 0.0)))
    with pytest.raises(NotFoundError, match="small"):
        runtime.search(SearchQuery(START, library="large"))


def test_a_filter_limits_the_matches(runtime: Runtime) -> None:
    """Only moments that satisfy the expression come back."""
    for match in runtime.search(SearchQuery(START, filter="run | idle", k=10)).matches:
        assert {"run", "idle"} & set(match.tags)


def test_weights_change_the_order(runtime: Runtime) -> None:
    """A channel of weight 0 costs nothing; costs are proportional to weights."""
    plain = runtime.search(SearchQuery(START, exclude=[START])).matches[0]
    names = list(plain.channels)
    alone = {name: float(name == "hips-velocity") for name in names}
    match = runtime.search(SearchQuery(START, exclude=[START], weights=alone)).matches[0]
    assert [name for name, cost in match.channels.items() if cost] in ([], ["hips-velocity"])
    doubled = {name: 2.0 * LOCOMOTION.channels[i].weight for i, name in enumerate(names)}
    twice = runtime.search(SearchQuery(START, exclude=[START], weights=doubled)).matches[0]
    assert (twice.clip, twice.time_s) == (plain.clip, plain.time_s)
    assert twice.cost == pytest.approx(2.0 * plain.cost)


def test_excluded_better_moments_are_told_with_their_reason(runtime: Runtime) -> None:
    """What was left out although it fits better is listed, with the field that excluded it."""
    result = runtime.search(SearchQuery(START, exclude=[START]))
    first = result.excluded[0]
    assert (first.match.clip, first.match.cost, first.reason) == (START.clip, 0.0, "exclude[0]")
    assert result.exact


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"filter": "walk |"}, "filter"),
        ({"filter": "wlk"}, "filter"),
        ({"filter": "walk & idle"}, "filter"),
        ({"weights": {"foot-position": -1.0}}, "weights['foot-position']"),
        ({"weights": {"elbow": 1.0}}, "weights['elbow']"),
        ({"weights": {channel.name: 0.0 for channel in LOCOMOTION.channels}}, "weights"),
    ],
)
def test_bad_filters_and_weights_are_refused_by_path(
    runtime: Runtime, changes: dict, field: str
) -> None:
    """Malformed expressions, unknown names, negative and all-zero weights name their field."""
    with pytest.raises(InvalidRequestError) as caught:
        runtime.search(SearchQuery(START, **changes))
    assert [violation.field for violation in caught.value.violations] == [field]
