"""One stream of the generator: controls made beforehand, sent on schedule; frames tallied."""

import asyncio
import hashlib
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import grpc
import numpy as np
from grpc.aio import EOF  # type: ignore[attr-defined]

from stridewire._codec.blocks import write_blocks
from stridewire.scripts import script
from stridewire.v1 import animation_pb2 as pb
from stridewire_loadtest.scenarios import FRAME_S, RATE_HZ
from stridewire_loadtest.tally import GENERATOR_LATE_S, Tally

ANIMATE = "/stridewire.v1.AnimationService/Animate"
_SPACING_M = 3.0
_HASH_EVERY = 60
_FLAGS = [
    (1 << flag, pb.FrameFlag.Name(flag))
    for flag in (pb.FRAME_FLAG_DEGRADED, pb.FRAME_FLAG_FALLBACK)
]
_SETTLE_S = 2.0
"""How long frames are waited for after the last control."""


@dataclass(frozen=True)
class StreamPlan:
    """What a stream is to do."""

    number: int
    """Of the stream, from 0: seeds differ by it."""
    characters: int
    seconds: float
    warmup_s: float
    """Driven beforehand and not counted."""
    phase_s: float
    """Its steps are this much later than the first stream's."""
    script: str
    seed: int
    stitcher: str
    reads: bool = True

    @property
    def warmup(self) -> int:
        """Return the number of steps that are not counted."""
        return round(self.warmup_s * RATE_HZ)

    @property
    def steps(self) -> int:
        """Return the number of all steps."""
        return self.warmup + round(self.seconds * RATE_HZ)

    def opening(self) -> pb.AnimateRequest:
        """Return the message that opens the stream."""
        specs = []
        for i in range(self.characters):
            spec = pb.CharacterSpec(id=i, stitcher=self.stitcher)
            spec.root.position.x = _SPACING_M * (i % 32)
            spec.root.position.z = _SPACING_M * (i // 32)
            specs.append(spec)
        return pb.AnimateRequest(
            open=pb.Open(
                pacing=pb.PACING_CLIENT,
                characters=specs,
                detail=pb.DETAIL_EVENTS,
                seed=self.seed + self.number,
            )
        )

    def controls(self) -> list[bytes]:
        """Return the wire bytes of each step's velocities and facings."""
        named, seed = script(self.script), self.seed + 1000 * self.number
        blocks = []
        for step in range(self.steps):
            asked = named.controls(step * FRAME_S, self.characters, seed)
            message = pb.Step()
            write_blocks(message, velocity_xz=asked.velocity, facing_yaw=asked.facing)
            blocks.append(message.SerializeToString())
        return blocks


class DrivenStream:
    """A stream that is open; `run` drives it to its end."""

    def __init__(
        self, channel: Any, plan: StreamPlan, controls: Sequence[bytes], tally: Tally
    ) -> None:
        """Begin a stream.

        Args:
            channel: To the server.
            plan: What it is to do.
            controls: Of `plan.controls`, made beforehand since that takes long; at least as many
                as the plan has steps.
            tally: Takes what it sees.
        """
        self._plan = plan
        self._tally = tally
        self._controls = controls
        self._sent = np.zeros(plan.steps + 1)
        self._last_frame = 0
        self._applied = 0
        self._call = channel.stream_stream(
            ANIMATE,
            request_serializer=pb.AnimateRequest.SerializeToString,
            response_deserializer=pb.AnimateResponse.FromString,
        )()

    async def open(self) -> None:
        """Open the session.

        Raises:
            grpc.RpcError: If it is refused.
        """
        await self._call.write(self._plan.opening())
        answer = await self._call.read()
        if answer is not EOF:
            self._tally.library = answer.opened.library.name

    async def run(self, begin_s: float) -> None:
        """Drive the stream.

        Args:
            begin_s: Time of the first step on `time.perf_counter`'s clock.
        """
        counted = self._plan.steps - self._plan.warmup
        if self._plan.reads:
            self._tally.expected += counted
        begin = begin_s + self._plan.phase_s
        reading = asyncio.create_task(self._read(begin)) if self._plan.reads else None
        try:
            await self._send_all(begin)
            if reading is not None:
                await asyncio.wait({reading}, timeout=_SETTLE_S)
        except (grpc.RpcError, asyncio.InvalidStateError) as error:
            if self._plan.reads:
                self._tally.fail(error)
        finally:
            if reading is not None:
                reading.cancel()
            self._call.cancel()

    async def _send_all(self, begin: float) -> None:
        for step in range(1, self._plan.steps + 1):
            scheduled = begin + (step - 1) * FRAME_S
            await asyncio.sleep(scheduled - time.perf_counter())
            now = time.perf_counter()
            self._sent[step] = now
            if step > self._plan.warmup:
                self._tally.sending.record_value(max(1, round(1e6 * (now - scheduled))))
                self._tally.sent_late += now - scheduled > GENERATOR_LATE_S
            request = pb.AnimateRequest()
            request.step.MergeFromString(self._controls[step - 1])
            request.step.step = step
            request.step.dt_s = FRAME_S
            request.step.last_frame = self._last_frame
            request.step.client_time_s = scheduled
            await self._call.write(request)

    async def _read(self, begin: float) -> None:
        while self._applied < self._plan.steps:
            response = await self._call.read()
            now = time.perf_counter()
            if response is EOF:
                self._tally.fail("the stream ended early")
                return
            if response.HasField("frame"):
                self._take(response.frame, begin, now)
            elif response.HasField("error"):
                self._tally.counts["errors"] += 1

    def _take(self, frame: pb.Frame, begin: float, now: float) -> None:
        self._last_frame, self._applied = frame.frame, frame.applied_step
        step, plan = frame.applied_step, self._plan
        if step <= plan.warmup:
            return
        tally = self._tally
        tally.skipped += frame.dropped
        tally.note(now - begin - (step - 1) * FRAME_S, int((step - plan.warmup) * FRAME_S))
        tally.controls.record_value(max(1, round(1e6 * (now - self._sent[step]))))
        tally.characters_frames += plan.characters
        elapsed_us = max(1, round(1e3 * sum([timing.elapsed_ms for timing in frame.timings])))
        tally.ticks.record_value(elapsed_us)
        refined = self._take_transitions(frame)
        (tally.refined_ticks if refined else tally.plain_ticks).record_value(elapsed_us)
        # what dropped frames told, this one tells
        tally.counts["character_ticks"] += plan.characters * (1 + frame.dropped)
        tally.counts["searches"] += frame.searches
        for bits, name in _FLAGS:
            hit = sum([1 for flags in frame.flags if flags & bits])
            if hit:
                tally.counts[name] += hit
        if step % _HASH_EVERY == 0:
            tally.poses.setdefault(step, []).extend(_hashes(frame, plan.characters))

    def _take_transitions(self, frame: pb.Frame) -> bool:
        """Count transitions; tell whether a network was asked about one of them in this tick."""
        counts, refined = self._tally.counts, 0
        for event in frame.events:
            if not event.HasField("transition"):
                continue
            transition = event.transition
            started = transition.reason == pb.TRANSITION_REASON_START
            counts["starts" if started else "transitions"] += 1
            refined += not started and not transition.fallback
        counts["refined"] += refined
        return refined > 0 and self._plan.stitcher == "refine"


def _hashes(frame: pb.Frame, characters: int) -> list[bytes]:
    rows = np.array(frame.rotations, np.float32).reshape(characters, -1)
    return [hashlib.blake2b(row.tobytes(), digest_size=8).digest() for row in rows]
