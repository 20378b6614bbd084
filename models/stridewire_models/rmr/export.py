"""Export: from a run's best weights to an ONNX file that says what it is."""

import io
import json
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import onnx
import torch

from stridewire_engine.evaluation.training_runs import CONFIGURATION
from stridewire_engine.networks.rmr.features import INPUTS
from stridewire_engine.networks.rmr.plans import WINDOW
from stridewire_engine.networks.rmr.refiner import facts
from stridewire_models.rmr.networks import Shape, Steps
from stridewire_models.rmr.paper_export import paper_to_onnx, read_paper_run
from stridewire_models.run_folder import BEST

_OPSET = 17
FURTHEST = 2.0
"""Distance from the training data beyond which the network is not used."""
_OUTPUTS = ("curves", "contacts", "distance")


class RunError(ValueError):
    """A run's folder holds nothing to export; the message says what to do."""


def exported(folder: Path) -> tuple[bytes, Mapping[str, object]]:
    """Return the ONNX file of a run's best weights, of whichever variant, and its configuration.

    Raises:
        RunError: If it has none.
    """
    told = _configuration(folder)
    if told["variant"] == "paper":
        paper, told = read_paper_run(folder)
        return paper_to_onnx(paper, told), told
    network, told = read_run(folder)
    return to_onnx(network, int(str(told["seed"]))), told


def read_run(folder: Path) -> tuple[Steps, Mapping[str, object]]:
    """Return a run's best weights and its configuration.

    Raises:
        RunError: If it has none.
    """
    told = _configuration(folder)
    network = Steps(Shape(**told["shape"]))
    network.load_state_dict(torch.load(folder / BEST))
    network.eval()
    return network, told


def to_onnx(network: Steps, seed: int) -> bytes:
    """Return the ONNX file of a network.

    Args:
        network: Trained.
        seed: That it was trained with.
    """
    file = io.BytesIO()
    axes = {name: {0: "batch", 1: "tokens"} for name in _OUTPUTS[:2]}
    with warnings.catch_warnings():
        # the exporter by tracing is deprecated; the other one fixes the length of recurrent layers
        warnings.simplefilter("ignore")
        torch.onnx.export(
            network,
            (torch.zeros(2, WINDOW, INPUTS),),
            file,  # type: ignore[arg-type]  # the exporter by tracing takes a buffer
            dynamo=False,
            opset_version=_OPSET,
            input_names=["plans"],
            output_names=list(_OUTPUTS),
            dynamic_axes={"plans": {0: "batch", 1: "frames"}, **axes, "distance": {0: "batch"}},
        )
    model = onnx.load_from_string(file.getvalue())
    onnx.helper.set_model_props(model, facts("steps", seed=str(seed), furthest=str(FURTHEST)))
    data: bytes = model.SerializeToString()
    return data


def _configuration(folder: Path) -> Mapping[str, Any]:
    configuration, best = folder / CONFIGURATION, folder / BEST
    if not configuration.is_file() or not best.is_file():
        raise RunError(
            f"{folder} holds no {CONFIGURATION} and {BEST}; give the folder of "
            "`stridewire train rmr --out`"
        )
    told: Mapping[str, Any] = json.loads(configuration.read_text())
    return told
