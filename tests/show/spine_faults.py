"""What `make show-spine` shows of stalled and vanished clients and of bad input."""

import json
import queue
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import grpc
import numpy as np
from points import ROOT, Point

from stridewire import Client, Pacing
from stridewire._messages import FrameFlag
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub

_BAD_INPUT = {
    "control before Open": "test_bad_input.py::test_what_cannot_begin_ends_with_a_status",
    "second Open": "test_bad_input.py::test_what_cannot_begin_ends_with_a_status",
    "zero and too many characters": "test_bad_input.py::test_what_cannot_begin_ends_with_a_status",
    "NaN velocity or root": "test_bad_input.py::test_a_bad_control_is_refused_in_the_stream",
    "NaN or negative dt": "test_bad_input.py::test_a_bad_control_is_refused_in_the_stream",
    "unknown id": "test_bad_input.py::test_a_bad_control_is_refused_in_the_stream",
    "unknown library": "test_bad_input.py::test_what_cannot_begin_ends_with_a_status",
    "oversized message": "test_bad_input.py::test_an_oversized_message_exhausts_the_limit",
    "malformed BVH": "../unit/formats",
    "unknown skeleton": "../unit/building",
}
_LATE_S = 1.0 / 60.0


@dataclass
class _Server:
    address: str
    process: "subprocess.Popen[str]"

    def rss_mb(self) -> float:
        """Return the resident memory of the server's process."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        line = next(line for line in status.splitlines() if line.startswith("VmRSS"))
        return int(line.split()[1]) / 1024


@contextmanager
def _server() -> Iterator[_Server]:
    command = [sys.executable, "-m", "stridewire", "serve", "--address", "127.0.0.1:0", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield _Server(json.loads(process.stdout.readline())["address"], process)
        process.terminate()


def stalled() -> Iterator[Point]:
    """Hold bounded memory, give the latest frame, count dropped ones; neighbours stay on time."""
    requests: queue.Queue[pb.AnimateRequest] = queue.Queue()
    specs = [pb.CharacterSpec(id=i) for i in range(256)]
    requests.put(
        pb.AnimateRequest(open=pb.Open(characters=specs, pacing=pb.PACING_SERVER, rate_hz=60.0))
    )
    with _server() as server, grpc.insecure_channel(server.address) as channel:
        call = AnimationServiceStub(channel).Animate(iter(requests.get, None))
        frames = (r.frame for r in call if r.WhichOneof("message") == "frame")
        *_, last = islice(frames, 30)
        with Client(server.address) as client:
            _neighbour(client, 1.0)
            before = server.rss_mb()
            late, dropped = _neighbour(client, 10.0)
        grown = server.rss_mb() - before
        requests.put(pb.AnimateRequest(step=pb.Step(ack_only=True, last_frame=last.frame)))
        after = next(frames)
        call.cancel()
    text = f"{grown:+.1f} MB in 10 s of 256 characters unread (390 MB of frames)"
    yield Point("memory beside a stalled client", text, "bounded", grown < 8.0)
    skipped = after.frame - last.frame - 1
    text = f"frame {last.frame}, then {after.frame}; {after.dropped} dropped"
    newest = after.dropped == skipped > 500
    yield Point("the latest frame wins, dropped ones counted", text, "it does", newest)
    text = f"{late:.2f} % late, {dropped} dropped"
    yield Point("a neighbour's frames meanwhile", text, "on time", late < 1.0 and dropped == 0)


def vanished() -> Iterator[Point]:
    """End a killed client's session within 2 s; neighbours' frames stay on time."""
    driver = (
        "import sys; from stridewire import Client, Pacing\n"
        "with Client(sys.argv[1]) as c, c.open_session(8, pacing=Pacing.SERVER) as s:\n"
        "    [print(f.frame, flush=True) for f in s.frames()]"
    )
    with _server() as server, Client(server.address) as client:
        command = [sys.executable, "-c", driver, server.address]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:
            assert other.stdout is not None
            other.stdout.readline()
            other.kill()
        start = time.monotonic()
        while client.info().sessions and time.monotonic() - start < 10.0:
            time.sleep(0.01)
        gone = time.monotonic() - start
        late, dropped = _neighbour(client, 3.0)
    yield Point("a killed client's session is gone", f"{gone:.2f} s", "within 2 s", gone < 2.0)
    text = f"{late:.2f} % late, {dropped} dropped"
    yield Point("a neighbour's frames after it", text, "on time", late < 1.0 and dropped == 0)


def bad_input() -> Iterator[Point]:
    """Refuse each bad input, with a test; hold one bad control among 256 characters alone."""
    for what, where in _BAD_INPUT.items():
        node = str((ROOT / "tests" / "integration" / where).resolve())
        run = subprocess.run(
            [sys.executable, "-m", "pytest", node],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
        summary = run.stdout.strip().splitlines()[-1]
        yield Point(what, f"{where}: {summary}", "a test passes", run.returncode == 0)
    with _server() as server, Client(server.address) as client:
        yield from _one_bad_control(client)


def _one_bad_control(client: Client) -> Iterator[Point]:
    velocity = np.tile([1.4, 0.0], (256, 1))
    velocity[99] = [np.nan, 0.0]
    with client.open_session(256) as session:
        for i in range(180):
            frame = session.step(velocity=velocity)
            if i == 0:
                begin, held = frame, frame.flagged(FrameFlag.HELD).tolist()
    moved = np.linalg.norm(frame.root[:, :3] - begin.root[:, :3], axis=1)
    others = np.delete(moved, 99)
    text = f"held {held}; it moved {moved[99]:.2f} m, the others {others.min():.2f} m and more"
    passed = held == [int(begin.characters[99])] and moved[99] < 0.3 and others.min() > 1.0
    yield Point("one bad control among 256", text, "it holds, the others move", passed)


def _neighbour(client: Client, seconds: float) -> tuple[float, int]:
    """Stream one character at 60 fps; return the share of late frames, in %, and the dropped."""
    with client.open_session(pacing=Pacing.SERVER) as session:
        arrivals, dropped = [], 0
        for frame in islice(session.frames(), round(seconds * 60)):
            arrivals.append(time.monotonic() - frame.time_s)
            dropped += frame.dropped
    # the quickest frame marks the schedule
    delay = np.array(arrivals) - min(arrivals)
    return 100.0 * float(np.mean(delay > _LATE_S)), dropped
