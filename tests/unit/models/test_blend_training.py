"""Training: torch agrees with numpy, ONNX with torch, a run learns and goes on where it stopped."""

import importlib.util
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Quaternions
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.evaluation.training_runs import RunError, record
from stridewire_engine.networks.blend import features
from stridewire_engine.networks.blend.network import BlendNetwork, PaperNetwork
from stridewire_engine.networks.blend.pairs import Frames
from stridewire_engine.networks.onnx_model import OnnxModel

if importlib.util.find_spec("torch") is None or importlib.util.find_spec("onnx") is None:
    pytest.skip("training needs torch and onnx", allow_module_level=True)

import torch

from stridewire_models.blend import rotations
from stridewire_models.blend.capsules import penetration
from stridewire_models.blend.export import posture_deviation, read_run, to_onnx
from stridewire_models.blend.networks import VARIANTS, new_network
from stridewire_models.blend.recipes import RECIPES, Recipe
from stridewire_models.blend.training import Run
from stridewire_models.run_folder import CHECKPOINT

PARITY = 1e-4
"""Largest difference of ONNX and torch, in metres, radians or distances."""


@pytest.fixture(scope="module", autouse=True)
def _one_thread() -> None:
    """Small batches are slower on more."""
    torch.set_num_threads(1)


@pytest.fixture(scope="module")
def frames() -> Frames:
    """Return frames of a few synthetic clips."""
    return Frames.of(synthetic_clips()[:6])


def recipe(variant: str, steps: int, batch: int = 32) -> Recipe:
    """Return a short recipe of one phase; few steps move a mean of weights too little."""
    (phase, *_) = RECIPES[variant].phases
    phases = (replace(phase, steps=steps, batch=batch, patience=steps),)
    return replace(RECIPES[variant], phases=phases, averaging=0.0)


def test_kinematics_agree(random_pose: Callable[..., Pose]) -> None:
    """Positions and rotations of joints are those of `stridewire.motion.kinematics`."""
    pose = random_pose(2, 5)
    found = rotations.forward(
        REFERENCE, torch.from_numpy(pose.hips), torch.from_numpy(pose.rotations)
    )
    expected = kinematics.forward(REFERENCE, pose.hips, pose.rotations)
    for mine, theirs in zip(found, expected, strict=True):
        np.testing.assert_allclose(mine.numpy(), theirs, atol=1e-9)


def test_the_exponential_agrees(rng: np.random.Generator) -> None:
    """Rotation vectors of any size, none too, become the same quaternions, with finite slopes."""
    vectors = rng.normal(size=(50, 3)) * np.linspace(0.0, 2.0, 50)[:, None]
    given = torch.from_numpy(vectors).requires_grad_()
    found = rotations.from_scaled_axis(given)
    np.testing.assert_allclose(
        found.detach().numpy(), quaternion.from_scaled_axis(vectors), atol=1e-6
    )
    found.sum().backward()  # type: ignore[no-untyped-call]
    assert torch.isfinite(given.grad).all()


def test_capsules_feel_clapping_hands() -> None:
    """Nobody collides at rest; hands brought together do."""
    hips = torch.tensor([[0.0, 0.95, 0.0]])
    turns = torch.zeros(1, len(REFERENCE), 4)
    turns[..., 0] = 1.0
    assert float(penetration(*rotations.forward(REFERENCE, hips, turns)).sum()) == 0.0
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        turn: Quaternions = quaternion.from_axis_angle((0.0, 1.0, 0.0), sign * 1.85)
        turns[0, REFERENCE.index(f"{side}Arm")] = torch.from_numpy(turn)
    assert float(penetration(*rotations.forward(REFERENCE, hips, turns)).sum()) > 0.01


@pytest.fixture(scope="module", params=VARIANTS)
def run(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, frames: Frames
) -> Run:
    """Return a run of a few steps of each variant."""
    folder = tmp_path_factory.mktemp(request.param)
    trained = Run(folder, recipe(request.param, 120), frames, frames, 0)
    trained.train(lambda done: None, 8)
    return trained


def test_a_run_learns_and_can_be_told(run: Run) -> None:
    """A few steps lower the loss on the validation data; the folder says how it came to be."""
    assert run.progress.best < 0.95 * run.progress.curve[0]["validation"]
    told = record(run.folder)
    assert (told["variant"], told["steps"]) == (run.recipe.variant, 120)
    assert told["validation"] == pytest.approx(run.progress.best, abs=1e-5)


def test_one_posture_is_blended_to_itself(run: Run, frames: Frames) -> None:
    """Between a posture and itself a correction is nothing, whatever the network has learned."""
    if run.recipe.variant == "correction":
        start = frames.draw(np.random.default_rng(0), 5, 1).start
        rows = torch.from_numpy(features.inputs(start, start, np.full(5, 0.5)))
        coefficients, _ = run.network(rows)
        assert not coefficients.any()


def test_a_run_goes_on_where_it_stopped(tmp_path: Path, frames: Frames) -> None:
    """A run cut in two ends with the weights of one that was not."""
    short = recipe("correction", 12, 16)
    whole = Run(tmp_path / "whole", short, frames, frames, 1)
    whole.train(lambda done: None, 4)
    first = Run(tmp_path / "cut", short, frames, frames, 1)
    for _ in range(5):
        first._step()
    first._save()
    assert (tmp_path / "cut" / CHECKPOINT).is_file()
    second = Run(tmp_path / "cut", short, frames, frames, 1)
    assert second.progress.step == 5
    second.train(lambda done: None, 4)
    for mine, theirs in zip(second.network.parameters(), whole.network.parameters(), strict=True):
        torch.testing.assert_close(mine, theirs, atol=1e-6, rtol=0.0)


@pytest.mark.parametrize("batch", [1, 7, 300])
def test_onnx_agrees_with_torch(
    run: Run, frames: Frames, rng: np.random.Generator, batch: int
) -> None:
    """The exported network gives the numbers of the trained one at any batch size."""
    network, told = read_run(run.folder)
    model = OnnxModel("blend.onnx", to_onnx(network, 0, posture_deviation(frames)))
    assert told["variant"] == model.facts["variant"]
    (PaperNetwork if told["variant"] == "paper" else BlendNetwork)(model)
    rows = network.mean + network.deviation * torch.from_numpy(
        rng.normal(size=(batch, model.inputs)).astype(np.float32)
    )
    with torch.no_grad():
        expected = network(rows)
    for mine, theirs in zip(model.run(rows.numpy()), expected, strict=True):
        np.testing.assert_allclose(mine, theirs.numpy(), atol=PARITY)


def test_an_empty_run_cannot_be_exported(tmp_path: Path) -> None:
    """The error says what the folder should be."""
    with pytest.raises(RunError, match="stridewire train blend --out"):
        read_run(tmp_path)


def test_an_untrained_correction_is_the_linear_blend() -> None:
    """It begins at nothing, so that training can only leave the baseline for something better."""
    network = new_network("correction")
    coefficients, _ = network(torch.zeros(2, network.mean.numel()))
    assert not coefficients.any()
