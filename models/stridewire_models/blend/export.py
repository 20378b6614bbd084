"""Export: from a run's best weights to an ONNX file that says what it is."""

import io
import json
import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import onnx
import torch

from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation.training_runs import RunError, configuration
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.network import facts
from stridewire_engine.networks.blend.pairs import Frames
from stridewire_models.blend.networks import SHAPES, Correction, Paper, new_network
from stridewire_models.run_folder import BEST

_OPSET = 17
FURTHEST = 2.0
"""Distance from the training data beyond which the network is not used: it gained nothing there."""
_PAIRS = 20_000


def read_run(folder: Path) -> tuple[Correction | Paper, Mapping[str, object]]:
    """Return a run's best weights and its configuration.

    Raises:
        RunError: If it has none.
    """
    told, best = configuration(folder), folder / BEST
    if not best.is_file():
        raise RunError(f"{folder} holds no {BEST}: its training has not come to a first look yet")
    network = new_network(str(told["variant"]))
    network.load_state_dict(torch.load(best))
    network.eval()
    return network, told


def posture_deviation(train: Frames) -> Floats:
    """Return standard deviations `(135,)` of training postures, as the paper writes them."""
    pairs = train.draw(np.random.default_rng(1), _PAIRS, 1)
    return np.asarray(features.write_postures(pairs.truth[:, 0]).std(axis=0))


def to_onnx(network: Correction | Paper, seed: int, deviation: Floats) -> bytes:
    """Return the ONNX file of a network.

    Args:
        network: Trained.
        seed: That it was trained with.
        deviation: `(135,)` of the postures that it was trained on.
    """
    variant = "paper" if isinstance(network, Paper) else "correction"
    shape = SHAPES[variant]
    file = io.BytesIO()
    with warnings.catch_warnings():
        # the exporter by tracing is deprecated; the other one needs onnxscript
        warnings.simplefilter("ignore")
        torch.onnx.export(
            network,
            (torch.zeros(2, shape.inputs),),
            file,  # type: ignore[arg-type]  # the exporter by tracing takes a buffer
            dynamo=False,
            opset_version=_OPSET,
            input_names=["pairs"],
            output_names=[shape.output, "distance"],
            dynamic_axes={name: {0: "batch"} for name in ("pairs", shape.output, "distance")},
        )
    model = onnx.load_from_string(file.getvalue())
    more = {
        "seed": str(seed),
        "furthest": str(FURTHEST),
        "deviation": _list(deviation),
    }
    if isinstance(network, Correction):
        more["bounds"] = _list(network.bounds.numpy())
    onnx.helper.set_model_props(model, facts(variant, **more))
    data: bytes = model.SerializeToString()
    return data


def _list(values: Floats) -> str:
    return json.dumps([round(float(value), 5) for value in values])
