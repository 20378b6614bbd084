"""The networks that blend: load, check, run."""

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.correction import CHANNELS, correct, linear, settle_ends
from stridewire_engine.networks.blend.features import JOINTS, read_postures
from stridewire_engine.networks.blend.postures import Postures
from stridewire_engine.networks.onnx_model import ModelError, OnnxModel, shipped_model

FEATURES = "1"
"""Version of the features; another one needs other weights."""


class Between(NamedTuple):
    """Postures between N pairs."""

    postures: Postures
    """`(N, W)`."""
    distance: Floats
    """`(N,)` from the training data; about 1 for pairs like those."""


def facts(variant: str, **more: str) -> dict[str, str]:
    """Return what a model of this code says of itself."""
    return {
        "network": "blend",
        "variant": variant,
        "features": FEATURES,
        "skeleton": REFERENCE.hash,
        **more,
    }


class BlendNetwork:
    """Corrects linear blends, by at most the bounds, and nothing at the ends."""

    def __init__(self, model: OnnxModel) -> None:
        """Check a model.

        Raises:
            ModelError: If it was made for other features, another skeleton or another network.
        """
        model.require(facts("correction"))
        if model.inputs != features.INPUTS:
            raise ModelError(
                f"{model.name} reads {model.inputs} numbers, expected {features.INPUTS}; "
                "export it again"
            )
        self.model = model
        self.bounds = _numbers(model, "bounds", CHANNELS)
        """`(CHANNELS,)` largest corrections; metres, radians."""
        self.deviation = _numbers(model, "deviation", features.POSTURE_SIZE)
        """`(135,)` standard deviations of postures, as the paper writes them, in training."""
        self.furthest = float(model.facts["furthest"])
        """Distance from the training data beyond which its answer is not to be used."""

    def between(self, start: Postures, end: Postures, weights: Floats, duration: Floats) -> Between:
        """Blend pairs.

        Args:
            start: `(N,)` in the pairs' frames.
            end: `(N,)`.
            weights: `(N, W, J)` weight of each joint.
            duration: `(N,)` seconds between them; 0 where unknown.
        """
        coefficients, distance = self.coefficients(start, end, duration)
        blend = linear(start[:, None], end[:, None], weights)
        return Between(correct(blend, coefficients[:, None], self.bounds, weights), distance)

    def coefficients(
        self, start: Postures, end: Postures, duration: Floats
    ) -> tuple[Floats, Floats]:
        """Return what the network says: coefficients `(N, ORDER, CHANNELS)`, distance `(N,)`."""
        coefficients, distance = self.model.run(features.inputs(start, end, duration))
        return coefficients, distance


class PaperNetwork:
    """The network of Gaisbauer et al. 2019: the posture itself, settled to the linear ends."""

    def __init__(self, model: OnnxModel) -> None:
        """Check a model.

        Raises:
            ModelError: If it was made for other features, another skeleton or another network.
        """
        model.require(facts("paper"))
        self.model = model
        self.deviation = _numbers(model, "deviation", features.POSTURE_SIZE)
        """`(135,)` standard deviations of postures, as the paper writes them, in training."""

    def between(self, start: Postures, end: Postures, weights: Floats, duration: Floats) -> Between:
        """Blend pairs; the same weight for all joints `(N, W, J)`, the duration is not read."""
        count = weights.shape[1]
        of = np.arange(len(weights)).repeat(count)
        flat = weights[:, :, 0].reshape(-1)
        written, distance = self.model.run(features.paper_inputs(start[of], end[of], flat))
        shape = (len(weights), count, features.POSTURE_SIZE)
        generated = read_postures(written.reshape(shape))
        return Between(
            settle_ends(linear(start[:, None], end[:, None], weights), generated, weights),
            distance.reshape(-1, count).max(axis=1),
        )


def load_network(path: Path) -> BlendNetwork | PaperNetwork:
    """Open a network of either variant from a file.

    Raises:
        ModelError: If it is none.
        OSError: If it cannot be opened.
    """
    model = OnnxModel(path.name, path.read_bytes())
    return PaperNetwork(model) if model.facts.get("variant") == "paper" else BlendNetwork(model)


def _numbers(model: OnnxModel, name: str, count: int) -> Floats:
    values = np.array(json.loads(model.facts.get(name, "[]")), np.float32)
    if values.shape != (count,):
        raise ModelError(
            f"{model.name} has {values.size} {name}, expected {count}; export it again"
        )
    return values


def joint_weights(weights: Floats, mask: Mapping[str, float] | None = None) -> Floats:
    """Return weights `(..., J)` of joints from weights `(...)` and the share that joints take."""
    shares = np.ones(JOINTS, np.float32)
    for name, share in (mask or {}).items():
        shares[REFERENCE.index(name)] = share
    return np.asarray(weights, np.float32)[..., None] * shares


@cache
def blend_network() -> BlendNetwork:
    """Return the network that ships, loaded once and warm.

    Raises:
        ModelError: If it is damaged or missing.
    """
    network = BlendNetwork(shipped_model("blend"))
    network.model.run(np.zeros((1, features.INPUTS), np.float32))
    return network
