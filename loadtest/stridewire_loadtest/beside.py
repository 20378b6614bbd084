"""What goes on beside the streams that are measured: queries, visitors, surges."""

import asyncio
import time
from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Any

import grpc
import numpy as np

from stridewire.v1 import blend_pb2, library_pb2, match_pb2
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


async def queries(channel: Any, library: str) -> dict[str, Ask]:
    """Return askers by name: `blend` and `search`, over moments of a library's first clips."""
    listing = library_pb2.ListClipsRequest(library=library, page_size=64)
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
        request = match_pb2.SearchRequest(library=library, k=5)
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


async def visitors(channel: Any, plan: StreamPlan, begin_s: float, tally: Tally) -> None:
    """Come, be driven for a few seconds, leave; every other one vanishes in the middle."""
    lots = np.random.default_rng(plan.seed + plan.number)
    end = begin_s + plan.warmup_s + plan.seconds
    number = 0
    while time.perf_counter() < end - _VISITOR_S[1]:
        stay = float(lots.uniform(*_VISITOR_S))
        short = replace(plan, characters=_VISITOR_CHARACTERS, seconds=stay, warmup_s=0.0)
        await visit(channel, replace(short, number=plan.number + 100 * number), tally, number % 2)
        number += 1


async def visit(channel: Any, plan: StreamPlan, tally: Tally, vanish: int = 0) -> None:
    """Open a stream and drive it; its frames are not counted, its refusals are."""
    own = Tally()
    try:
        stream = DrivenStream(channel, plan, own)
        await stream.open()
        running = asyncio.create_task(stream.run(time.perf_counter()))
        if vanish:
            await asyncio.sleep(0.5 * plan.seconds)
            running.cancel()
        await asyncio.gather(running, return_exceptions=True)
    except grpc.RpcError as error:
        tally.fail(error)
    tally.refused += own.refused
    tally.counts["visits"] += 1
    tally.counts["visitor_frames"] += own.received


async def surge(channel: Any, plan: StreamPlan, count: int, begin_s: float, tally: Tally) -> None:
    """Open many streams within one second, in the middle; each takes a few frames and leaves."""
    at = begin_s + plan.warmup_s + 0.4 * plan.seconds
    await asyncio.sleep(at - time.perf_counter())
    visits = []
    for number in range(count):
        await asyncio.sleep(at + number / count - time.perf_counter())
        short = replace(
            plan, number=10_000 + number, characters=1, seconds=_SURGE_STAY_S, warmup_s=0.0
        )
        visits.append(asyncio.create_task(visit(channel, short, tally)))
    await asyncio.gather(*visits)
