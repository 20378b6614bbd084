"""`make show-spine`: real capture in, a character driven over gRPC, poses out.

Bars stand here as they were asked for. Needs the capture (STRIDEWIRE_DATA), git and a free core.
"""

import gc
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from points import ROOT, Point, show
from spine_faults import bad_input, stalled, vanished

from stridewire import Client
from stridewire._messages import CharacterSpec, Detail, GroundPose, Open, Step, Transition
from stridewire.scripts import script
from stridewire_engine.building import open_library
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import Runtime, Session

DT = 1.0 / 60.0


def clean_clone() -> Iterator[Point]:
    """`make demo` and `make test` on a clean clone."""
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "clone"
        subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
        cache = {**os.environ, "XDG_CACHE_HOME": str(Path(folder) / "cache")}
        demo = _make("demo", clone, cache)
        said = {line.split(" ")[0]: line for line in demo.stdout.splitlines()}
        for word in ("library", "latency", "transitions", "sliding"):
            line = " ".join(said.get(word, "not printed").split())
            yield Point(f"make demo prints its {word}", line, "it does", word in said)
        made = [name for name in ("demo.bvh", "demo.png") if (clone / name).stat().st_size > 1000]
        passed = demo.returncode == 0 and len(made) == 2
        yield Point("make demo", f"exit {demo.returncode}, {made}", "exit 0, both files", passed)
        test = _make("test", clone, cache)
        summary = test.stdout.strip().splitlines()[-1:]
        yield Point(
            "make test", f"exit {test.returncode}: {summary}", "exit 0", not test.returncode
        )


def capture() -> Iterator[Point]:
    """A library from LaFAN1 streamed over gRPC; its sheet lies in build/show."""
    with _lafan1() as folder:
        out = ROOT / "build" / "show"
        out.mkdir(parents=True, exist_ok=True)
        sheet, motion = out / "spine-lafan1.png", out / "spine-lafan1.bvh"
        command = [sys.executable, "-m", "stridewire", "demo", "--library", str(folder), "--json"]
        command += ["--out", str(motion), "--sheet", str(sheet)]
        run = subprocess.run(command, capture_output=True, text=True, check=True)
    told = json.loads(run.stdout)
    row = told["rows"][0]
    frames = f"{row['frames']} frames, synthetic: {told['settings']['synthetic']}"
    yield Point("LaFAN1 streamed over gRPC", frames, "it is", not told["settings"]["synthetic"])
    latency = f"p50 {row['p50_ms']:.2f} ms, p99 {row['p99_ms']:.2f} ms"
    figures = f"{latency}, {row['late_pct']:.2f} % late, sliding {row['sliding_c_cm_s']:.1f} cm/s"
    yield Point("its frames at wall-clock 60 fps", figures, "reported", row["frames"] > 590)
    notes = ROOT / "docs" / "motion.md"
    looked = notes.exists() and "LaFAN1" in notes.read_text()
    yield Point("its contact sheet looked at", f"{sheet.name}; docs/motion.md", "written", looked)


def search() -> Iterator[Point]:
    """Search equals brute force on 1,000 random queries."""
    with _lafan1() as folder:
        for library in (open_library(), open_library(folder)):
            matcher = Matcher(library)
            rng = np.random.default_rng(1)
            rows = rng.integers(len(library.features), size=1000)
            queries = library.features[rows] + rng.normal(scale=0.5, size=(1000, 27))
            weights = np.tile(matcher.schema.weights, (1000, 1))
            # the lists may miss a row; the exact path is what this point is about
            matcher.candidates.look_into(10**6)
            found = matcher.search(queries, weights, np.full((1000, 1), -1))
            wrong = sum(
                not np.isclose(cost, _brute_force(matcher, query), rtol=1e-9)
                for query, cost in zip(queries, found.costs[:, 0], strict=True)
            )
            what = f"searches of {library.name} unlike brute force, of 1,000"
            yield Point(what, str(wrong), "0", wrong == 0)


def same_frames() -> Iterator[Point]:
    """In process and over gRPC: same clips and times, poses to 1e-5."""
    with _server() as address, Client(address) as remote, Client.in_process() as local:
        streams = []
        for client in (remote, local):
            with client.open_session(4, detail=Detail.COSTS, seed=3) as session:
                controls = script("random-stick").controls
                streams.append([session.step(*controls(i * DT, 4, 9)) for i in range(900)])
    jumps = [
        [
            (e.frame, e.character, e.to_clip, e.to_time_s)
            for frame in stream
            for e in frame.events
            if isinstance(e, Transition)
        ]
        for stream in streams
    ]
    same = f"{len(jumps[0])} and {len(jumps[1])} transitions, equal: {jumps[0] == jumps[1]}"
    yield Point("clips and times in process and over gRPC", same, "same", jumps[0] == jumps[1])
    apart = max(
        float(np.abs(getattr(a, block) - getattr(b, block)).max())
        for a, b in zip(*streams, strict=True)
        for block in ("root", "hips", "rotations")
    )
    yield Point("poses apart, 900 frames of 4", f"{apart:.1e}", "1e-5", apart <= 1e-5)


def calls_and_memory() -> Iterator[Point]:
    """Python-level calls per tick, equal at 8 and 256 characters; no growth over 10,000 ticks."""
    counts = {count: _calls(count) for count in (8, 256)}
    text = f"{counts[8]} at 8, {counts[256]} at 256 (playing, searching)"
    yield Point("Python-level calls of a tick", text, "equal", counts[8] == counts[256])
    grown = _growth(10_000)
    yield Point("memory grown over 10,000 ticks", f"{grown} bytes", "no growth", grown < 64 * 1024)


def _make(target: str, clone: Path, env: dict[str, str]) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        ["make", target, "PYTHON=python3"],
        cwd=clone,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )


def _calls(characters: int) -> list[int]:
    """Count Python and C calls in a tick that plays and in one that searches."""
    runtime, session = _session(characters)
    step = Step(1, DT, velocity_xz=np.tile([0.0, 1.4], (characters, 1)))
    for _ in range(90):
        runtime.advance([(session, step)])
    state = session.crowd.state
    counts = []
    for until_search in (1.0, 0.5 * DT):
        for array in (state.clip, state.clip_time, state.since_jump, state.recent, state.time):
            array[:] = array[0]
        state.until_search[:] = until_search
        count = 0

        def hook(frame: object, event: str, argument: object) -> None:
            nonlocal count
            count += event in ("call", "c_call")

        gc.disable()
        sys.setprofile(hook)
        runtime.advance([(session, step)])
        sys.setprofile(None)
        gc.enable()
        counts.append(count)
    return counts


def _growth(ticks: int) -> int:
    runtime, session = _session(2)
    ways = [(0.0, 1.4), (1.0, 0.0), (0.0, 0.0), (-1.0, -1.0)]
    steps = [Step(1, DT, velocity_xz=np.tile(way, (2, 1))) for way in ways]
    tracemalloc.start()
    for i in range(1000 + ticks):
        if i == 1000:
            gc.collect()
            before = tracemalloc.get_traced_memory()[0]
        runtime.advance([(session, steps[(i // 60) % 4])])
    gc.collect()
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    return grown


def _session(characters: int) -> tuple[Runtime, Session]:
    runtime = Runtime([open_library()], clock=lambda: 0.0)
    specs = [CharacterSpec(i, GroundPose((3.0 * i, 0.0, 0.0))) for i in range(characters)]
    return runtime, runtime.open(Open(specs, detail=Detail.NONE))


def _brute_force(matcher: Matcher, query: np.ndarray) -> float:
    library, schema = matcher.library, matcher.schema
    difference = library.features.astype(np.float64) - query
    costs = (difference**2 * schema.weights[schema.channel_of]).sum(axis=1)
    return float(costs[library.startable].min())


@contextmanager
def _server() -> Iterator[str]:
    command = [sys.executable, "-m", "stridewire", "serve", "--address", "127.0.0.1:0", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        yield json.loads(server.stdout.readline())["address"]
        server.terminate()


@contextmanager
def _lafan1() -> Iterator[Path]:
    """Give the folder of LaFAN1's cuts, unpacked where STRIDEWIRE_DATA holds archives."""
    given = Path(os.environ["STRIDEWIRE_DATA"])
    if (given / "lafan1" / "clips").is_dir():
        yield given / "lafan1" / "clips"
        return
    folder = ROOT / "build" / "show" / "capture"
    if not (folder / "lafan1" / "clips").is_dir():
        with tarfile.open(given / "lafan1.tar.xz") as archive:
            archive.extractall(folder, filter="data")
    yield folder / "lafan1" / "clips"


if __name__ == "__main__":
    stages = [
        search,
        same_frames,
        calls_and_memory,
        stalled,
        vanished,
        bad_input,
        capture,
        clean_clone,
    ]
    sys.exit(show("spine", stages))
