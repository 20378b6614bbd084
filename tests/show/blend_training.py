"""The blend network's trainings, for `make show-blend`: what is recorded, a minute of it again."""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from points import ROOT, Point

from stridewire_engine.evaluation.training_runs import CURVE
from stridewire_engine.networks.blend import blend_network

RESULTS = ROOT / "docs" / "results"
AGAIN_S = 60.0


def training() -> Iterator[Point]:
    """What was recorded of whole runs; one of them begun again for a minute."""
    records = {path.stem: json.loads(path.read_text()) for path in RESULTS.glob("blend-*.json")}
    told = {name: record["settings"]["training"] for name, record in sorted(records.items())}
    for name, run in told.items():
        figure = (
            f"recorded: {run['steps']} of {run['asked_steps']} steps, validation "
            f"{run['validation']}, {run['cpu_minutes']} minutes, commit {run['commit']}"
        )
        if run["variant"] == "paper":
            yield Point(f"training of {name}", figure)
        else:
            least = run["cpu_minutes"] <= 60.0
            yield Point(f"training of {name}", figure, "at most 60 minutes of one thread", least)
    seeds = {run["seed"] for run in told.values() if run["variant"] == "correction"}
    yield Point("seeds in the table", f"recorded: {sorted(seeds)}", "three", len(seeds) == 3)
    dirty = [run["commit"] for run in told.values() if not run["commit"].isalnum()]
    yield Point("trained from code that is committed", f"{dirty} not", "all", not dirty)
    best = min(
        (name for name, run in told.items() if run["variant"] == "correction"),
        key=lambda name: float(told[name]["validation"]),
    )
    ships = records[best]["settings"]["model_sha256"] == blend_network().model.hash
    yield Point("the seed ships that validates best", f"recorded: {best}", "it does", ships)
    yield from _again(told[best])


def _again(recorded: Mapping[str, Any]) -> Iterator[Point]:
    """Train the seed that ships again for a minute: the first looks are those recorded."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "stridewire", *recorded["command"].split()[1:]]
        with subprocess.Popen([*command, "--out", folder, "--json"]) as process:
            curve = _curve_after(Path(folder) / CURVE, AGAIN_S, process)
            process.terminate()
    figure = ", ".join(f"step {look['step']:.0f}: {look['validation']:.4f}" for look in curve)
    learnt = len(curve) > 1 and curve[-1]["validation"] < curve[0]["validation"]
    yield Point("trained again for 60 s, loss on validation", figure, "it falls", learnt)
    pairs = list(zip(curve, recorded["curve"], strict=False))
    apart = max((abs(a["validation"] / b["validation"] - 1.0) for a, b in pairs), default=1.0)
    yield Point(
        "of what is recorded at these steps",
        f"{100.0 * apart:.2f} % off",
        "within 2 % (other machines round otherwise)",
        apart < 0.02,
    )


def _curve_after(path: Path, cpu_s: float, process: subprocess.Popen[bytes]) -> Any:
    """Wait until training has worked for a while; return its looks at the validation data."""
    curve: list[dict[str, float]] = []
    while process.poll() is None and (not curve or curve[-1]["cpu_s"] < cpu_s):
        time.sleep(1.0)
        with suppress(FileNotFoundError, json.JSONDecodeError):  # not there yet, or half written
            curve = json.loads(path.read_text())
    return curve
