"""Whether compiled code moves people as its reference does: the judge's quick table of both."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from typing import Any

from judge_results import library
from points import Point

LIBRARIES = ("cmu-heldout", "lafan1")
STITCHERS = ("stance", "refine")


def judged() -> Iterator[Point]:
    """Compare all figures of `evaluate stream --quick`, compiled and by numpy."""
    for name in LIBRARIES:
        compiled, reference = (_rows(name, way) for way in ("1", "0"))
        for key, expected in reference.items():
            figures = [k.removesuffix("_low") for k in expected if k.endswith("_low")]
            outside = [f for f in figures if not _is_inside(compiled[key][f], expected, f)]
            same = sum(compiled[key][f] == expected[f] for f in figures)
            yield Point(
                f"{name}, {key[0]}, foot lock {key[1]}: compiled beside numpy",
                f"{len(figures)} figures, {same} the same, outside: {', '.join(outside) or 'none'}",
                "all within their intervals",
                not outside,
            )


def _is_inside(value: float | None, expected: dict[str, Any], figure: str) -> bool:
    if value is None or expected[figure] is None:
        return value == expected[figure]
    # rounded figures may touch the ends
    return bool(expected[f"{figure}_low"] - 1e-4 <= value <= expected[f"{figure}_high"] + 1e-4)


def _rows(name: str, compiled: str) -> dict[tuple[str, str], dict[str, Any]]:
    """Return the streamed rows over all scripts, measured anew."""
    words = ["evaluate", "stream", "--quick", "--library", str(library(name).path), "--json"]
    words += [word for stitcher in STITCHERS for word in ("--stitch", stitcher)]
    with tempfile.TemporaryDirectory() as measured:
        environment = {**os.environ, "STRIDEWIRE_COMPILED": compiled}
        # what was measured by the same code is kept in the cache, whichever way it ran
        environment["XDG_CACHE_HOME"] = measured
        command = [sys.executable, "-m", "stridewire", *words]
        ran = subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True)
    rows = json.loads(ran.stdout)["rows"]
    return {
        (row["stitch"], str(row["foot_lock"])): row
        for row in rows
        if row.get("row") == "streamed" and row["script"] == "all" and row["block"] == "all"
    }
