"""The paper's figure 9: how far roots stray with and without the loss of the root's path."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation.root_drift import long_motions, root_distance
from stridewire_engine.networks.onnx_model import OnnxModel
from stridewire_engine.networks.rmr.paper_refiner import PaperRefiner
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_models.rmr.export import exported

WITH, WITHOUT = "bgru", "no-trajectory"
"""Names of the trainings."""
_LENGTHS = (360, 3_600)
_MOTIONS = 16
_POINTS = 60
"""Of each curve."""


def drift_rows(runs: Path, validation: Floats, test: Takes) -> Iterator[dict[str, Any]]:
    """Yield curves over time, in centimetres: of the validation pairs, and of long motions.

    Args:
        runs: Folder of the trainings.
        validation: Pairs as they are read, `(N, T, 191)`.
        test: Takes that nothing was trained or chosen on.
    """
    networks = {name: _network(runs / name) for name in (WITH, WITHOUT)}
    for motions in (validation, *(long_motions(test, n, _MOTIONS, 0) for n in _LENGTHS)):
        frames = motions.shape[1]
        shown = np.arange(_POINTS) * (frames // _POINTS) + frames // _POINTS - 1
        row: dict[str, Any] = {
            "drift": "validation pairs" if motions is validation else "test motions",
            "motions": len(motions),
            "frames": frames,
            "frame": shown.tolist(),
        }
        for name, network in networks.items():
            away = 100.0 * root_distance(network.slide(motions), motions)
            row[f"{name}_cm"] = np.round(away.mean(axis=0)[shown], 3).tolist()
            row[f"{name}_last_cm"] = round(float(away[:, -1].mean()), 3)
        yield row


def draw_drift(rows: list[dict[str, Any]], path: Path) -> None:
    """Draw the curves, one panel a length."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(rows), 3.2), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, row in zip(figure.subplots(1, len(rows)), rows, strict=True):
        axes.plot(row["frame"], row[f"{WITH}_cm"], color="#3b6ea5", label="with the path's loss")
        axes.plot(row["frame"], row[f"{WITHOUT}_cm"], color="#c0504d", label="without")
        axes.set_title(f"{row['motions']} {row['drift']}, {row['frames']} frames", fontsize=9)
        axes.set_xlabel("frame")
        axes.set_ylabel("root from its path, cm")
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=80)


def _network(run: Path) -> PaperRefiner:
    return PaperRefiner(OnnxModel(run.name, exported(run)[0]))
