"""The frame of `make show-NAME`: points that a capability must show, each with figure and bar.

A show is a list of stages, functions without arguments that yield points as they are found. A stage
that has finished is kept in `build/show/NAME.json` for the state of the checkout it ran on, so that
a show that was interrupted goes on where it stopped; `--fresh` begins anew.

    def search() -> Iterator[Point]:
        wrong = ...
        yield Point("1,000 searches equal brute force", f"{wrong} differ", "0", wrong == 0)
        yield Point("the index", f"{bytes / 1e6:.1f} MB")  # no bar: for information

    if __name__ == "__main__":
        sys.exit(show("spine", [search]))
"""

import argparse
import hashlib
import json
import subprocess
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
_NO_RESULTS = ":(exclude)docs/results"


@dataclass(frozen=True)
class Point:
    """One thing that was to be shown."""

    what: str
    """The claim in a few words."""
    figure: str
    """What was measured, with its unit."""
    bar: str = ""
    """What was asked for, as it was asked; empty where nothing was."""
    passed: bool | None = None
    """Whether the figure is within the bar; None without one: it is told for information."""

    def __post_init__(self) -> None:
        if bool(self.bar) != (self.passed is not None):
            raise ValueError(f"{self.what!r}: a bar is passed or missed, and nothing else is")
        if self.passed is not None:
            # comparisons of numpy give a type of their own, which JSON does not know
            object.__setattr__(self, "passed", bool(self.passed))


Stage = Callable[[], Iterator[Point]]


def show(name: str, stages: Sequence[Stage], arguments: Sequence[str] | None = None) -> int:
    """Run the stages that have not run on this state of the checkout; print a table.

    Args:
        name: Of the show; names the file of its finished stages.
        stages: Run in order; the name of the function is the stage's.
        arguments: Of the command line: `--fresh`, `--stage NAME`, `--json`.

    Returns:
        The exit status: 0 where every point that has a bar passed, 1 where one missed.
    """
    options = _options(name, stages, arguments)
    done = _Finished(ROOT / "build" / "show" / f"{name}.json", options.fresh)
    rows: list[dict[str, Any]] = []
    for stage in stages:
        if options.stage and stage.__name__ not in options.stage:
            continue
        kept = done.points(stage.__name__)
        points = _run(stage, done) if kept is None else kept
        for point in points:
            rows.append({"stage": stage.__name__, "kept": kept is not None, **asdict(point)})
            if not options.json:
                print(_line(stage.__name__, point, kept is not None), flush=True)
    told = [row for row in rows if row["passed"] is None]
    missed = [row for row in rows if row["passed"] is False]
    if options.json:
        print(json.dumps({"settings": {"name": name, "state": done.state}, "rows": rows}))
    else:
        asked = len(rows) - len(told)
        beside = f", {len(told)} for information" if told else ""
        print(f"\n{asked - len(missed)} of {asked} points shown, {len(missed)} missed{beside}")
    return 1 if missed or len(told) == len(rows) else 0


class _Finished:
    """Finished stages on disk, of one state of the checkout."""

    def __init__(self, path: Path, fresh: bool) -> None:
        self.path = path
        self.state = _state_of_checkout()
        kept: dict[str, Any] = {}
        if path.exists() and not fresh:
            kept = json.loads(path.read_text())
        self.stages = kept.get("stages", {}) if kept.get("state") == self.state else {}

    def points(self, stage: str) -> list[Point] | None:
        kept = self.stages.get(stage)
        return None if kept is None else [Point(**point) for point in kept["points"]]

    def keep(self, stage: str, points: Sequence[Point], seconds: float) -> None:
        self.stages[stage] = {"seconds": seconds, "points": [asdict(point) for point in points]}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        part = self.path.with_suffix(".part")
        part.write_text(json.dumps({"state": self.state, "stages": self.stages}, indent=1))
        part.replace(self.path)


def _run(stage: Stage, done: _Finished) -> Iterator[Point]:
    """Yield a stage's points as they come; one that fails is a miss and is not kept."""
    points, start = [], time.monotonic()
    try:
        for point in stage():
            points.append(point)
            yield point
    except Exception as error:
        traceback.print_exc()
        yield Point(
            "the stage ran to its end", f"{type(error).__name__}: {error}", "it does", False
        )
        return
    done.keep(stage.__name__, points, time.monotonic() - start)


def _line(stage: str, point: Point, kept: bool) -> str:
    verdict = {True: "pass", False: "MISS", None: "info"}[point.passed]
    bar = f"  [{point.bar}]" if point.bar else ""
    note = "  (kept)" if kept else ""
    return f"{verdict}  {stage:<12} {point.what}: {point.figure}{bar}{note}"


def _options(
    name: str, stages: Sequence[Stage], arguments: Sequence[str] | None
) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"show-{name}")
    parser.add_argument("--fresh", action="store_true", help="run finished stages again")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    names = [stage.__name__ for stage in stages]
    parser.add_argument("--stage", action="append", choices=names, help="run this stage alone")
    return parser.parse_args(arguments)


def _state_of_checkout() -> str:
    """Return the commit, and a hash of what differs from it; results, which shows write, do not."""
    commit = _git("rev-parse", "HEAD").strip().decode()
    digest = hashlib.sha256(_git("diff", "HEAD", "--", ".", _NO_RESULTS))
    for name in _git(
        "ls-files", "-z", "--others", "--exclude-standard", "--", ".", _NO_RESULTS
    ).split(b"\0"):
        path = ROOT / name.decode()
        if path.is_file():
            digest.update(name + path.read_bytes())
    return f"{commit[:12]}-{digest.hexdigest()[:8]}"


def _git(*arguments: str) -> bytes:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True).stdout
