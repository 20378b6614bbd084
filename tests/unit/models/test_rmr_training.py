"""Training the refiner: torch's feet are the stitcher's, ONNX is torch, runs learn and go on."""

import importlib.util
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.evaluation.seams import Windows, stitched
from stridewire_engine.networks.onnx_model import OnnxModel
from stridewire_engine.networks.rmr import Refiner
from stridewire_engine.networks.rmr.assembly import assemble
from stridewire_engine.networks.rmr.features import INPUTS, PlanFrame
from stridewire_engine.networks.rmr.guidance import guidance
from stridewire_engine.networks.rmr.live import LiveMaker
from stridewire_engine.networks.rmr.pairs import PairMaker
from stridewire_engine.networks.rmr.takes import TOES, Takes
from stridewire_engine.stitchers.legs import leg_pose
from stridewire_engine.stitchers.stance import Stance

if importlib.util.find_spec("torch") is None or importlib.util.find_spec("onnx") is None:
    pytest.skip("training needs torch and onnx", allow_module_level=True)

import torch

from stridewire_models.rmr.export import RunError, read_run, to_onnx
from stridewire_models.rmr.losses import guide
from stridewire_models.rmr.networks import Steps
from stridewire_models.rmr.recipes import STEPS, StepsRecipe
from stridewire_models.rmr.supply import live_tensors, tensors
from stridewire_models.rmr.variants import steps_run
from stridewire_models.run_folder import CHECKPOINT

PARITY = 1e-4
"""Largest difference of ONNX and torch, in their own numbers."""


@pytest.fixture(scope="module", autouse=True)
def _one_thread() -> None:
    """Small batches are slower on more."""
    torch.set_num_threads(1)


@pytest.fixture(scope="module")
def takes() -> Takes:
    """Return synthetic walks and runs, mirrored."""
    return Takes.of(clip for clip in synthetic_clips() if len(clip) < 400)


def recipe(steps: int) -> StepsRecipe:
    """Return a short recipe; few steps move a mean of weights too little."""
    return replace(
        STEPS,
        steps=steps,
        batch=12,
        learning_rate=5e-3,
        pool=24,
        averaging=0.0,
        fresh_every=15,
    )


def untrained(takes: Takes) -> Steps:
    """Return a network that says something."""
    torch.manual_seed(0)
    network = Steps()
    pairs = PairMaker(takes).make(takes.windows(90), np.random.default_rng(0))
    network.fit(tensors(takes, pairs).x.numpy())
    for values in network.decoder[-1].parameters():
        torch.nn.init.normal_(values, std=0.1)
    return network.eval()


def test_the_losses_feet_are_the_stitchers(takes: Takes) -> None:
    """Where training thinks that toes go, guided stance takes them, but for what legs reach."""
    pairs = PairMaker(takes).make(takes.windows(90), np.random.default_rng(0))
    network, batch, made = untrained(takes), tensors(takes, pairs), assemble(takes, pairs)
    with torch.no_grad():
        curves, contacts, distance = (part.numpy() for part in network(batch.x))
        expected = guide(network, batch).toes.numpy()
    windows = Windows(takes, pairs, made.plans.root, made.plans.yaw)
    said = guidance(made.plans, curves, contacts, distance)
    shown = stitched(windows, Stance(), said)
    n, t = made.plans.yaw.shape
    local = leg_pose(
        windows.legs, shown.hips.reshape(n * t, 3), shown.rotations.reshape(n * t, -1, 4)
    ).toe
    world = np.stack(
        [
            windows.roots(np.arange(n), f).to_world(local.reshape(n, t, 2, 3)[:, f])
            for f in range(t)
        ],
        axis=1,
    )
    away = np.abs(PlanFrame.of(made.plans).enter(world) - expected)
    assert np.median(away[..., [0, 2]]) < 1e-3
    assert np.mean(away[..., [0, 2]]) < 0.01


@pytest.mark.parametrize(("plans", "frames"), [(1, 60), (5, 36), (3, 120)])
def test_onnx_agrees_with_torch(takes: Takes, plans: int, frames: int) -> None:
    """The exported file says the same at sizes other than the example's, and says what it is."""
    network = untrained(takes)
    model = OnnxModel("test", to_onnx(network, 3))
    assert Refiner(model).furthest > 0.0
    x = np.random.default_rng(1).normal(size=(plans, frames, INPUTS)).astype(np.float32)
    with torch.no_grad():
        expected = network(torch.from_numpy(x))
    for ours, theirs in zip(model.run(x), expected, strict=True):
        np.testing.assert_allclose(ours, theirs.numpy(), atol=PARITY)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_run_learns_and_goes_on(takes: Takes, tmp_path: Path) -> None:
    """The loss falls; a run that stopped half way ends where one that did not stop ends."""
    whole = steps_run(tmp_path / "whole", recipe(40), takes, takes, 0)
    whole.train(lambda steps: None, 10)
    curve = [row["validation"] for row in whole.progress.curve]
    assert curve[-1] < 0.98 * curve[0]
    half = steps_run(tmp_path / "half", recipe(40), takes, takes, 0)
    half.recipe = replace(half.recipe, steps=20)
    half.train(lambda steps: None, 10)
    assert (tmp_path / "half" / CHECKPOINT).is_file()
    rest = steps_run(tmp_path / "half", recipe(40), takes, takes, 0)
    assert rest.progress.step == 20
    rest.train(lambda steps: None, 10)
    assert read_run(tmp_path / "half")[1]["seed"] == 0
    assert rest.progress.best == pytest.approx(whole.progress.best, rel=0.05)


def test_live_plans_aim_at_their_clip(takes: Takes) -> None:
    """An untouched network leaves live plans to the clips, and the first frames as they were."""
    batch = live_tensors(LiveMaker(takes), 20, np.random.default_rng(0))
    assert not batch.x[..., -1].any()
    assert batch.pull[:, -1].min() == 1.0
    assert torch.equal(batch.true_labels, batch.labels)
    head = batch.since < 0
    assert torch.allclose(batch.head[head], guide(Steps(), batch).toes[head], atol=0.05)


def test_an_empty_folder_is_no_run(tmp_path: Path) -> None:
    """Exporting says what to give instead."""
    with pytest.raises(RunError, match="stridewire train rmr"):
        read_run(tmp_path)


def test_toes_are_the_references() -> None:
    """The toes that training plants are the last joints of both feet."""
    assert TOES.tolist() == [4, 8]
