"""The server under test, in a process of its own, and what it uses up."""

import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import psutil

from stridewire.testing import server_process

_EVERY_S = 1.0


@dataclass
class Usage:
    """CPU and memory of a process over a stretch of time, a sample a second."""

    seconds: list[float] = field(default_factory=list)
    cpu_s: list[float] = field(default_factory=list)
    rss_mb: list[float] = field(default_factory=list)

    def cores(self, from_s: float, to_s: float) -> float:
        """Return the mean number of cores busy between two times since the begin."""
        inside = [i for i, at in enumerate(self.seconds) if from_s <= at <= to_s]
        if len(inside) < 2:
            return 0.0
        first, last = inside[0], inside[-1]
        passed = self.seconds[last] - self.seconds[first]
        return (self.cpu_s[last] - self.cpu_s[first]) / passed

    def growth_pct(self, from_s: float, to_s: float) -> float:
        """Return by how much memory grew between two times: means of a tenth at both ends."""
        samples = zip(self.seconds, self.rss_mb, strict=True)
        inside = [used for at, used in samples if from_s <= at <= to_s]
        if len(inside) < 2:
            return 0.0
        part = max(1, len(inside) // 10)
        before, after = sum(inside[:part]) / part, sum(inside[-part:]) / part
        return 100.0 * (after / before - 1.0)


class Served:
    """A running server."""

    def __init__(self, address: str, process: psutil.Process) -> None:
        self.address = address
        self._process = process

    @contextmanager
    def watched(self, begin_s: float) -> Iterator[Usage]:
        """Sample the process once a second while the block runs; times count from `begin_s`."""
        usage, stop = Usage(), threading.Event()

        def sample() -> None:
            while True:
                used = self._process.cpu_times()
                usage.seconds.append(time.perf_counter() - begin_s)
                usage.cpu_s.append(used.user + used.system)
                usage.rss_mb.append(self._process.memory_info().rss / 2**20)
                if stop.wait(_EVERY_S):
                    return

        thread = threading.Thread(target=sample, daemon=True)
        thread.start()
        try:
            yield usage
        finally:
            stop.set()
            thread.join()


@contextmanager
def served(libraries: Sequence[Path]) -> Iterator[Served]:
    """Run `stridewire serve` over libraries, or over the embedded one.

    Raises:
        UnavailableError: If the server ended before it was ready.
    """
    with server_process(*libraries) as (address, process):
        yield Served(address, psutil.Process(process.pid))
