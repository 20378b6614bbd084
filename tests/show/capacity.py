"""`make show-capacity`: how many characters two cores hold at 60 frames a second, and why.

Bars stand here as they were asked for. Late frames and milliseconds want a machine that does
nothing else; stages that have run are kept, so that the show can be taken in parts. Draws
`build/show/capacity-growth.png` and a picture of each load.
"""

import gc
import json
import sys
import tracemalloc
from collections.abc import Iterator
from types import FrameType
from typing import Any

import numpy as np
from capacity_budget import FRAME_S, budget_us, driven, tick_us
from capacity_judged import judged
from capacity_load import REPORTS, STITCHER, load, standard_library
from points import ROOT, Point, show
from search_libraries import MILLION, reduced

from overloading import crowding, neighbour
from stridewire._messages import CharacterSpec, Detail, Open, Step
from stridewire.testing import server_process
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_server.benchmarks import engine

RUNS = 3
LOAD_S = 60.0
CHARACTERS, STREAMS, AIM = 256, 64, 1000
WAITING = ("threading.py", "concurrent/futures/_base.py", "concurrent/futures/thread.py")
COUNTS = (1, 4, 16, 64, 256, 1024)
FRAMES = (10_000, 100_000, MILLION)
_DRAWING = ROOT / "build" / "show" / "capacity-growth.png"
_CURVES = REPORTS / "curves.json"


def gates() -> Iterator[Point]:
    """Show what cannot be flaky: calls, memory and ratios within one run."""
    library = standard_library()
    calls = [_calls(library, count) for count in (8, CHARACTERS)]
    yield Point("Python calls a tick at 8 and 256 characters, same situation", f"{calls}",
                "equal", calls[0] == calls[1])  # fmt: skip
    grown = _grown(library)
    yield Point("memory that 240 ticks of 64 characters leave behind", f"{grown / 1024:.0f} KiB",
                "no steady-state allocation", grown < 64 * 1024)  # fmt: skip
    (many,) = engine.tick(library, 5, (64,))
    ratio = many.value / many.reference_value
    yield Point("a character among 64 over a single one, in one run", f"{ratio:.3f}", "< 0.2",
                ratio < 0.2)  # fmt: skip


def budget() -> Iterator[Point]:
    """Print microseconds a character-frame by stage, and whether they add up."""
    library = standard_library()
    for stitcher in (STITCHER, "stance"):
        before = tick_us(library, CHARACTERS, stitcher)
        stages = budget_us(library, CHARACTERS, stitcher)
        after = tick_us(library, CHARACTERS, stitcher)
        for stage, cost in sorted(stages.items(), key=lambda item: -item[1]):
            yield Point(f"{stitcher}: {stage}", f"{cost:.2f} us a character-frame")
        total, tick = sum(stages.values()), 0.5 * (before + after)
        yield Point(f"{stitcher}: sum of the stages over the measured tick",
                    f"{total:.1f} / {tick:.1f} us", "within 10 %",
                    abs(total / tick - 1.0) <= 0.1)  # fmt: skip


def characters() -> Iterator[Point]:
    """Measure the cost of a tick from 1 to 1,024 characters."""
    costs = {count: tick_us(standard_library(), count, STITCHER) for count in COUNTS}
    _keep("characters", {str(count): cost * count / 1e3 for count, cost in costs.items()})
    for count, cost in costs.items():
        yield Point(
            f"tick of {count} characters", f"{cost * count / 1e3:.2f} ms ({cost:.0f} us each)"
        )


def libraries() -> Iterator[Point]:
    """Measure a tick and a search over 10 k to a million frames; draw both curves."""
    costs = {}
    for frames in FRAMES:
        library = reduced(frames)
        costs[str(frames)] = tick_us(library, 64, STITCHER) * 64 / 1e3
        (search,) = engine.search(library, 5)
        figure = f"{costs[str(frames)]:.2f} ms, search {search.value:.0f} us a query"
        yield Point(f"library of {frames} frames, tick of 64 characters", figure)
    _keep("libraries", costs)
    _draw(json.loads(_CURVES.read_text()))
    yield Point("growth drawn", str(_DRAWING.relative_to(ROOT)))


def crowd() -> Iterator[Point]:
    """Drive 256 characters in one stream for a minute, three times."""
    for number, row in enumerate(load("crowd", CHARACTERS, LOAD_S, "--runs", str(RUNS)), start=1):
        yield from _standard(f"crowd of 256, run {number}", row)
        yield _late(f"crowd of 256, run {number}: late or missing", row, 0.1)


def largest() -> Iterator[Point]:
    """Find the largest crowd that is held."""
    rows = load("crowd", CHARACTERS, 20.0, "--find-capacity")
    held = [row["characters"] for row in rows if row["late_pct"] <= 0.1 and row["valid"]]
    most = max(held, default=0)
    yield Point("largest crowd held for 20 s", f"{most} characters", f"aim {AIM}", most >= AIM)


def streams() -> Iterator[Point]:
    """Drive 64 streams of one character, beside an empty echo."""
    (row,) = load("streams", STREAMS, LOAD_S, "--echo")
    yield _late("64 streams: late or missing", row, 0.5)
    ratio = row["echo_cpu_ratio"]
    yield Point("server CPU a stream-frame over the empty echo's", f"{ratio:.2f}", "at most 1.5",
                ratio <= 1.5)  # fmt: skip


def single() -> Iterator[Point]:
    """Drive one character: what the server needs, and what a player waits."""
    (row,) = load("single", 1, LOAD_S)
    for name, what, bar in (
        ("tick_plain_p99_ms", "without a refinement in the tick", 2.0),
        ("tick_refined_p99_ms", "with one", 5.0),
    ):
        figure = row.get(name, float("nan"))
        yield Point(f"single, server time p99 {what}", f"{figure:.2f} ms", f"below {bar:g} ms",
                    figure < bar)  # fmt: skip
    waits = [row[f"control_to_frame_{name}_ms"] for name in ("p50", "p99")]
    yield Point("single, control to frame", f"p50 {waits[0]:.2f} ms, p99 {waits[1]:.2f} ms")


def surge() -> Iterator[Point]:
    """Let 200 streams connect within a second beside eight that are driven."""
    (row,) = load("surge", 64, 20.0)
    yield _late("200 connects in a second: neighbours late", row, 1.0)


def overload() -> Iterator[Point]:
    """Give a server too much, and see how long it takes to be itself again."""
    path = standard_library().path
    with server_process(path) as (address, _), neighbour(address) as watching:
        watching.wait_for(degraded=False)
        with crowding(address):
            told_s = watching.wait_for(degraded=True)
        recovered_s = watching.wait_for(degraded=False)
    yield Point("too large a crowd: frames beside it say DEGRADED after", f"{told_s:.2f} s")
    yield Point("the crowd gone: frames are as before after", f"{recovered_s:.2f} s",
                "within a second", recovered_s <= 1.0)  # fmt: skip


def _standard(what: str, row: dict[str, Any]) -> Iterator[Point]:
    """Say whether the load was the standard one."""
    rate, interval, refined = (
        row["transitions_per_s"], row["search_interval_ms"], row["refined_pct"],
    )  # fmt: skip
    yield Point(f"{what}: the run counts", "valid" if row["valid"] else "void", "valid",
                row["valid"])  # fmt: skip
    yield Point(f"{what}: transitions a second and character", f"{rate:.2f}", "at least 0.5",
                rate >= 0.5)  # fmt: skip
    yield Point(f"{what}: mean search interval", f"{interval:.0f} ms", "at most 200 ms",
                interval <= 200.0)  # fmt: skip
    yield Point(f"{what}: refined transitions", f"{refined:.1f} %", "at least 95 %",
                refined >= 95.0)  # fmt: skip


def _late(what: str, row: dict[str, Any], bar: float) -> Point:
    figure = f"{row['late_pct']:.2f} %, p99 {row['p99_ms']:.1f} ms"
    return Point(what, figure, f"at most {bar:g} %", row["late_pct"] <= bar and row["valid"])


def _calls(library: Library, count: int) -> int:
    """Count the calls of one tick in which all characters are in the situation of the first."""
    calls = 0

    def hook(frame: FrameType, event: str, _argument: object) -> None:
        nonlocal calls
        # how often a thread looks before the other one is done is chance
        waits = frame.f_code.co_filename.endswith(WAITING)
        calls += event in ("call", "c_call") and not waits

    runtime = Runtime([library])
    specs = tuple(CharacterSpec(i, stitcher=STITCHER) for i in range(count))
    session = runtime.open(Open(characters=specs, detail=Detail.EVENTS))
    step = Step(1, FRAME_S, velocity_xz=np.tile([0.0, 1.4], (count, 1)))
    state = session.crowd.state
    for number in range(60):
        # threads that share searches out begin with the first large one
        state.force_search[:] = number == 30
        runtime.advance([(session, step)])
    for array in vars(state).values():
        array[:] = array[:1]
    state.until_search[:] = 0.5 * FRAME_S
    gc.disable()
    sys.setprofile(hook)
    try:
        runtime.advance([(session, step)])
    finally:
        sys.setprofile(None)
        gc.enable()
    return calls


def _grown(library: Library) -> int:
    """Return the bytes that a stretch of ticks leaves in use."""
    before = 0
    tracemalloc.start()
    try:
        for number, advance in enumerate(driven(library, 64, STITCHER)):
            advance()
            if number == 119:
                gc.collect()
                before = tracemalloc.get_traced_memory()[0]
        gc.collect()
        return tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()


def _keep(name: str, curve: dict[str, float]) -> None:
    REPORTS.mkdir(parents=True, exist_ok=True)
    kept = json.loads(_CURVES.read_text()) if _CURVES.exists() else {}
    _CURVES.write_text(json.dumps({**kept, name: curve}))


def _draw(curves: dict[str, dict[str, float]]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    for axes, (name, curve) in zip(figure.subplots(1, 2), curves.items(), strict=False):
        at = np.array([float(key) for key in curve])
        axes.plot(at, list(curve.values()), "o-")
        axes.axhline(1000.0 / 60.0, color="0.3", lw=0.8, ls="--")
        label = "characters" if name == "characters" else "frames of the library, 64 characters"
        axes.set(xscale="log", yscale="log", xlabel=label, ylabel="ms of processor time a tick")
    figure.savefig(_DRAWING, dpi=110)


if __name__ == "__main__":
    sys.exit(
        show(
            "capacity",
            [
                gates,
                judged,
                budget,
                characters,
                libraries,
                crowd,
                largest,
                streams,
                single,
                surge,
                overload,
            ],
        )
    )
