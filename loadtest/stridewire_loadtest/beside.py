"""What goes on beside the streams that are measured: queries, visitors, surges."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import grpc
import numpy as np

from stridewire.v1 import blend_pb2, library_pb2, match_pb2
from stridewire_loadtest.scenarios import Scenario
from stridewire_loadtest.streams import DrivenStream, StreamPlan
from stridewire_loadtest.tally import Tally

_TIMEOUT_S = 5.0
_VISITOR_S = (1.0, 5.0)
_VISITOR_CHARACTERS = 4
_SURGE_STAY_S = 0.05

Ask = Callable[[int], Awaitable[Any]]


async def flood(ask: Ask, per_s: float, begin_s: float, seconds: float, tally: Tally) -> None:
    """Send queries on schedule, whether or not the ones before are answered.

    Args:
        ask: Sends the query of a number.
        per_s: Queries a second.
        begin_s: Time of the first on `time.perf_counter`'s clock.
        seconds: How long.
        tally: Takes their latencies, from the scheduled time.
    """
    pending = set()
    for number in range(round(seconds * per_s)):
        scheduled = begin_s + number / per_s
        await asyncio.sleep(scheduled - time.perf_counter())
        task = asyncio.create_task(_timed(ask(number), scheduled, tally))
        pending.add(task)
        task.add_done_callback(pending.discard)
    if pending:
        await asyncio.wait(pending)


async def _timed(answer: Awaitable[Any], scheduled: float, tally: Tally) -> None:
    try:
        await answer
    except grpc.RpcError as error:
        tally.fail(error)
        return
    tally.queries.record_value(max(1, round(1e6 * (time.perf_counter() - scheduled))))


async def queries(channel: Any) -> dict[str, Ask]:
    """Return askers by name: `blend` and `search`, over moments of the library's first clips."""
    listing = library_pb2.ListClipsRequest(page_size=64)
    list_clips = channel.unary_unary(
        "/stridewire.v1.LibraryService/ListClips",
        request_serializer=library_pb2.ListClipsRequest.SerializeToString,
        response_deserializer=library_pb2.ListClipsResponse.FromString,
    )
    clips = (await list_clips(listing, timeout=_TIMEOUT_S)).clips
    find = channel.unary_unary(
        "/stridewire.v1.MatchService/Search",
        request_serializer=match_pb2.SearchRequest.SerializeToString,
        response_deserializer=match_pb2.SearchResponse.FromString,
    )
    blend = channel.unary_unary(
        "/stridewire.v1.BlendService/Blend",
        request_serializer=blend_pb2.BlendRequest.SerializeToString,
        response_deserializer=blend_pb2.BlendResponse.FromString,
    )

    def search(number: int) -> Awaitable[Any]:
        clip = clips[number % len(clips)]
        request = match_pb2.SearchRequest(k=5)
        request.pose.clip.clip = clip.name
        request.pose.clip.time_s = 0.5 * clip.seconds
        answer: Awaitable[Any] = find(request, timeout=_TIMEOUT_S)
        return answer

    def between(number: int) -> Awaitable[Any]:
        clip = clips[number % len(clips)]
        request = blend_pb2.BlendRequest(weights=np.linspace(0.0, 1.0, 11).tolist())
        request.start.clip.clip = request.end.clip.clip = clip.name
        request.end.clip.time_s = min(0.5, clip.seconds)
        answer: Awaitable[Any] = blend(request, timeout=_TIMEOUT_S)
        return answer

    return {"search": search, "blend": between}


@dataclass(frozen=True)
class Guest:
    """Somebody who comes for a while, with controls made beforehand for the longest stay."""

    plan: StreamPlan
    controls: Sequence[bytes]

    def staying(self, seconds: float, number: int) -> "Guest":
        """Return one who stays for less long and opens a stream of another number."""
        return replace(self, plan=replace(self.plan, seconds=seconds, number=number))


def guests_of(scenario: Scenario, plan: StreamPlan) -> list[Guest]:
    """Return the visitors of a scenario, or the one of whom a surge is made.

    Args:
        scenario: With one of both, or neither.
        plan: Of the streams beside them.
    """
    stay, characters = (
        (_SURGE_STAY_S, 1) if scenario.surge else (_VISITOR_S[1], _VISITOR_CHARACTERS)
    )
    plans = [
        replace(plan, number=1_000 + i, characters=characters, seconds=stay, warmup_s=0.0)
        for i in range(scenario.churn + bool(scenario.surge))
    ]
    return [Guest(plan, plan.controls()) for plan in plans]


async def visitors(channel: Any, guest: Guest, end_s: float, tally: Tally) -> None:
    """Come, be driven for a few seconds, leave; every other one vanishes in the middle."""
    lots = np.random.default_rng(guest.plan.seed + guest.plan.number)
    number, own = 0, Tally()
    while time.perf_counter() < end_s - _VISITOR_S[1]:
        one = guest.staying(float(lots.uniform(*_VISITOR_S)), guest.plan.number + 100 * number)
        await visit(channel, one, own, number % 2)
        number += 1
    _add_guests(tally, own)


async def visit(channel: Any, guest: Guest, own: Tally, vanish: int = 0) -> None:
    """Open a stream and drive it."""
    own.counts["visits"] += 1
    try:
        stream = DrivenStream(channel, guest.plan, guest.controls, own)
        await stream.open()
        running = asyncio.create_task(stream.run(time.perf_counter()))
        if vanish:
            await asyncio.sleep(0.5 * guest.plan.seconds)
            running.cancel()
        await asyncio.gather(running, return_exceptions=True)
    except grpc.RpcError as error:
        own.fail(error)


async def surge(channel: Any, guest: Guest, count: int, at_s: float, tally: Tally) -> None:
    """Open many streams within one second; each takes a few frames and leaves."""
    own = Tally()
    await asyncio.sleep(at_s - time.perf_counter())
    visits = []
    for number in range(count):
        await asyncio.sleep(at_s + number / count - time.perf_counter())
        one = guest.staying(_SURGE_STAY_S, 10_000 + number)
        visits.append(asyncio.create_task(visit(channel, one, own)))
    await asyncio.gather(*visits)
    _add_guests(tally, own)


def _add_guests(tally: Tally, own: Tally) -> None:
    """Count what guests saw: not their frames' times, but whether they were refused."""
    tally.refused += own.refused
    tally.examples = (tally.examples + own.examples)[:5]
    tally.counts["visits"] += own.counts["visits"]
    tally.counts["visitor_frames"] += own.received
