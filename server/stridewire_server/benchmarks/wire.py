"""Benchmarks of the wire: encoding a frame, beside an empty message over gRPC."""

import asyncio
import time
from collections.abc import Iterator
from statistics import median
from typing import Any

import grpc
import numpy as np
from grpc.aio import EOF  # type: ignore[attr-defined]

from stridewire._codec.responses import response_bytes
from stridewire._messages import Frame
from stridewire_server.benchmarks.comparison import Compared, compare

_METHOD = "/stridewire.benchmark.Echo/Stream"
_MESSAGES = 200


def encode(joints: int, rounds: int, sizes: tuple[int, ...]) -> Iterator[Compared]:
    """Compare encoding a frame of so many joints a character with an empty gRPC echo."""
    echo = asyncio.run(_echo_us(rounds))
    for size in sizes:
        frame = _frame(size, joints)
        value, _ = compare(
            lambda frame=frame: response_bytes(frame),  # type: ignore[misc]
            lambda: None,
            rounds,
        )
        yield Compared("encode", f"{size} characters", "us a frame", "empty gRPC echo", value, echo)


def _frame(size: int, joints: int) -> Frame:
    rng = np.random.default_rng(0)

    def block(*shape: int) -> Any:
        return rng.normal(size=(size, *shape)).astype(np.float32)

    return Frame(
        frame=1,
        applied_step=1,
        time_s=0.0,
        client_time_s=0.0,
        characters=np.arange(size, dtype=np.uint32),
        root=block(7),
        root_delta=block(4),
        hips=block(3),
        rotations=block(joints, 4),
        contacts=np.zeros(size, np.uint32),
        foot_targets=block(2, 3),
        flags=np.zeros(size, np.uint32),
        events=(),
    )


async def _echo_us(rounds: int) -> float:
    """Return the processor time of an empty message to a server and back, both sides together."""
    server = grpc.aio.server()
    service, method = _METHOD[1:].split("/")
    handler = grpc.stream_stream_rpc_method_handler(_echo)
    server.add_generic_rpc_handlers(
        (grpc.method_handlers_generic_handler(service, {method: handler}),)
    )
    port = server.add_insecure_port("127.0.0.1:0")
    await server.start()
    async with grpc.aio.insecure_channel(f"127.0.0.1:{port}") as opened:
        channel: Any = opened
        call = channel.stream_stream(_METHOD)()
        taken = []
        for _ in range(rounds + 1):
            begin = time.process_time()
            for _ in range(_MESSAGES):
                await call.write(b"")
                await call.read()
            taken.append(1e6 * (time.process_time() - begin) / _MESSAGES)
        call.cancel()
    await server.stop(None)
    return median(taken[1:])


async def _echo(_request: Any, context: Any) -> None:
    while (message := await context.read()) is not EOF:
        await context.write(message)
