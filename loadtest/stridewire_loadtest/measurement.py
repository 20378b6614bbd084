"""One measurement: a scenario against a server, and its figures as one flat row."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from stridewire_loadtest.echo import echo_cpu_s
from stridewire_loadtest.generator import Share, generators
from stridewire_loadtest.scenarios import FRAME_S, RATE_HZ, Scenario, scenario
from stridewire_loadtest.served import Served, Usage
from stridewire_loadtest.streams import StreamPlan
from stridewire_loadtest.tally import Tally

_LEAD_S = 0.5
_SETTLING_S = 120.0
"""Memory of a long run is compared from here on."""
_ECHO_S = 10.0
GENERATOR_LATE_BAR_PCT = 1.0
"""A generator that sends more than this share late has measured itself: the run is void."""


@dataclass(frozen=True)
class Load:
    """What is asked for."""

    scenario: str
    characters: int
    seconds: float = 60.0
    warmup_s: float = 3.0
    script: str = "random-stick"
    seed: int = 0
    stitcher: str = "auto"
    processes: int = 1

    def asked(self) -> Scenario:
        """Return the scenario."""
        return scenario(self.scenario, self.characters)

    def plans(self) -> list[StreamPlan]:
        """Return a plan for each stream; their steps are spread over a frame."""
        asked = self.asked()
        count = asked.streams + asked.slow_readers
        return [
            StreamPlan(
                number,
                asked.characters,
                self.seconds,
                self.warmup_s,
                FRAME_S * number / count,
                self.script,
                self.seed,
                self.stitcher,
                reads=number < asked.streams,
            )
            for number in range(count)
        ]

    def shares(self, address: str) -> list[Share]:
        """Return what each generator does; the first one also does what goes on beside."""
        plans = self.plans()
        parts = [plans[i :: self.processes] for i in range(self.processes)]
        return [
            Share(address, part, self.asked(), index == 0)
            for index, part in enumerate(parts)
            if part
        ]


@dataclass
class Measured:
    """What came of a measurement."""

    load: Load
    tally: Tally
    usage: Usage
    echo_s: float | None = None

    def row(self) -> dict[str, Any]:
        """Return the figures."""
        load, tally, asked = self.load, self.tally, self.load.asked()
        from_s, to_s = load.warmup_s, load.warmup_s + load.seconds
        expected = max(1, tally.expected)
        cores = self.usage.cores(from_s, to_s)
        row = {
            "scenario": load.scenario,
            "library": tally.library,
            "script": load.script,
            "stitch": load.stitcher,
            "characters": asked.streams * asked.characters,
            "streams": asked.streams,
            "seconds": load.seconds,
            "frames": tally.received,
            "fps": tally.received / load.seconds / asked.streams,
            "late_pct": 100.0 * (tally.late + expected - tally.received) / expected,
            "late_trend_pct": _trend_pct(load, tally),
            "dropped_pct": 100.0 * (expected - tally.received) / expected,
            **_percentiles(tally.frames, "", ("p50", "p99", "p999", "max")),
            **_percentiles(tally.controls, "control_to_frame_", ("p50", "p99")),
            **_percentiles(tally.ticks, "tick_", ("p50", "p99")),
            **_percentiles(tally.plain_ticks, "tick_plain_", ("p99",)),
            **_percentiles(tally.refined_ticks, "tick_refined_", ("p99",)),
            **_percentiles(tally.queries, "query_", ("p50", "p99")),
            "transitions_per_s": _per_character_s(tally, tally.counts["transitions"]),
            "refined_pct": _refined_pct(tally) if load.stitcher == "refine" else 0.0,
            "search_interval_ms": _interval_ms(tally),
            "fallback_pct": _share(tally.counts["FRAME_FLAG_FALLBACK"], tally.characters_frames),
            "degraded_pct": _share(tally.counts["FRAME_FLAG_DEGRADED"], tally.characters_frames),
            "server_cpu_cores": cores,
            "server_rss_mb": self.usage.rss_mb[-1],
            "memory_growth_pct": self.usage.growth_pct(min(_SETTLING_S, to_s / 2.0), to_s),
            "refused": tally.refused,
            "generator_late_pct": _share(tally.sent_late, tally.sending.get_total_count()),
            "distinct_poses_pct": tally.distinct_pct(),
        }
        if self.echo_s:
            per_frame = cores * load.seconds / max(1, tally.received)
            row["echo_cpu_ratio"] = per_frame / self.echo_s
        row["valid"] = not self.void()
        return row

    def void(self) -> list[str]:
        """Return why the run says nothing about the server; empty where it does."""
        late = _share(self.tally.sent_late, self.tally.sending.get_total_count())
        reasons = []
        if late > GENERATOR_LATE_BAR_PCT:
            reasons.append(
                f"the generator sent {late:.1f} % of the controls late: it measured itself; "
                "give it --processes or a core of its own"
            )
        if self.tally.distinct_pct() < 100.0:
            reasons.append("characters held the same pose at the same time: the load is not real")
        return reasons


def measure(server: Served, load: Load, *, echo: bool = False) -> Measured:
    """Put a load on a server.

    Args:
        server: Running.
        load: What to ask.
        echo: Also drive an empty echo in the same way, to compare CPU time.

    Raises:
        RuntimeError: If a generator failed.
    """
    with generators(load.shares(server.address)) as ready:
        begin = time.perf_counter() + _LEAD_S
        with server.watched(begin) as usage:
            tally = ready.run(begin)
    echoed = echo_cpu_s(load.asked().streams, min(_ECHO_S, load.seconds)) if echo else None
    return Measured(load, tally, usage, echoed)


def _percentiles(histogram: Any, prefix: str, names: Sequence[str]) -> dict[str, float]:
    values = {"p50": 50.0, "p99": 99.0, "p999": 99.9, "max": 100.0}
    if not histogram.get_total_count():
        return {}
    return {
        f"{prefix}{name}_ms": histogram.get_value_at_percentile(values[name]) / 1e3
        for name in names
    }


def _per_character_s(tally: Tally, count: int) -> float:
    return count * RATE_HZ / max(1, tally.counts["character_ticks"])


def _trend_pct(load: Load, tally: Tally) -> float:
    """Return by how much more late frames came in the second half than in the first."""
    half = load.seconds / 2.0
    halves = [0, 0]
    for second, late in tally.late_by_second.items():
        halves[second >= half] += late
    return _share(halves[1] - halves[0], tally.expected / 2.0)


def _interval_ms(tally: Tally) -> float:
    """Return the mean time between a character's searches."""
    return 1e3 * tally.counts["character_ticks"] / RATE_HZ / max(1, tally.counts["searches"])


def _refined_pct(tally: Tally) -> float:
    """Return the share of transitions that a network hides, however soon the next one comes."""
    return _share(tally.counts["refined"], tally.counts["transitions"])


def _share(part: float, whole: float) -> float:
    return 100.0 * part / max(1.0, whole)
