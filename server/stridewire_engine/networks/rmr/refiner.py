"""The refiner: load, check, run."""

from functools import cache

import numpy as np

from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.onnx_model import (
    ModelError,
    OnnxModel,
    is_listed,
    shipped_model,
)
from stridewire_engine.networks.rmr import features
from stridewire_engine.networks.rmr.guidance import Guidance, guidance
from stridewire_engine.networks.rmr.plans import TOKEN, WINDOW, Plans

FEATURES = "1"
"""Version of the features; another one needs other weights."""


def facts(variant: str, **more: str) -> dict[str, str]:
    """Return what a model of this code says of itself."""
    return {
        "network": "rmr",
        "variant": variant,
        "features": FEATURES,
        "skeleton": REFERENCE.hash,
        **more,
    }


class Refiner:
    """Says, for many plans at once, when feet are planted and where their swings should lead."""

    def __init__(self, model: OnnxModel) -> None:
        """Check a model.

        Raises:
            ModelError: If it was made for other features, another skeleton or another network.
        """
        model.require(facts("steps"))
        if model.inputs != features.INPUTS:
            raise ModelError(
                f"{model.name} reads {model.inputs} numbers, expected {features.INPUTS}; "
                "export it again"
            )
        self.model = model
        self.furthest = float(model.facts["furthest"])
        """Distance from the training data beyond which its answer is not to be used."""

    def refine(self, plans: Plans) -> Guidance:
        """Return guidance for plans; the network alone decides, `furthest` is for the caller.

        Raises:
            ValueError: If the number of frames is no multiple of four.
        """
        if plans.frames % TOKEN or not plans.frames:
            raise ValueError(f"plans of {plans.frames} frames; expected a multiple of {TOKEN}")
        curves, contacts, distance = self.model.run(features.inputs(plans))
        return guidance(plans, curves, contacts, distance)


@cache
def shipped_refiner() -> Refiner:
    """Return the refiner that ships, loaded once and warm.

    Raises:
        ModelError: If it is damaged or missing.
    """
    refiner = Refiner(shipped_model("rmr"))
    refiner.model.run(np.zeros((1, WINDOW, features.INPUTS), np.float32))
    return refiner


def refiner_if_shipped() -> Refiner | None:
    """Return the refiner that ships; None in an installation whose list of models has none.

    Raises:
        ModelError: If it is listed, but damaged or missing.
    """
    return shipped_refiner() if is_listed("rmr") else None
