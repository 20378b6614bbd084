"""A session on its stream: reading, pacing and writing side by side."""

import asyncio
import time
from dataclasses import replace

from stridewire._codec.requests import decode_bare_step, decode_request
from stridewire._codec.status import MAX_VIOLATIONS
from stridewire._errors import InvalidRequestError, ProtocolError, Violation
from stridewire._messages import Close, Edit, Notice, Open, Pacing, Step, StreamError
from stridewire.v1 import animation_pb2 as pb
from stridewire_engine.runtime import Session
from stridewire_server.streaming.outbox import Outbox
from stridewire_server.streaming.schedule import Schedule
from stridewire_server.streaming.wire import Wire
from stridewire_server.streaming.writer import Writer
from stridewire_server.ticker import Advanced, Ticker


class AnimateStream:
    """One open session; while a step of it waits for a tick, one message more is read at most.

    So a client that floods its stream is held back by its transport and not by memory.
    """

    def __init__(self, wire: Wire, ticker: Ticker, session: Session) -> None:
        self._wire = wire
        self._ticker = ticker
        self._runtime = ticker.runtime
        self._session = session
        self._settings = session.opened.settings
        self._outbox = Outbox(self._settings.max_frames_in_flight, ticker.metrics.dropped)
        self._loop = asyncio.get_running_loop()
        self._made = self._loop.create_future()
        """Done when no step of this stream waits for a tick any more."""
        self._made.set_result(None)
        self._overtaken = 0
        """Steps that get no frame, because a newer one came while they waited."""
        self._failed: asyncio.Future[None] = self._loop.create_future()
        self._writer = Writer(wire, self._outbox, session.opened.limits.write_timeout_s)

    def notify(self, notice: Notice) -> None:
        """Send news."""
        self._outbox.put(notice)

    async def run(self) -> None:
        """Serve until the client ends the session.

        Raises:
            ProtocolError: If a second Open comes.
            ExhaustedError: If the client does not read.
        """
        self._outbox.put(self._session.opened)
        reading = asyncio.create_task(self._read_all())
        writing = asyncio.create_task(self._writer.run())
        watching = asyncio.create_task(self._writer.watch())
        tasks: set[asyncio.Future[None]] = {reading, writing, watching, self._failed}
        if self._settings.pacing is Pacing.SERVER:
            tasks.add(asyncio.create_task(self._pace()))
        try:
            await _first_of(tasks)
            self._outbox.finish()
            await _first_of({writing, watching})
        finally:
            others = tasks - {writing}
            for task in others:
                task.cancel()
            await asyncio.gather(*others, return_exceptions=True)
            await self._writer.stop(writing)

    async def _read_all(self) -> None:
        while (request := await self._wire.read()) is not None:
            match self._decode(request):
                case Step() as step, violations:
                    await self._take_step(step, violations)
                case Edit() as edit, _:
                    # a step before it still finds the characters that it is for
                    await self._made
                    self._report(
                        0, (), await self._ticker.call(self._runtime.edit, self._session, edit)
                    )
                case Close(), _:
                    break
                case Open(), _:
                    raise ProtocolError(
                        "a second Open; a stream is one session: open another stream for another"
                    )

        # a step that waits still gets its frame
        await self._made

    def _decode(self, request: pb.AnimateRequest) -> tuple[object, tuple[Violation, ...]]:
        """Return the message; one that makes no sense loses its controls and is reported."""
        try:
            return decode_request(request), ()
        except InvalidRequestError as error:
            if request.WhichOneof("message") == "step":
                return decode_bare_step(request.step), error.violations
            self._report(0, error.violations)
            return None, ()

    async def _take_step(self, step: Step, violations: tuple[Violation, ...]) -> None:
        if wrong := self._outbox.acknowledge(step.last_frame):
            violations = (*violations, wrong)
        if step.ack_only:
            self._report(step.step, violations)
        elif self._settings.pacing is Pacing.CLIENT:
            await self._advance(step, step.step, violations)
            if not self._ticker.level:
                # what comes next may acknowledge the frame; only under load is read on
                await self._made
        else:
            error = await self._ticker.call(self._runtime.control, self._session, step)
            self._report(step.step, violations, error)

    async def _pace(self) -> None:
        """Make frames at the session's rate; time that is lost beyond the catch-up is let go."""
        period = 1.0 / self._settings.rate_hz
        schedule = Schedule(self._settings.rate_hz, time.monotonic())
        while True:
            now = time.monotonic()
            await asyncio.sleep(schedule.next_due(now) - now)
            await self._advance(period)

    async def _advance(
        self, step: Step | float, number: int = 0, violations: tuple[Violation, ...] = ()
    ) -> None:
        """Have a frame made, after the one before; what comes of it is not waited for."""

        def done(advanced: Advanced | Exception) -> None:
            if isinstance(advanced, Exception):
                _end(self._made)
                if not self._failed.done():
                    self._failed.set_exception(advanced)
                return
            frame, error = advanced
            if self._overtaken:
                frame = replace(frame, dropped=frame.dropped + self._overtaken)
                self._overtaken = 0
            self._outbox.offer(frame)
            _end(self._made)
            if violations or error is not None:
                self._report(number, violations, error)

        if not self._made.done() and isinstance(step, Step):
            wrong = self._ticker.overtake(self._session, step)
            if wrong is not False:
                self._overtaken += 1
                self._ticker.metrics.dropped()
                self._report(number, violations, wrong)
                return
        await self._made
        self._made = self._loop.create_future()
        self._ticker.advance(self._session, step, done)

    def _report(
        self, step: int, violations: tuple[Violation, ...], error: StreamError | None = None
    ) -> None:
        """Send what was wrong, if anything, as one message."""
        error = error or StreamError(step, ())
        found = (*violations, *error.violations)
        if found:
            more = error.more + max(0, len(found) - MAX_VIOLATIONS)
            self._outbox.report(replace(error, violations=found[:MAX_VIOLATIONS], more=more))


def _end(waited_for: "asyncio.Future[None]") -> None:
    """Wake those who wait; a stream that is being ended has given up."""
    if not waited_for.done():
        waited_for.set_result(None)


async def _first_of(tasks: set["asyncio.Future[None]"]) -> None:
    """Wait for the first task that ends; its error, if any, is raised."""
    done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in done:
        task.result()
