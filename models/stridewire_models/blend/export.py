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
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.network import facts
from stridewire_engine.networks.blend.pairs import Frames, Pairs
from stridewire_models.blend.losses import flatten
from stridewire_models.blend.networks import SHAPES, Correction, Paper, new_network
from stridewire_models.blend.training import BEST, CONFIGURATION

_OPSET = 17
_FURTHEST_SHARE = 99.9
_MARGIN = 1.2
_PAIRS = 20_000


class RunError(ValueError):
    """A run's folder holds nothing to export; the message says what to do."""


def read_run(folder: Path) -> tuple[Correction | Paper, Mapping[str, object]]:
    """Return a run's best weights and its configuration.

    Raises:
        RunError: If it has none.
    """
    configuration, best = folder / CONFIGURATION, folder / BEST
    if not configuration.is_file() or not best.is_file():
        raise RunError(
            f"{folder} holds no {CONFIGURATION} and {BEST}; give the folder of "
            "`stridewire train blend --out`"
        )
    told: Mapping[str, object] = json.loads(configuration.read_text())
    network = new_network(str(told["variant"]))
    network.load_state_dict(torch.load(best))
    network.eval()
    return network, told


def furthest(network: Correction | Paper, validation: Frames) -> float:
    """Return the distance that all but a thousandth of validation pairs stay below, and a fifth."""
    pairs = flatten(validation.draw(np.random.default_rng(1), _PAIRS, 1))
    with torch.no_grad():
        _, distance = network(torch.from_numpy(_inputs(network, pairs)))
    return float(np.percentile(distance.numpy(), _FURTHEST_SHARE)) * _MARGIN


def to_onnx(network: Correction | Paper, seed: int, threshold: float) -> bytes:
    """Return the ONNX file of a network.

    Args:
        network: Trained.
        seed: That it was trained with.
        threshold: Distance from the training data beyond which not to use it.
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
    more = {"seed": str(seed), "furthest": f"{threshold:.4f}"}
    if isinstance(network, Correction):
        more["bounds"] = json.dumps([round(float(b), 5) for b in network.bounds.tolist()])
    onnx.helper.set_model_props(model, facts(variant, **more))
    data: bytes = model.SerializeToString()
    return data


def _inputs(network: Correction | Paper, pairs: Pairs) -> Floats:
    if isinstance(network, Paper):
        return features.paper_inputs(pairs.start, pairs.end, pairs.weights[:, 0])
    return features.inputs(pairs.start, pairs.end, pairs.duration)
