"""Blends over gRPC for `make show-blend`: how long they take, what bad input gives."""

import asyncio
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import grpc
import numpy as np
from points import Point

from stridewire import Client, ClipTime
from stridewire.v1 import blend_pb2 as pb
from stridewire.v1 import pose_pb2
from stridewire.v1.blend_pb2_grpc import BlendServiceStub
from stridewire_engine.building import open_library
from stridewire_engine.runtime import Runtime
from stridewire_server.server import AnimationServer
from stridewire_server.settings import ServerSettings

CALLS = 500
CLIP = "walk-1.4"


@contextmanager
def serving() -> Iterator[str]:
    """Serve the embedded library in a thread; yields the address."""
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()

    async def start() -> tuple[AnimationServer, str]:
        server = AnimationServer(Runtime([open_library()]), ServerSettings("127.0.0.1:0"))
        return server, await server.start()

    server, address = asyncio.run_coroutine_threadsafe(start(), loop).result()
    try:
        yield address
    finally:
        asyncio.run_coroutine_threadsafe(server.stop(), loop).result()
        loop.call_soon_threadsafe(loop.stop)
        thread.join()


def unary() -> Iterator[Point]:
    """Time unary calls from start to end, five postures each."""
    with serving() as address, Client(address) as client:
        times = []
        for i in range(CALLS):
            at = 0.1 + 0.003 * i
            began = time.perf_counter()
            client.blend(ClipTime(CLIP, at), ClipTime(CLIP, at + 0.5), (0.0, 0.25, 0.5, 0.75, 1.0))
            times.append(time.perf_counter() - began)
    p50, p99 = 1e3 * np.percentile(times, (50, 99))
    yield Point("a unary Blend of 5 postures over gRPC", f"p50 {p50:.2f} ms, p99 {p99:.2f} ms")


def bad_input() -> Iterator[Point]:
    """Bad input is INVALID_ARGUMENT or NOT_FOUND and names the field."""
    with serving() as address, grpc.insecure_channel(address) as channel:
        stub = BlendServiceStub(channel)
        for what, request, code, field in _cases():
            answered, details = _call(stub, request)
            passed = answered == code and field in details
            yield Point(what, f"{answered}: {details[:60]}", f"{code} naming {field}", passed)


def _call(stub: Any, request: pb.BlendRequest) -> tuple[str, str]:
    try:
        stub.Blend(request, timeout=30.0)
    except grpc.RpcError as error:
        return error.code().name, error.details()
    return "OK", ""


def _cases() -> Iterator[tuple[str, pb.BlendRequest, str, str]]:
    invalid, absent = "INVALID_ARGUMENT", "NOT_FOUND"
    turns, tail = "end.inline.rotations", {"Tail": 1.0}
    yield "a weight above 1", _request(weights=[0.0, 1.1]), invalid, "weights[1]"
    yield "a weight that is NaN", _request(weights=[float("nan")]), invalid, "weights[0]"
    yield "10,001 weights", _request(weights=[0.5] * 10_001), invalid, "weights"
    yield "no weight", _request(weights=[]), invalid, "weights"
    yield (
        "an unknown joint in the mask",
        _request(joint_mask=tail),
        invalid,
        "joint_mask[Tail]",
    )
    yield "an unknown clip", _request(end=_moment(clip="nobody")), absent, "nobody"
    yield "an unknown library", _request(end=_moment(library="nowhere")), absent, "nowhere"
    yield "a time after the clip", _request(end=_moment(time_s=1e5)), invalid, "end.clip.time_s"
    yield "no end", _request(end=pose_pb2.PoseSource()), invalid, "end"
    yield (
        "a rotation of length 2",
        _request(end=_inline(scale=2.0)),
        invalid,
        "end.inline.rotations",
    )
    yield (
        "a rotation that is NaN",
        _request(end=_inline(scale=np.nan)),
        invalid,
        "end.inline.rotations",
    )
    yield "a joint too few", _request(end=_inline(joints=21)), invalid, turns


def _request(**changes: Any) -> pb.BlendRequest:
    given = {"start": _moment(), "end": _moment(time_s=1.5), "weights": [0.5], **changes}
    return pb.BlendRequest(**given)


def _moment(clip: str = CLIP, time_s: float = 1.0, library: str = "") -> pose_pb2.PoseSource:
    return pose_pb2.PoseSource(clip=pose_pb2.ClipTime(clip=clip, time_s=time_s, library=library))


def _inline(joints: int = 22, scale: float = 1.0) -> pose_pb2.PoseSource:
    poses = pose_pb2.Poses(
        frames=1,
        root=[0, 0, 0, 1, 0, 0, 0],
        hips=[0, 0.95, 0],
        rotations=[scale, 0, 0, 0] * joints,
    )
    return pose_pb2.PoseSource(inline=poses)
