"""Export of the paper's network: from a run's best weights to an ONNX file that says what it is."""

import io
import json
import warnings
from collections.abc import Mapping
from pathlib import Path

import onnx
import torch

from stridewire_engine.evaluation.training_runs import CONFIGURATION, CURVE
from stridewire_engine.networks.rmr.paper_poses import NUMBERS
from stridewire_engine.networks.rmr.plans import WINDOW
from stridewire_engine.networks.rmr.refiner import facts
from stridewire_models.rmr.paper_networks import PaperNetwork
from stridewire_models.run_folder import BEST

_OPSET = 17


def read_paper_run(folder: Path) -> tuple[PaperNetwork, Mapping[str, object]]:
    """Return a run's best weights and its configuration, with the minutes that it took."""
    told = json.loads((folder / CONFIGURATION).read_text())
    network = PaperNetwork(told["cell"], told["width"])
    network.load_state_dict(torch.load(folder / BEST))
    network.eval()
    spent = json.loads((folder / CURVE).read_text())[-1]["cpu_s"] / 60.0
    return network, {**told, "budget_min": round(spent, 1)}


def paper_to_onnx(network: PaperNetwork, told: Mapping[str, object]) -> bytes:
    """Return the ONNX file of a network.

    Args:
        network: Trained.
        told: Configuration of its run, with `budget_min`.
    """
    file = io.BytesIO()
    axes = {0: "batch", 1: "frames"}
    with warnings.catch_warnings():
        # the exporter by tracing is deprecated; the other one fixes the length of recurrent layers
        warnings.simplefilter("ignore")
        torch.onnx.export(
            network,
            (torch.zeros(2, WINDOW, NUMBERS),),
            file,  # type: ignore[arg-type]  # the exporter by tracing takes a buffer
            dynamo=False,
            opset_version=_OPSET,
            input_names=["poses"],
            output_names=["refined"],
            dynamic_axes={"poses": axes, "refined": axes},
        )
    model = onnx.load_from_string(file.getvalue())
    more = {name: str(told[name]) for name in ("seed", "cell", "budget_min")}
    onnx.helper.set_model_props(model, facts("paper", **more))
    data: bytes = model.SerializeToString()
    return data
