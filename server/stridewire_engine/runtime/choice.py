"""Choice: which characters search in this tick, and whether they stay or jump."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from stridewire._messages import TransitionReason
from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.springs import wrap_angle
from stridewire_engine.matching.candidates import CandidateSet
from stridewire_engine.matching.explanation import Exclusion
from stridewire_engine.matching.search import Found, Matcher
from stridewire_engine.runtime import query
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.intent import Prediction
from stridewire_engine.runtime.response import multiples
from stridewire_engine.runtime.settings import TickSettings

Sets = Mapping[int, CandidateSet]
"""The crowd's candidate sets by the number under which rows name them."""

EXCLUDED_BECAUSE = ("is playing now", "is the mirror image of what is playing now")
RECENTLY_CHOSEN = "was chosen a moment ago"


class Jumps(NamedTuple):
    """The characters that leave what they were playing, and for where; arrays of M rows."""

    characters: Indices
    """Indices of the characters in the tick's rows."""
    from_clip: Indices
    """-1 where the character begins."""
    from_time: Floats
    to_clip: Indices
    to_time: Floats
    to_row: Indices
    cost: Floats
    stay_cost: Floats
    bias: Floats
    """By how much staying had to be beaten."""
    channel_costs: Floats
    """`(M, C)`."""
    reason: Indices
    """Values of `TransitionReason`."""
    queries: Floats
    """`(M, D)` what was looked for."""
    weights: Floats
    """`(M, C)`."""
    excluded: Indices
    """`(M, E)` rows whose neighbourhood was left out: playing, its mirror image, recent ones."""
    sets: Indices
    """`(M,)` numbers of the candidate sets."""

    def take(self, which: Indices) -> "Jumps":
        """Return some of them."""
        return Jumps(**{name: array[which] for name, array in self._asdict().items()})


def due(
    state: Characters, matcher: Matcher, stands: Flags, dt: Floats, settings: TickSettings
) -> Indices:
    """Return `(N,)` the reason to search now, 0 for none; paused characters search only to begin.

    Lets the clocks of the searches run by `dt` `(N,)`; those who stand `(N,)` need none.
    """
    state.until_search -= dt
    waited = settings.search_interval - state.until_search >= settings.shortest_interval
    change = state.desired_velocity - state.searched_velocity
    turned = np.abs(wrap_angle(state.goal_yaw - state.searched_yaw))
    jumped = (np.hypot(change[:, 0], change[:, 1]) > settings.control_jump) | (
        turned > settings.facing_jump
    )
    reason = np.zeros(len(state), np.int8)
    reason[(state.until_search <= 0.0) & ~stands] = TransitionReason.BETTER_MATCH
    reason[jumped & waited] = TransitionReason.CONTROL_CHANGE
    reason[state.force_search] = TransitionReason.FORCED
    reason[_at_end(state, matcher, dt, settings)] = TransitionReason.CLIP_END
    reason[dt <= 0.0] = 0
    reason[state.clip < 0] = TransitionReason.START
    return reason


class Considered(NamedTuple):
    """What the characters that searched found, and whether they jump; arrays of M rows."""

    characters: Indices
    """Indices of the characters in the tick's rows."""
    playing: Indices
    """`(M,)` rows of the library."""
    queries: Floats
    weights: Floats
    excluded: Indices
    found: Found
    """`(M, 1)` best other moments."""
    stay_costs: Floats
    """`(M, C)` of going on, by channel, without the bias of the row that plays."""
    stay: Floats
    """`(M,)` of going on, with it."""
    bias: Floats
    """By how much staying has to be beaten."""
    reason: Indices
    jump: Flags


def choose(
    state: Characters,
    matcher: Matcher,
    sets: Sets,
    prediction: Prediction,
    reason: Indices,
    settings: TickSettings,
) -> Jumps:
    """Search for the characters that have a reason, and decide.

    A character jumps if the best other moment costs less than staying by more than the bias. At the
    end of its clip, where its filter no longer holds, and where it begins, it takes the best there
    is.

    Args:
        state: N rows; its search clocks are set anew.
        matcher: The library's.
        sets: Candidates by number.
        prediction: Where the simulated roots will be, `(N, K, …)` in the world.
        reason: `(N,)` from `due`.
        settings: Biases and intervals.
    """
    library = matcher.library
    seen = consider(state, matcher, sets, prediction, reason, settings)
    _restart_clocks(state, seen.characters, settings)
    jump = np.flatnonzero(seen.jump)
    who = seen.characters[jump]
    target = seen.found.rows[jump, 0]
    clip = library.clip_of[target]
    return Jumps(
        characters=who,
        from_clip=state.clip[who],
        from_time=state.clip_time[who],
        to_clip=clip.astype(np.int32),
        to_time=(target - library.clip_starts[clip]) / library.frame_rate,
        to_row=target,
        cost=seen.found.costs[jump, 0],
        stay_cost=seen.stay[jump],
        bias=seen.bias[jump],
        channel_costs=seen.found.channel_costs[jump, 0],
        reason=seen.reason[jump],
        queries=seen.queries[jump],
        weights=seen.weights[jump],
        excluded=seen.excluded[jump],
        sets=state.filter[who],
    )


def consider(
    state: Characters,
    matcher: Matcher,
    sets: Sets,
    prediction: Prediction,
    reason: Indices,
    settings: TickSettings,
) -> Considered:
    """Search for the characters that have a reason, and say who is to jump; nothing is changed."""
    searching = np.flatnonzero(reason)
    rows = state.borrow(searching)
    why, starting = reason[searching], rows.clip < 0
    asked = query.ask(state, searching, matcher, prediction, settings)
    playing, queries, weights, excluded, stay_costs = asked
    found, satisfied = _search(matcher, sets, rows.filter, queries, weights, excluded, playing)
    why = np.where(~satisfied & ~starting, TransitionReason.FILTER_CHANGE, why)
    stay = stay_costs.sum(axis=-1) + matcher.bias[playing]
    bias = settings.continuing_bias * matcher.typical_cost + settings.least_improvement * stay
    bias *= multiples(rows.responsiveness).bias
    must = _MUST[why]
    jump = (found.rows[:, 0] >= 0) & (must | (found.costs[:, 0] + bias < stay))
    return Considered(
        searching, playing, queries, weights, excluded, found, stay_costs, stay, bias, why, jump
    )


def exclusions(rows: Indices) -> list[Exclusion]:
    """Return what a character's excluded rows `(E,)` stand for."""
    why = (*EXCLUDED_BECAUSE, *[RECENTLY_CHOSEN] * (len(rows) - len(EXCLUDED_BECAUSE)))
    return [Exclusion(int(row), text) for row, text in zip(rows, why, strict=True) if row >= 0]


_MUST = np.isin(
    np.arange(max(TransitionReason) + 1),
    (TransitionReason.CLIP_END, TransitionReason.START, TransitionReason.FILTER_CHANGE),
)
"""By reason, whether the best there is is taken."""


def _search(
    matcher: Matcher,
    sets: Sets,
    numbers: Indices,
    queries: Floats,
    weights: Floats,
    excluded: Indices,
    playing: Indices,
) -> tuple[Found, Flags]:
    """Search once for each distinct filter; also tell whether what is playing satisfies it."""
    different = set(numbers.tolist())
    if len(different) == 1:
        among = sets[different.pop()]
        found = _search_one(matcher, among, queries, weights, excluded)
        return found, among.satisfied[playing]
    found = Found.nothing(len(queries), len(matcher.schema.channels))
    satisfied = np.ones(len(queries), np.bool_)
    for number in sorted(different):
        mine = np.flatnonzero(numbers == number)
        among = sets[number]
        found.put(mine, _search_one(matcher, among, queries[mine], weights[mine], excluded[mine]))
        satisfied[mine] = among.satisfied[playing[mine]]
    return found, satisfied


def _search_one(
    matcher: Matcher, among: CandidateSet, queries: Floats, weights: Floats, excluded: Indices
) -> Found:
    found = matcher.search(queries, weights, excluded, 1, among)
    lacking = np.flatnonzero(found.rows[:, 0] < 0)
    if len(lacking):
        # a set smaller than what is excluded: better the same again than nothing
        whole = np.full((len(lacking), 1), -1)
        found.put(lacking, matcher.search(queries[lacking], weights[lacking], whole, 1, among))
    return found


def _at_end(state: Characters, matcher: Matcher, dt: Floats, settings: TickSettings) -> Flags:
    library = matcher.library
    clip = np.maximum(state.clip, 0)
    length = (library.clip_frames[clip] - 1) / library.frame_rate
    ends = state.clip_time + dt > length - settings.clip_end_margin
    return np.asarray(ends & ~library.loops[clip])


def _restart_clocks(state: Characters, searched: Indices, settings: TickSettings) -> None:
    left = state.until_search[searched]
    # in their turn, characters keep their rhythm; forced ones, often all at once, fall apart again
    in_turn = settings.search_interval + np.maximum(left, -settings.search_interval)
    apart = settings.search_interval * (1.0 - 0.5 * state.stagger[searched])
    state.until_search[searched] = np.where(left <= 0.0, in_turn, apart)
    state.searched_velocity[searched] = state.desired_velocity[searched]
    state.searched_yaw[searched] = state.goal_yaw[searched]
    state.force_search[searched] = False
