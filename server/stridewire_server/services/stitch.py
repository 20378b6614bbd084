"""StitchService: one motion out of several clips."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from stridewire._codec import stitches as codec
from stridewire._errors import ExhaustedError
from stridewire.v1 import stitch_pb2 as pb
from stridewire.v1.stitch_pb2_grpc import StitchServiceServicer
from stridewire_engine.answering import answer_parts
from stridewire_engine.runtime import Runtime

T = TypeVar("T")

_PLACES = 4
"""Requests at the same time: each holds its motion in memory."""


class StitchService(StitchServiceServicer):
    """Answers "make one natural motion of these", in a thread of its own.

    Ticks do not wait for it. Requests take turns part by part; one that is given up ends with the
    part that is being made.
    """

    def __init__(self, runtime: Runtime) -> None:
        self._runtime = runtime
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="stridewire-stitch")
        self._places = _PLACES

    async def Stitch(self, request: pb.StitchRequest, context: Any) -> None:
        """Stitch clips; parts are sent as they become final."""
        if not self._places:
            raise ExhaustedError(
                f"{_PLACES} motions are being stitched; try again later", retry_after_s=1.0
            )
        self._places -= 1
        try:
            parts = await self._call(
                lambda: answer_parts(self._runtime, codec.decode_stitch(request))
            )
            while (part := await self._call(lambda: next(parts, None))) is not None:
                await context.write(codec.encode_part(part))
        finally:
            self._places += 1

    def shut_down(self) -> None:
        """End the thread after the part that is being made."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    async def _call(self, function: Callable[[], T]) -> T:
        return await asyncio.wrap_future(self._thread.submit(function))
