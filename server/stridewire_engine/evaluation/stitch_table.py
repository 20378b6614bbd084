"""Tables of stitching: one flat row for each method, with intervals over takes.

Beside each figure stands its ratio to the spring's and to stance's on the same takes.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from stridewire_engine.evaluation import tally
from stridewire_engine.evaluation.stitch_figures import Figures

TRUTH = "truth"
BESIDE = ("spring", "stance")
_JERKS = ("jerk", "toe_jerk", "knee_jerk")
COMPARED = (
    "sliding_a_cm_s", "sliding_c_cm_s", "position_error_cm", "foot_error_cm", "mse", "npss",
    *_JERKS,
)  # fmt: skip
"""Figures whose ratios are told."""


def rows(about: Mapping[str, Any], measured: Mapping[str, Figures]) -> Iterator[dict[str, Any]]:
    """Yield rows.

    Args:
        about: What all rows say: data, split, path.
        measured: Figures by method, the truth among them.
    """
    truth = measured[TRUTH]
    for method, figures in measured.items():
        row: dict[str, Any] = {**about, "method": method}
        for name, figure in figures.items():
            if name in _JERKS:
                row |= _spread(f"{name}_ratio", *tally.ratio(figure, truth[name]))
            else:
                row |= _spread(name, *tally.interval(figure))
        for other in BESIDE:
            if other in measured and method != TRUTH:
                for name in COMPARED:
                    of = tally.ratio(figures[name], measured[other][name])
                    row |= _spread(f"{name}_of_{other}", *of)
        yield row


def _spread(name: str, value: float, low: float, high: float) -> dict[str, Any]:
    return {
        f"{name}{suffix}": None if np.isnan(number) else round(float(number), 5)
        for suffix, number in zip(("", "_low", "_high"), (value, low, high), strict=True)
    }
