"""Walks that are easy to reckon with, a seam in each, and a network that says what a test wants."""

from dataclasses import dataclass, field

import numpy as np

from stridewire_engine.networks.rmr import Plans, seams_of
from stridewire_engine.networks.rmr.features import INPUTS
from stridewire_engine.networks.rmr.guidance import CURVES, PLANTED
from stridewire_engine.networks.rmr.plans import TOKEN, WINDOW
from stridewire_engine.networks.rmr.refiner import facts


@dataclass
class StandIn:
    """Takes the place of an ONNX model; says the same of every token."""

    curves: np.ndarray = field(default_factory=lambda: np.zeros(CURVES))
    contacts: np.ndarray = field(default_factory=lambda: np.zeros(PLANTED))
    facts: dict[str, str] = field(default_factory=lambda: facts("steps", furthest="2.0"))
    inputs: int = INPUTS
    name: str = "stand-in"
    hash: str = "0"

    def require(self, facts: dict[str, str]) -> None:
        """Accept whatever is required."""

    def run(self, rows: np.ndarray) -> list[np.ndarray]:
        """Return curves, contacts and a distance of 1."""
        n, tokens = len(rows), rows.shape[1] // TOKEN
        return [
            np.broadcast_to(self.curves, (n, tokens, CURVES)),
            np.broadcast_to(self.contacts, (n, tokens, PLANTED)),
            np.ones(n),
        ]


def plans(n: int = 3, seam: int = 20, frames: int = WINDOW) -> Plans:
    """Return plans of bodies that go straight ahead, turned and placed at random, one seam each."""
    rng = np.random.default_rng(0)
    starts = np.zeros((n, frames), bool)
    starts[:, seam] = True
    yaw = np.repeat(rng.uniform(-3.0, 3.0, (n, 1)), frames, axis=1)
    ahead = np.stack([np.sin(yaw), 0.0 * yaw, np.cos(yaw)], axis=-1)
    start = rng.normal(size=(n, 1, 3)) * np.array([1.0, 0.0, 1.0])
    root = start + ahead * np.arange(frames)[:, None] * 0.02
    toes = root[:, :, None] + rng.normal(scale=0.2, size=(n, frames, 2, 3))
    return Plans(
        root,
        yaw,
        root + np.array([0.0, 0.9, 0.0]),
        toes,
        toes + np.array([0.0, 0.05, -0.1]),
        toes + rng.normal(scale=0.05, size=toes.shape),
        rng.random((n, frames, 2)) < 0.5,
        seams_of(starts),
        np.arange(n) % 2 == 0,
    )
