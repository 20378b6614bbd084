"""A generator: a process that drives some of the streams and tells what it saw."""

import asyncio
import gc
import multiprocessing
from collections.abc import Coroutine, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import grpc

from stridewire._channel import CHANNEL_OPTIONS
from stridewire._event_loop import run
from stridewire_loadtest import beside
from stridewire_loadtest.scenarios import Scenario
from stridewire_loadtest.streams import DrivenStream, StreamPlan
from stridewire_loadtest.tally import Tally

_READY_S = 120.0


@dataclass(frozen=True)
class Share:
    """What one generator does."""

    address: str
    plans: Sequence[StreamPlan]
    scenario: Scenario
    goes_beside: bool
    """Whether it also does what the scenario asks for beside the streams."""


class Generators:
    """Generators that have opened their streams and wait for the begin."""

    def __init__(self, pipes: Sequence[Connection], seconds: float) -> None:
        self._pipes = pipes
        self._seconds = seconds

    def run(self, begin_s: float) -> Tally:
        """Let them drive from a time on, and return what they saw together.

        Raises:
            RuntimeError: If one of them failed.
        """
        for pipe in self._pipes:
            pipe.send(begin_s)
        total = Tally()
        for pipe in self._pipes:
            total.add(_receive(pipe, self._seconds + _READY_S))
        return total


@contextmanager
def generators(shares: Sequence[Share]) -> Iterator[Generators]:
    """Start generators, each in a process of its own, and wait until their streams are open.

    Raises:
        RuntimeError: If one of them failed, with what it said.
    """
    spawn = multiprocessing.get_context("spawn")
    pipes, processes = [], []
    for share in shares:
        ours, theirs = spawn.Pipe()
        process = spawn.Process(target=_generate, args=(share, theirs), daemon=True)
        process.start()
        pipes.append(ours)
        processes.append(process)
    try:
        for pipe in pipes:
            _receive(pipe, _READY_S)
        seconds = max(plan.warmup_s + plan.seconds for share in shares for plan in share.plans)
        yield Generators(pipes, seconds)
    finally:
        for process in processes:
            process.join(10.0)
            if process.is_alive():
                process.kill()


def _receive(pipe: Connection, timeout_s: float) -> Any:
    if not pipe.poll(timeout_s):
        raise RuntimeError(f"a generator said nothing for {timeout_s:.0f} s")
    try:
        said = pipe.recv()
    except EOFError:
        raise RuntimeError("a generator has died; see above") from None
    if isinstance(said, Exception):
        raise said
    return said


def _generate(share: Share, pipe: Connection) -> None:
    try:
        pipe.send(run(_drive(share, pipe)))
    except Exception as error:
        pipe.send(RuntimeError(f"{type(error).__name__}: {error}"))


async def _drive(share: Share, pipe: Connection) -> Tally:
    tally = Tally()
    async with grpc.aio.insecure_channel(share.address, CHANNEL_OPTIONS) as channel:
        streams = [DrivenStream(channel, plan, plan.controls(), tally) for plan in share.plans]
        for stream in streams:
            await stream.open()
        asks = await _asks(channel, share)
        guests = beside.guests_of(share.scenario, share.plans[0]) if share.goes_beside else []
        # what is made from here on dies young: a full collection would only stop the clock
        gc.collect()
        gc.freeze()
        pipe.send("ready")
        begin = await asyncio.get_running_loop().run_in_executor(None, pipe.recv)
        work: list[Coroutine[Any, Any, None]] = [stream.run(begin) for stream in streams]
        if share.goes_beside:
            work += _beside(channel, share, asks, guests, begin, tally)
        await asyncio.gather(*work)
    return tally


async def _asks(channel: Any, share: Share) -> dict[str, beside.Ask]:
    wanted = share.scenario.blends_per_s or share.scenario.searches_per_s
    if not (share.goes_beside and wanted):
        return {}
    return await beside.queries(channel)


def _beside(
    channel: Any,
    share: Share,
    asks: dict[str, beside.Ask],
    guests: Sequence[beside.Guest],
    begin: float,
    tally: Tally,
) -> list[Coroutine[Any, Any, None]]:
    plan, asked = share.plans[0], share.scenario
    start = begin + plan.warmup_s
    work: list[Coroutine[Any, Any, None]] = []
    for name, per_s in (("blend", asked.blends_per_s), ("search", asked.searches_per_s)):
        if per_s:
            work.append(beside.flood(asks[name], per_s, start, plan.seconds, tally))
    for guest in guests:
        if asked.surge:
            work.append(
                beside.surge(channel, guest, asked.surge, start + 0.4 * plan.seconds, tally)
            )
        else:
            work.append(beside.visitors(channel, guest, start + plan.seconds, tally))
    return work
