"""Answers to queries: postures looked up, checked, blended."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import (
    BlendManyQuery,
    BlendMethod,
    BlendQuery,
    BlendResult,
    ClipTime,
)
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire_engine.blending.blends import Pair, blend
from stridewire_engine.blending.checks import MAX_PAIRS, MAX_WEIGHTS, check_query
from stridewire_engine.library import Library
from stridewire_engine.networks.blend import BlendNetwork, blend_network

Libraries = Callable[[str], Library]
"""Returns an open library by name, empty for the default; raises `NotFoundError`."""

_OTHER_SKELETON = "the network knows the reference skeleton only; these postures have another"


def answer(libraries: Libraries, query: BlendQuery) -> BlendResult:
    """Blend one pair.

    Raises:
        InvalidRequestError: If a field is not allowed.
        NotFoundError: If there is no such library or clip.
        ModelError: If the network is damaged.
    """
    return _answer(libraries, [("", query)])[0]


def answer_many(libraries: Libraries, query: BlendManyQuery) -> tuple[BlendResult, ...]:
    """Blend many pairs in one pass.

    Raises:
        InvalidRequestError: If a field is not allowed.
        NotFoundError: If there is no such library or clip.
        ModelError: If the network is damaged.
    """
    count = len(query.requests)
    if not 1 <= count <= MAX_PAIRS:
        raise InvalidRequestError.of(
            Violation("requests", f"{count} pairs; allowed are 1 to {MAX_PAIRS}")
        )
    total = sum(len(one.weights) for one in query.requests)
    if total > MAX_WEIGHTS:
        raise InvalidRequestError.of(
            Violation("requests", f"{total} weights in all; allowed are {MAX_WEIGHTS}")
        )
    named = [(f"requests[{i}].", one) for i, one in enumerate(query.requests)]
    return tuple(_answer(libraries, named))


def _answer(libraries: Libraries, queries: Sequence[tuple[str, BlendQuery]]) -> list[BlendResult]:
    skeleton = _skeleton(libraries, queries)
    wrong = [v for path, query in queries for v in check_query(path, query, skeleton)]
    wrong += _needing_the_network(queries, skeleton)
    if wrong:
        raise InvalidRequestError.of(*wrong)
    pairs = [_pair(libraries, path, query, skeleton) for path, query in queries]
    network, reason = _network(pairs, skeleton)
    return [
        BlendResult(blended.pose, blended.method, blended.reason)
        for blended in blend(pairs, network, reason)
    ]


def _skeleton(libraries: Libraries, queries: Sequence[tuple[str, BlendQuery]]) -> Skeleton:
    """Return the one skeleton of all postures; inline ones have the default library's."""
    found: dict[Skeleton, str] = {}
    for path, query in queries:
        for side, source in (("start", query.start), ("end", query.end)):
            name = source.library if isinstance(source, ClipTime) else ""
            found.setdefault(libraries(name).skeleton, f"{path}{side}")
    skeleton, *others = found
    if others:
        raise InvalidRequestError.of(
            Violation(found[others[0]], "of another skeleton than the first posture; blend alike")
        )
    return skeleton


def _needing_the_network(
    queries: Sequence[tuple[str, BlendQuery]], skeleton: Skeleton
) -> Iterator[Violation]:
    if skeleton != REFERENCE:
        for path, query in queries:
            if query.method is BlendMethod.NEURAL:
                yield Violation(f"{path}method", f"NEURAL, but {_OTHER_SKELETON}; ask for AUTO")


def _network(pairs: Sequence[Pair], skeleton: Skeleton) -> tuple[BlendNetwork | None, str]:
    if all(pair.method is BlendMethod.SLERP for pair in pairs):
        return None, ""
    return (blend_network(), "") if skeleton == REFERENCE else (None, _OTHER_SKELETON)


def _pair(libraries: Libraries, path: str, query: BlendQuery, skeleton: Skeleton) -> Pair:
    start = _pose(libraries, f"{path}start.clip", query.start)
    end = _pose(libraries, f"{path}end.clip", query.end)
    duration = query.duration_s
    if isinstance(query.start, ClipTime) and isinstance(query.end, ClipTime):
        if _clip(libraries, query.start) != _clip(libraries, query.end):
            # two clips have nothing to do with each other's space
            end = replace(end, root_position=start.root_position, root_rotation=start.root_rotation)
        elif not duration:
            duration = max(query.end.time_s - query.start.time_s, 0.0)
    shares = np.array([query.joint_mask.get(name, 1.0) for name in skeleton.names])
    weights = np.asarray(query.weights, np.float64)
    return Pair(start, end, weights, shares, query.method, query.ground_height, duration)


def _clip(libraries: Libraries, moment: ClipTime) -> tuple[str, str]:
    return libraries(moment.library).name, moment.clip


def _pose(libraries: Libraries, path: str, source: ClipTime | Pose) -> Pose:
    if isinstance(source, Pose):
        return source
    clip = libraries(source.library).clip(source.clip)
    if not 0.0 <= source.time_s <= clip.seconds:
        raise InvalidRequestError.of(
            Violation(
                f"{path}.time_s",
                f"{source.time_s} s; clip {source.clip!r} lasts from 0 to {clip.seconds:.3f} s",
            )
        )
    return clip.sample(source.time_s)
