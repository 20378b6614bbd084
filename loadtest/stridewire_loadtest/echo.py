"""An empty gRPC echo, driven like streams: what the transport alone costs here."""

import asyncio
import multiprocessing
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from typing import Any

import grpc
import psutil
from grpc.aio import EOF  # type: ignore[attr-defined]

from stridewire._event_loop import run
from stridewire_loadtest.scenarios import FRAME_S

_METHOD = "/stridewire.loadtest.Echo/Stream"
_PAYLOAD = b"\0" * 16


def echo_cpu_s(streams: int, seconds: float) -> float:
    """Return the server CPU time of one echoed message at 60 a second on each of N streams."""
    with _echo_server() as (address, process):
        run(_drive(address, streams, 1.0))
        before = process.cpu_times()
        messages = run(_drive(address, streams, seconds))
        after = process.cpu_times()
    return (after.user + after.system - before.user - before.system) / messages


@contextmanager
def _echo_server() -> Iterator[tuple[str, psutil.Process]]:
    spawn = multiprocessing.get_context("spawn")
    ours, theirs = spawn.Pipe()
    process = spawn.Process(target=_serve, args=(theirs,), daemon=True)
    process.start()
    try:
        yield f"127.0.0.1:{ours.recv()}", psutil.Process(process.pid)
    finally:
        process.terminate()
        process.join(5.0)


def _serve(pipe: Connection) -> None:
    async def serve() -> None:
        server = grpc.aio.server()
        handler = grpc.stream_stream_rpc_method_handler(_echo)
        service, method = _METHOD[1:].split("/")
        server.add_generic_rpc_handlers(
            (grpc.method_handlers_generic_handler(service, {method: handler}),)
        )
        pipe.send(server.add_insecure_port("127.0.0.1:0"))
        await server.start()
        await server.wait_for_termination()

    run(serve())


async def _echo(request: Any, context: Any) -> None:
    while (message := await context.read()) is not EOF:
        await context.write(message)


async def _drive(address: str, streams: int, seconds: float) -> int:
    async with grpc.aio.insecure_channel(address) as opened:
        channel: Any = opened
        calls = [channel.stream_stream(_METHOD)() for _ in range(streams)]
        begin = time.perf_counter() + 0.2
        driven = [
            _send(call, begin + FRAME_S * number / streams, round(seconds / FRAME_S))
            for number, call in enumerate(calls)
        ]
        return sum(await asyncio.gather(*driven))


async def _send(call: Any, begin: float, count: int) -> int:
    async def read() -> None:
        for _ in range(count):
            await call.read()

    reading = asyncio.create_task(read())
    for number in range(count):
        await asyncio.sleep(begin + number * FRAME_S - time.perf_counter())
        await call.write(_PAYLOAD)
    await reading
    call.cancel()
    return count
