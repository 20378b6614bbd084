"""What a generator has seen, in histograms that can be added up."""

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from hdrh.histogram import HdrHistogram

LATE_S = 1.0 / 60.0
"""A frame that comes later than this after its scheduled time is late."""
GENERATOR_LATE_S = 0.004
"""A control that leaves later than this after its scheduled time was sent late."""
_LONGEST_US = 600_000_000
_HISTOGRAMS = ("frames", "controls", "sending", "ticks", "plain_ticks", "refined_ticks", "queries")


def histogram() -> Any:
    """Return an empty histogram of microseconds, up to ten minutes, to three digits."""
    return HdrHistogram(1, _LONGEST_US, 3)


@dataclass
class Tally:
    """Counts and latencies of the measured time; passes between processes."""

    library: str = ""
    """What the server says that it plays."""
    expected: int = 0
    """Frames that were to come."""
    received: int = 0
    late: int = 0
    """Received, but late."""
    skipped: int = 0
    """Frames that the server said it had dropped."""
    sent_late: int = 0
    refused: int = 0
    """Streams and queries that the server refused or broke off."""
    characters_frames: int = 0
    """Poses received: frames times characters."""
    counts: Counter[str] = field(default_factory=Counter)
    """Events by name: transitions, fallbacks, degraded rows, errors."""
    late_by_second: Counter[int] = field(default_factory=Counter)
    frames: Any = field(default_factory=histogram)
    """From the scheduled time to receipt."""
    controls: Any = field(default_factory=histogram)
    """From sending a control to the frame that shows it."""
    sending: Any = field(default_factory=histogram)
    """From the scheduled time to sending."""
    ticks: Any = field(default_factory=histogram)
    """What the server says that a tick took."""
    plain_ticks: Any = field(default_factory=histogram)
    """The same, of ticks in which no transition was refined."""
    refined_ticks: Any = field(default_factory=histogram)
    """The same, of ticks in which a transition was refined."""
    queries: Any = field(default_factory=histogram)
    poses: dict[int, list[bytes]] = field(default_factory=dict)
    """Hashes of the poses of all characters at some steps."""
    examples: list[str] = field(default_factory=list)
    """A few errors in words."""

    def note(self, latency_s: float, second: int) -> None:
        """Note a frame."""
        self.received += 1
        self.frames.record_value(max(1, round(1e6 * latency_s)))
        if latency_s > LATE_S:
            self.late += 1
            self.late_by_second[second] += 1

    def fail(self, error: object) -> None:
        """Note what was refused or broke off."""
        self.refused += 1
        if len(self.examples) < 5:
            self.examples.append(str(error).partition("\n")[0][:200])

    def add(self, other: "Tally") -> None:
        """Add what another generator has seen."""
        self.library = self.library or other.library
        for name in (
            "expected",
            "received",
            "late",
            "skipped",
            "sent_late",
            "refused",
            "characters_frames",
        ):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.counts.update(other.counts)
        self.late_by_second.update(other.late_by_second)
        for name in _HISTOGRAMS:
            getattr(self, name).add(getattr(other, name))
        for step, hashes in other.poses.items():
            self.poses.setdefault(step, []).extend(hashes)
        self.examples = (self.examples + other.examples)[:5]

    def distinct_pct(self) -> float:
        """Return the smallest share of characters whose pose no other character had; per cent."""
        shares = [len(set(hashes)) / len(hashes) for hashes in self.poses.values() if hashes]
        return 100.0 * min(shares, default=1.0)

    def __getstate__(self) -> dict[str, Any]:
        state = dict(self.__dict__)
        for name in _HISTOGRAMS:
            state[name] = state[name].encode()
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name in _HISTOGRAMS:
            state[name] = HdrHistogram.decode(state[name])
        self.__dict__.update(state)
