"""`make show-blend`: postures between postures, by a network, beside linear blending.

Bars stand here as they were asked for. Needs the capture, unpacked (STRIDEWIRE_DATA), and torch for
the stage that trains. Draws `build/show/blend-*.png`.
"""

import os
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
from blend_pictures import draw
from blend_training import training
from blend_wire import bad_input, unary
from points import ROOT, Point, show

from stridewire.motion.array_types import Floats
from stridewire.motion.kinematics import forward_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.blending import Pair, blend
from stridewire_engine.building import open_library
from stridewire_engine.evaluation.blend_methods import as_served, microseconds
from stridewire_engine.evaluation.blend_table import FEWEST, mean_share, rows
from stridewire_engine.evaluation.blending import LINEAR, Measured, measure
from stridewire_engine.evaluation.split_clips import import_clips, split_files
from stridewire_engine.networks.blend import BlendNetwork, Postures, blend_network, features
from stridewire_engine.networks.blend.pairs import Frames, Pairs

DATA = Path(os.environ.get("STRIDEWIRE_DATA", ""))
CARD = ("Data", "Split", "mocap.cs.cmu.edu", "Command", "Machine", "Metrics", "Limits")
TORCHLESS = """
import sys
sys.modules["torch"] = None
from stridewire_engine.networks.blend import blend_network
print(blend_network().model.hash)
"""


class Silenced(BlendNetwork):
    """The shipped network with its output set to nothing."""

    def coefficients(
        self, start: Postures, end: Postures, duration: Floats
    ) -> tuple[Floats, Floats]:
        """Say nothing."""
        coefficients, distance = super().coefficients(start, end, duration)
        return np.zeros_like(coefficients), distance


@cache
def frames(name: str) -> Frames:
    """Return the frames of a data set's test subjects."""
    clips = import_clips(split_files(DATA, name, "test"))
    return Frames.of(clip for clip in clips if clip is not None)


def ends() -> Iterator[Point]:
    """Exact ends, and no step along 101 weights larger than its neighbours suggest."""
    library = open_library()
    rng = np.random.default_rng(5)
    apart, worst, pairs = 0.0, 0.0, 0
    for entry in library.clips[:40]:
        clip = library.clip(entry.name)
        start_s = rng.uniform(0.0, clip.seconds - 1.0)
        end_s = start_s + rng.uniform(0.1, 1.0)
        start, end = clip.sample(start_s), clip.sample(end_s)
        pair = Pair(start, end, np.linspace(0.0, 1.0, 101), np.ones(len(REFERENCE)))
        (blended,) = blend([pair], blend_network())
        for at, side in ((0, start), (-1, end)):
            for name in ("root_position", "root_rotation", "hips", "rotations"):
                difference = getattr(blended.pose, name)[at] - getattr(side, name)
                apart = max(apart, float(np.abs(difference).max()))
        worst = max(worst, _worst_step(forward_world(REFERENCE, blended.pose)[0]))
        pairs += 1
    yield Point(
        f"weights 0 and 1, {pairs} pairs, largest difference", f"{apart:.1e}", "1e-6", apart <= 1e-6
    )
    yield Point(
        "101 weights, largest step over the larger of its neighbours (steps above 2 mm)",
        f"{worst:.2f}",
        "no step larger than its neighbours suggest (2)",
        worst <= 2.0,
    )


def _worst_step(positions: Floats) -> float:
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1)
    beside = np.maximum(np.maximum(steps[:-2], steps[2:]), 2e-3)
    return float((steps[1:-1] / beside).max())


def held_out() -> Iterator[Point]:
    """Figures on subjects that the network never saw."""
    measured = _measured("cmu", 0.25)
    yield from _collisions("cmu", measured)
    yield from _better("cmu", measured)
    lafan1 = _measured("lafan1", 0.5)
    share = mean_share(lafan1, "neural")
    yield Point(
        f"collisions on lafan1 over linear's, mean over {share['durations']} measurable durations",
        _interval(share, "collisions_pct_of_linear", " %"),
    )
    for name in ("position_error_cm", "sliding_c_cm_s"):
        own, linear = (_over_all(lafan1, method)[name] for method in ("neural", LINEAR))
        yield Point(f"{name} on lafan1", f"{own:.2f}, linear {linear:.2f}")


@cache
def _measured(name: str, step: float, silenced: bool = False) -> Measured:
    network = blend_network()
    methods = {"neural": as_served(network)}
    if silenced:
        methods["silenced"] = as_served(Silenced(network.model))
    return measure(frames(name), methods, network.deviation, step=step)


def _over_all(measured: Measured, method: str) -> dict[str, float]:
    table = rows("", "test", measured)
    return next(
        row
        for row in table
        if row["method"] == method
        and row["weight"] == "all"
        and not row["duration_s"]
        and "mse" in row
    )


def _collisions(data: str, measured: Measured) -> Iterator[Point]:
    counts = {
        duration: int(sums["collisions"].total.sum())
        for (duration, method), sums in measured.items()
        if method == LINEAR
    }
    told = ", ".join(f"{duration:g} s {count}" for duration, count in counts.items())
    yield Point(f"linear collisions on {data}, below {FEWEST} not measurable", told)
    share = mean_share(measured, "neural")
    value, high = share["collisions_pct_of_linear"], share["collisions_pct_of_linear_high"]
    yield Point(
        f"collisions on {data} over linear's, mean over {share['durations']} measurable durations",
        _interval(share, "collisions_pct_of_linear", " %"),
        "at least three; at most 70 % of linear with the upper 95 % bound below 85 %",
        share["durations"] >= 3 and value <= 70.0 and high < 85.0,
    )
    second = next(
        row
        for row in rows(data, "test", measured)
        if row["method"] == "neural" and row["duration_s"] == 1.0
    )
    yield Point(
        f"collisions on {data} over linear's at 1.0 s",
        f"{_interval(second, 'collisions_pct_of_linear', ' %')}, the paper's 51.75 %",
    )


def _better(data: str, measured: Measured) -> Iterator[Point]:
    table = [row for row in rows(data, "test", measured) if row["method"] == "neural"]
    for row in table:
        if row["weight"] in (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8):
            yield Point(
                f"end effectors nearer than linear's at weight {row['weight']}",
                _interval(row, "end_effector_gain_cm", " cm"),
                "below linear's, interval over clips excluding 0",
                row["end_effector_gain_cm_low"] > 0.0,
            )
    for name in ("position_error_cm", "sliding_c_cm_s"):
        own, linear = (_over_all(measured, method)[name] for method in ("neural", LINEAR))
        yield Point(
            f"{name} on {data}", f"{own:.2f}, linear {linear:.2f}", "below linear's", own < linear
        )
    own, linear = (_over_all(measured, method)["mse"] for method in ("neural", LINEAR))
    yield Point(f"mse on {data}, in standard deviations", f"{own:.4f}, linear {linear:.4f}")


def _interval(row: dict[str, float], key: str, unit: str) -> str:
    if row[key] is None:
        return "not measurable"
    return f"{row[key]:.2f}{unit} ({row[f'{key}_low']:.2f} to {row[f'{key}_high']:.2f})"


def silenced() -> Iterator[Point]:
    """With the network's output set to nothing the figures get worse."""
    measured = _measured("cmu", 1.0, silenced=True)
    for name in ("position_error_cm", "sliding_c_cm_s"):
        own, without = (_over_all(measured, method)[name] for method in ("neural", "silenced"))
        figure = f"{without:.2f}, with the network {own:.2f}"
        yield Point(f"{name} with the network silenced", figure, "worse", without > own)
    own, without = (
        mean_share(measured, m)["collisions_pct_of_linear"] for m in ("neural", "silenced")
    )
    figure = f"{without:.1f} %, with the network {own:.1f} %"
    yield Point("collisions with the network silenced", figure, "worse", without > own)


def speed() -> Iterator[Point]:
    """The network alone per posture on one thread, a whole blend beside; a unary call over gRPC."""
    network = blend_network()
    pairs = frames("cmu").draw(np.random.default_rng(0), 1024, 1)
    rows = features.inputs(pairs.start, pairs.end, pairs.duration)
    alone = microseconds(lambda p: network.model.run(rows[: len(p)]) and p.truth, pairs)
    read = microseconds(lambda p: network.coefficients(*_read(p)) and p.truth, pairs)
    whole = microseconds(as_served(network), pairs)
    for batch in alone:
        figure = (
            f"{alone[batch] / 1e3:.4f} ms; with features {read[batch] / 1e3:.4f} ms, with blending "
            f"and feet, too, {whole[batch] / 1e3:.4f} ms"
        )
        what = f"network per posture, batch {batch}, one thread"
        if batch == 32:
            bar = "below 0.05 ms at batch 32 (paper: 0.54 ms)"
            yield Point(what, figure, bar, alone[batch] < 50.0)
        else:
            yield Point(what, figure)
    yield from unary()


def _read(pairs: Pairs) -> tuple[Postures, Postures, Floats]:
    return pairs.start, pairs.end, pairs.duration


def model() -> Iterator[Point]:
    """The card says what it must; the network loads where there is no torch."""
    card = (ROOT / "models" / "stridewire_models" / "weights" / "blend.md").read_text()
    missing = [word for word in CARD if word not in card]
    yield Point(f"the card tells {', '.join(CARD)}", f"{missing} missing", "all", not missing)
    done = subprocess.run([sys.executable, "-c", TORCHLESS], capture_output=True, text=True)
    yield Point(
        "loads without torch",
        done.stdout.strip()[:12] or done.stderr[-80:],
        "it does",
        not done.returncode,
    )
    parity = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "tests/unit/models/test_blend_training.py",
        "-k",
        "onnx",
    ]
    done = subprocess.run(parity, cwd=ROOT, capture_output=True, text=True)
    summary = done.stdout.strip().splitlines()[-1]
    yield Point(
        "ONNX equals torch to 1e-4 at three batch sizes", summary, "it does", not done.returncode
    )


def pictures() -> Iterator[Point]:
    """Five weights of the paper's kinds of pairs: network beside linear beside truth."""
    for path in draw(DATA, ROOT / "build" / "show"):
        yield Point(f"contact sheet {path.name}", f"{path.stat().st_size // 1024} kB; look at it")


if __name__ == "__main__":
    sys.exit(show("blend", [ends, held_out, silenced, speed, bad_input, model, training, pictures]))
