"""Rows of `make show-judge`, kept in docs/results/judge.json, and the judge's libraries."""

import json
from collections.abc import Iterator
from functools import cache
from typing import Any

from points import ROOT
from search_libraries import captured

from stridewire import __version__
from stridewire_engine.building import embedded_library
from stridewire_engine.library import Library

QUOTED = ("lafan1", "cmu-heldout")
ALL = (*QUOTED, "cmu-seen", "synthetic")
RESULTS = ROOT / "docs" / "results" / "judge.json"
_NAMES = (
    "library", "script", "row", "stitch", "foot_lock", "forced_interval_frames", "block",
    "match_rank", "root_scale", "label_shift_frames", "change", "responsiveness", "trained_on",
    "joints",
)  # fmt: skip


@cache
def library(name: str) -> Library:
    """Open a library of the judge's."""
    return embedded_library() if name == "synthetic" else captured(name)


def keep(found: Iterator[dict[str, Any]]) -> None:
    """Add rows to the results; those of the same cells are replaced."""
    kept = json.loads(RESULTS.read_text())["rows"] if RESULTS.exists() else []
    new = [row for row in found if _quoted(row)]
    names = {_identity(row) for row in new}
    table = [row for row in kept if _identity(row) not in names] + new
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    settings = {"version": __version__, "command": "make show-judge", "seeds": "100-119"}
    lines = ",\n".join(json.dumps(row) for row in table)
    RESULTS.write_text(f'{{"settings": {json.dumps(settings)}, "rows": [\n{lines}\n]}}\n')


def _quoted(row: dict[str, Any]) -> bool:
    script, block = row.get("script", "all"), row.get("block", "all")
    return script == "all" or (script in ("tuned", "kept-out") and block == "all")


def _identity(row: dict[str, Any]) -> tuple[Any, ...]:
    return tuple(row.get(name) for name in _NAMES)
