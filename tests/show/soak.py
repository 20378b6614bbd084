"""`make show-soak`: twenty minutes near capacity, people coming, leaving and vanishing.

Wants a machine that does nothing else. 80 % of the largest crowd that `make show-capacity` found,
else of 256.
"""

import json
import re
import sys
from collections.abc import Iterator

from capacity_load import load
from points import ROOT, Point, show

SECONDS = 20 * 60.0
SHARE = 0.8
_OTHERWISE = 256
_TREND = 0.1
"""Per cent of the frames; fewer more in the second half are no trend."""


def soak() -> Iterator[Point]:
    """Keep a server busy and see whether memory or late frames grow."""
    characters = int(SHARE * _capacity()) // 32 * 32
    (row,) = load("soak", characters, SECONDS)
    yield Point("the run counts", "valid" if row["valid"] else "void", "valid", row["valid"])
    grown = row["memory_growth_pct"]
    yield Point(f"memory after the first two minutes, {characters} characters", f"{grown:+.2f} %",
                "grows less than 2 %", grown < 2.0)  # fmt: skip
    trend = row["late_trend_pct"]
    yield Point("late in the second half over the first", f"{trend:+.3f} % of the frames",
                "no trend in late frames", trend < _TREND)  # fmt: skip
    yield Point("late or missing", f"{row['late_pct']:.2f} %, p99 {row['p99_ms']:.1f} ms")


def _capacity() -> int:
    """Return the largest crowd that was held."""
    kept = ROOT / "build" / "show" / "capacity.json"
    stages = json.loads(kept.read_text())["stages"] if kept.exists() else {}
    for point in stages.get("largest", {}).get("points", []):
        if found := re.match(r"(\d+) characters", point["figure"]):
            return int(found[1])
    return _OTHERWISE


if __name__ == "__main__":
    sys.exit(show("soak", [soak]))
