"""Driving a session by a control script, and the figures of the run.

At wall-clock speed a frame's latency counts from the scheduled time of its control, so that a stall
is felt by every frame that it delays. Over a wire the run is open loop, too: controls go out on
time whether or not frames come back.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from stridewire._messages import Frame, Transition, TransitionReason
from stridewire._session import Session
from stridewire.motion.array_types import Floats
from stridewire.recording import Recording, toe_sliding
from stridewire.refined_share import RefinedShare
from stridewire.scripts import Controls

_SKATING_SPEED = 0.1
"""A planted toe that is faster skates; m/s."""

Control = Callable[[float], Controls]
"""From seconds since the begin to what all characters are asked to do."""


@dataclass
class Run:
    """What came of driving a session."""

    recording: Recording
    rate_hz: float
    realtime: bool
    sent: int = 0
    """Controls sent."""
    dropped: int = 0
    """Frames that the server skipped."""
    transitions: int = 0
    """Jumps within the library, beginnings not counted."""
    share: RefinedShare = field(default_factory=RefinedShare)
    """Of the transitions, how many a network refined."""
    latencies_s: list[float] = field(default_factory=list)
    """Of each frame received: from its control's scheduled time to receipt."""

    def take(self, frame: Frame, received_s: float) -> None:
        """Note a frame."""
        self.recording.add(frame)
        self.dropped += frame.dropped
        self.latencies_s.append(received_s - frame.client_time_s)
        for event in frame.events:
            self.share.take(event)
        self.transitions += sum(
            isinstance(event, Transition) and event.reason is not TransitionReason.START
            for event in frame.events
        )

    def figures(self) -> dict[str, float]:
        """Return latency and motion in numbers; late and dropped shares count missing frames."""
        latencies_ms = 1e3 * np.array(self.latencies_s)
        p50, p99 = np.percentile(latencies_ms, (50, 99))
        in_time = np.count_nonzero(latencies_ms <= 1e3 / self.rate_hz)
        frames = len(latencies_ms)
        characters = self.recording.characters
        sliding = 100.0 * self.sliding()
        return {
            "frames": frames,
            "late_pct": 100.0 * (1.0 - in_time / self.sent),
            "dropped_pct": 100.0 * (1.0 - frames / self.sent),
            "p50_ms": float(p50),
            "p99_ms": float(p99),
            "max_ms": float(latencies_ms.max()),
            "transitions": self.transitions,
            "transitions_per_s": self.transitions * self.rate_hz / self.sent / len(characters),
            "refined_pct": self.share.percent,
            "sliding_c_cm_s": float(sliding.mean()) if len(sliding) else 0.0,
            "skating_pct": (
                100.0 * float(np.mean(sliding > 100.0 * _SKATING_SPEED)) if len(sliding) else 0.0
            ),
        }

    def sliding(self) -> Floats:
        """Return the planar speeds of planted toes of all characters; m/s."""
        clips = (self.recording.clip(id, str(id), self.rate_hz) for id in self.recording.characters)
        return np.concatenate([toe_sliding(clip) for clip in clips])


def drive(
    session: Session,
    control: Control,
    seconds: float,
    *,
    rate_hz: float = 60.0,
    realtime: bool = True,
    open_loop: bool = True,
    watch: Callable[[Frame], None] = lambda frame: None,
) -> Run:
    """Drive all characters of a session with client pacing.

    Args:
        session: Just opened.
        control: Says what the characters are asked to do.
        seconds: How long, in the session's time.
        rate_hz: Steps per second.
        realtime: At wall-clock speed; else as fast as frames come, and latencies are round trips.
        open_loop: At wall-clock speed, send whether or not frames come back. A transport in this
            process makes frames only while it is sent something; there each frame is waited for.
        watch: Called with each frame.

    Raises:
        StridewireError: If the session ended early.
        TimeoutError: If no frame came in time.
    """
    run = Run(Recording(session.opened.skeleton), rate_hz, realtime)
    steps = max(1, round(seconds * rate_hz))
    send = _Sender(session, control, run)
    if realtime and open_loop:
        _drive_open_loop(session, send, steps, run, watch)
        return run
    begin = time.perf_counter()
    for number in range(steps):
        scheduled_s = _wait_until(begin + number / rate_hz) if realtime else time.perf_counter()
        send(number, scheduled_s)
        _receive(session, run, watch, send.last_step)
    return run


@dataclass
class _Sender:
    session: Session
    control: Control
    run: Run
    last_step: int = 0

    def __call__(self, number: int, scheduled_s: float) -> None:
        """Send the controls of a moment."""
        velocity, facing = self.control(number / self.run.rate_hz)
        self.last_step = self.session.control(
            velocity, facing, dt=1.0 / self.run.rate_hz, client_time_s=scheduled_s
        )
        self.run.sent += 1


def _drive_open_loop(
    session: Session, send: _Sender, steps: int, run: Run, watch: Callable[[Frame], None]
) -> None:
    failures: list[Exception] = []

    def send_all() -> None:
        begin = time.perf_counter() + 0.05
        try:
            for number in range(steps):
                send(number, _wait_until(begin + number / run.rate_hz))
        except Exception as error:  # told by the thread that waits for the frames
            failures.append(error)

    sending = threading.Thread(target=send_all, name="stridewire-send", daemon=True)
    sending.start()
    _receive(session, run, watch, steps)
    sending.join()
    if failures:
        raise failures[0]


def _receive(session: Session, run: Run, watch: Callable[[Frame], None], last_step: int) -> None:
    """Take frames up to the one of a step."""
    for frame in session.frames():
        run.take(frame, time.perf_counter())
        watch(frame)
        if frame.applied_step >= last_step:
            return


def _wait_until(scheduled_s: float) -> float:
    time.sleep(max(0.0, scheduled_s - time.perf_counter()))
    return scheduled_s
