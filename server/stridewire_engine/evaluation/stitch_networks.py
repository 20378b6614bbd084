"""Networks that are measured beside plain ways to hide seams: those that ship, and others."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from stridewire_engine.evaluation.paper_windows import rewritten
from stridewire_engine.evaluation.seam_methods import Method, refined
from stridewire_engine.networks.onnx_model import OnnxModel
from stridewire_engine.networks.rmr import Refiner, shipped_refiner
from stridewire_engine.networks.rmr.paper_refiner import PaperRefiner


class Measured(NamedTuple):
    """A network to measure."""

    method: Method
    budget_min: float | None
    """Minutes of one thread that it was trained for, where it says so."""


def networks(others: Mapping[str, Path]) -> dict[str, Measured]:
    """Return the refiner that ships, and others by name.

    Args:
        others: Files by name.

    Raises:
        ModelError: If one is damaged or none of this code's.
        OSError: If one cannot be read.
    """
    out = {"refine": Measured(refined(shipped_refiner()), None)}
    for name, path in others.items():
        out[name] = _opened(OnnxModel(path.name, path.read_bytes()))
    return out


def _opened(model: OnnxModel) -> Measured:
    if model.facts.get("variant") == "paper":
        paper = PaperRefiner(model)
        return Measured(rewritten(paper.refine), paper.budget_min)
    return Measured(refined(Refiner(model)), None)
