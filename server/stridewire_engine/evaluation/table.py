"""Tables: flat rows of figures with intervals, pooled over scripts."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.bench import BLOCKS, Measurement
from stridewire_engine.evaluation.cell import KEPT_OUT, Cell
from stridewire_engine.evaluation.figures import Figures

Measurements = Mapping[Cell, Measurement]
_PARTS = ("tuned", "kept-out")
_JERKS = {"toe_jerk": "toe_jerk_ratio", "knee_jerk": "knee_jerk_ratio"}


def rows(
    library: str, measurements: Measurements, *, by_script: bool = True
) -> Iterator[dict[str, Any]]:
    """Yield one flat row for each cell and block, then those pooled over scripts.

    The captured row of a script is what the frames played by the first stitcher measure in their
    clips. The jerk of toes and knees is told as a ratio to the captured one.

    Args:
        library: Its name.
        measurements: Of the cells.
        by_script: Whether each script has rows of its own.
    """
    scripts = list(dict.fromkeys(cell.script for cell in measurements))
    ways = list(dict.fromkeys(replace(cell, script="all") for cell in measurements))
    groups: list[tuple[str, tuple[str, ...]]] = [(script, (script,)) for script in scripts]
    if not by_script:
        groups.clear()
    if len(scripts) > 1:
        groups.append(("all", tuple(scripts)))
        groups += [(name, part) for name, part in _parts(scripts) if part]
    for name, members in groups:
        shown = False
        for way in ways:
            found = [measurements.get(replace(way, script=script)) for script in members]
            if any(one is None for one in found):
                continue
            parts = [one for one in found if one is not None]
            if not shown:
                yield _captured(library, name, way, parts)
                shown = True
            for block in BLOCKS if name not in _PARTS else BLOCKS[:1]:
                yield _row(library, name, way, block, parts)


def _parts(scripts: Sequence[str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    yield _PARTS[0], tuple(s for s in scripts if s not in KEPT_OUT)
    yield _PARTS[1], tuple(s for s in scripts if s in KEPT_OUT)


def pooled(parts: Sequence[Measurement], block: str) -> Figures:
    """Join the units of several measurements."""
    return {name: tally.pool([part[block][name] for part in parts]) for name in parts[0][block]}


def _captured(library: str, script: str, way: Cell, parts: Sequence[Measurement]) -> dict[str, Any]:
    figures = pooled(parts, "captured")
    row = {"library": library, "script": script, "row": "captured", "stitch": "", "block": "all"}
    for old, new in _JERKS.items():
        figures[new] = _ratio(figures.pop(old), None)
    return {**row, "forced_interval_frames": way.forced_interval_frames, **_numbers(figures)}


def _row(
    library: str, script: str, way: Cell, block: str, parts: Sequence[Measurement]
) -> dict[str, Any]:
    figures = pooled(parts, block)
    captured = pooled(parts, "captured")
    for old, new in _JERKS.items():
        figures[new] = _ratio(figures.pop(old), captured[old])
    facts = asdict(way)
    for name in ("settings", "weights", "seconds", "script"):
        del facts[name]
    facts["seeds"] = f"{way.seeds[0]}-{way.seeds[-1]}"
    return {"library": library, "script": script, **facts, "block": block, **_numbers(figures)}


def _ratio(figure: tally.Tally, captured: tally.Tally | None) -> tally.Tally:
    """Return a mean as a ratio to the captured mean, the captured one taken as exact."""
    assert isinstance(figure, tally.Mean)
    base = tally.interval(captured or figure)[0]
    return tally.Mean(figure.total / base, figure.weight)


def _numbers(figures: Figures) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for name, figure in figures.items():
        if name == "frames":
            out[name] = int(figure.value(np.ones((1, figure.units)))[0] * 1.0)
            continue
        for suffix, number in zip(("", "_low", "_high"), tally.interval(figure), strict=True):
            out[f"{name}{suffix}"] = None if np.isnan(number) else round(number, 4)
    return out
