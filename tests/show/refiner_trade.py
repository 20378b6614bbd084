"""Train the refiner in other shapes, and tell what each costs and how good it is.

`STRIDEWIRE_DATA=DIR python tests/show/refiner_trade.py OUT` trains each shape for as many steps
from one seed, three to eight minutes of one thread each, measures it on CMU's validation subjects,
and puts its row into `docs/results/refiner-trade.json`. What has a row is not trained again.
"""

import json
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from capture import capture
from points import ROOT

from stridewire_engine.networks.onnx_model import OnnxModel
from stridewire_engine.networks.rmr.features import INPUTS
from stridewire_engine.networks.rmr.plans import WINDOW
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.commands.split_import import clips_of
from stridewire_models.rmr.export import exported
from stridewire_models.rmr.networks import Shape
from stridewire_models.rmr.recipes import STEPS
from stridewire_models.rmr.variants import steps_run

RESULTS = ROOT / "docs" / "results" / "refiner-trade.json"
SHAPES: Mapping[str, Shape] = {
    "what ships": Shape(),
    "width 64": Shape(width=64),
    "width 256": Shape(width=256),
    "tokens of 2 frames": Shape(token=2),
    "tokens of 12 frames": Shape(token=12),
    "window of 40 frames": Shape(window=40),
    "one way": Shape(mixing="one way"),
    "dilated convolution": Shape(mixing="convolution"),
    "dilated convolution, width 64": Shape(width=64, mixing="convolution"),
}
_STEPS, _LOOK_EVERY = 2_000, 200
_PARTS = ("train", "validation")
_BATCHES = (1, 8, 32)
_ROUNDS = 60
_FIGURES = (
    "sliding_a_cm_s", "sliding_c_cm_s", "position_error_cm", "foot_error_cm", "toe_jerk",
    "knee_jerk",
)  # fmt: skip


def row(name: str, folder: Path, train: Takes, validation: Takes) -> dict[str, Any]:
    """Train a shape in a folder, where an unfinished run goes on; return what is told of it."""
    recipe = replace(STEPS, steps=_STEPS, shape=SHAPES[name])
    run = steps_run(folder, recipe, train, validation, 0)
    run.train(lambda done: None, _LOOK_EVERY)
    file = folder / "rmr.onnx"
    file.write_bytes(exported(folder)[0])
    return {
        "shape": name,
        **asdict(SHAPES[name]),
        "steps": run.progress.step,
        "training_cpu_min": round(run.progress.cpu_s / 60.0, 2),
        "validation": round(run.progress.best, 5),
        "weights": file.stat().st_size,
        **_measured(file),
    }


def costs(file: Path) -> dict[str, float]:
    """Return microseconds of processor time a window at each batch: the median of many rounds."""
    model = OnnxModel(file.name, file.read_bytes())
    told = {}
    for batch in _BATCHES:
        numbers = np.random.default_rng(0).normal(size=(batch, WINDOW, INPUTS)).astype(np.float32)
        taken = []
        for _ in range(_ROUNDS):
            began = time.process_time()
            model.run(numbers)
            taken.append(time.process_time() - began)
        told[f"us_at_{batch}"] = round(float(np.median(taken)) / batch * 1e6, 1)
    return told


def _measured(file: Path) -> dict[str, Any]:
    command = [
        sys.executable, "-m", "stridewire", "evaluate", "stitch", "--split", "validation",
        "--network", f"trial={file}", "--json",
    ]  # fmt: skip
    found = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)
    measured = next(row for row in found["rows"] if row["method"] == "trial")
    keys = [f"{name}_of_spring{end}" for name in _FIGURES for end in ("", "_low", "_high")]
    return {key: measured[key] for key in (*keys, "npss")}


def _main(out: Path) -> None:
    torch.set_num_threads(1)
    torch.set_flush_denormal(True)
    train, validation = (Takes.of(clips_of(capture(), part, True)) for part in _PARTS)
    rows = json.loads(RESULTS.read_text())["rows"] if RESULTS.exists() else []
    for name in SHAPES:
        folder = out / name.replace(" ", "-")
        if name not in {row["shape"] for row in rows}:
            rows.append(row(name, folder, train, validation))
    # all in one sitting, so that they can be compared
    rows = [{**row, **costs(out / row["shape"].replace(" ", "-") / "rmr.onnx")} for row in rows]
    command = "python tests/show/refiner_trade.py OUT"
    RESULTS.write_text(json.dumps({"settings": {"command": command}, "rows": rows}, indent=1))


if __name__ == "__main__":
    _main(Path(sys.argv[1]))
