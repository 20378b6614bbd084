"""Metrics: what an operator watches, in Prometheus' text format at `http://HOST:PORT/metrics`.

A tick only adds a few numbers; what is served is made of them when somebody asks. Nothing is
labelled by session or character, so that the number of series stays what it is.
"""

from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import accumulate
from wsgiref.simple_server import WSGIServer

from prometheus_client import (
    CollectorRegistry,
    PlatformCollector,
    ProcessCollector,
    start_http_server,
)
from prometheus_client.metrics_core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    Metric,
)
from prometheus_client.registry import Collector

_BOUNDS_MS = (0.25, 0.5, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 16.67, 20, 33.3, 66.7, 133)
"""Dense below a frame at 60 a second, then by frames."""
_GAUGES = {
    "sessions": "Open sessions",
    "characters": "Characters in them",
    "strain_level": "By how many levels the runtime gives way to load",
}
_COUNTERS = {
    "frames": "Frames made, one a session and tick",
    "frames_dropped": "Frames that slow readers did not get, the latest winning",
    "frames_degraded": "Frames made while the runtime gave way to load",
}


class Metrics(Collector):
    """The figures of one process."""

    def __init__(self) -> None:
        self._numbers: Counter[str] = Counter()
        self._stages_s: dict[str, float] = {}
        self._ticks = [0] * (len(_BOUNDS_MS) + 1)
        self._ticks_s = 0.0
        self._server: WSGIServer | None = None

    def serve(self, address: str) -> str:
        """Answer at `host:port` from a thread of its own; returns the address with its port.

        Raises:
            ValueError: If the address cannot be listened on.
        """
        registry = CollectorRegistry()
        registry.register(self)
        ProcessCollector(registry=registry)
        PlatformCollector(registry=registry)
        host, _, port = address.rpartition(":")
        try:
            self._server, _ = start_http_server(int(port), host or "127.0.0.1", registry)
        except OSError as error:
            raise ValueError(
                f"cannot listen on {address} for metrics: is the port taken? Give another"
            ) from error
        return f"{host}:{self._server.server_port}"

    def stop(self) -> None:
        """Answer no more."""
        if self._server is not None:
            self._server.shutdown()
            self._server.server_close()

    def ticked(
        self, seconds: float, frames: int, level: int, stages_ms: Mapping[str, float]
    ) -> None:
        """Take note of a tick.

        Args:
            seconds: That it took.
            frames: That it made.
            level: By which the runtime gave way in it.
            stages_ms: Milliseconds by stage.
        """
        self._ticks[bisect_left(_BOUNDS_MS, 1e3 * seconds)] += 1
        self._ticks_s += seconds
        numbers = self._numbers
        numbers["frames"] += frames
        numbers["strain_level"] = level
        if level:
            numbers["frames_degraded"] += frames
        for stage, elapsed in stages_ms.items():
            self._stages_s[stage] = self._stages_s.get(stage, 0.0) + 1e-3 * elapsed

    def dropped(self) -> None:
        """Take note of a frame that a slow reader did not get."""
        self._numbers["frames_dropped"] += 1

    def populated(self, sessions: int, characters: int) -> None:
        """Take note of how many sessions and characters there are now."""
        self._numbers["sessions"], self._numbers["characters"] = sessions, characters

    def collect(self) -> Iterator[Metric]:
        """Yield what is served."""
        counts = accumulate(self._ticks)
        bounds = [f"{1e-3 * bound:g}" for bound in _BOUNDS_MS] + ["+Inf"]
        yield HistogramMetricFamily(
            "stridewire_tick_seconds",
            "Time that a tick takes, for all sessions that are due together",
            buckets=list(zip(bounds, counts, strict=True)),
            sum_value=self._ticks_s,
        )
        stages = CounterMetricFamily(
            "stridewire_stage_seconds", "Time that the stages of ticks took", labels=["stage"]
        )
        for stage, seconds in self._stages_s.items():
            stages.add_metric([stage], seconds)
        yield stages
        for name, told in _COUNTERS.items():
            yield CounterMetricFamily(f"stridewire_{name}", told, value=self._numbers[name])
        for name, told in _GAUGES.items():
            yield GaugeMetricFamily(f"stridewire_{name}", told, value=self._numbers[name])
