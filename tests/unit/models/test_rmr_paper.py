"""The paper's network: it begins as springs, learns, and reads poses as the engine does."""

import importlib.util
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.networks.rmr.takes import Takes

if importlib.util.find_spec("torch") is None or importlib.util.find_spec("onnx") is None:
    pytest.skip("training needs torch and onnx", allow_module_level=True)

import torch

from stridewire_engine.networks.onnx_model import OnnxModel
from stridewire_engine.networks.rmr import paper_poses
from stridewire_engine.networks.rmr.paper_poses import NUMBERS, POINTS, ROOT, ROTATIONS
from stridewire_engine.networks.rmr.paper_refiner import PaperRefiner
from stridewire_models.rmr.paper_export import paper_to_onnx
from stridewire_models.rmr.paper_losses import lower_body, paper_loss, root_path
from stridewire_models.rmr.paper_networks import CELLS, PaperNetwork
from stridewire_models.rmr.paper_task import PaperData, PaperTask, refine
from stridewire_models.rmr.recipes import PAPER
from stridewire_models.rmr.training import Run

PARITY = 1e-4
"""Largest difference of ONNX and torch, in their own numbers."""


@pytest.fixture(scope="module")
def data() -> PaperData:
    """Return pairs of synthetic walks and runs."""
    torch.set_num_threads(1)
    takes = Takes.of(clip for clip in synthetic_clips() if len(clip) < 400)
    return PaperData(takes, takes)


@pytest.mark.parametrize("cell", CELLS)
def test_it_begins_as_what_it_reads(data: PaperData, cell: str) -> None:
    """An untrained network of each cell leaves springs as they are."""
    network = PaperNetwork(cell, 8).eval()  # type: ignore[arg-type]
    network.fit(data.x, data.truth)
    made = refine(network, data.x[:3])
    np.testing.assert_allclose(made[..., :-2], data.x[:3, :, :-2], atol=1e-6)
    assert ((made[..., -2:] > 0.0) == (data.x[:3, :, -2:] > 0.5)).all()


def test_losses_read_poses_as_the_engine_does(data: PaperData) -> None:
    """Torch's joints and root paths are those that the numbers were written from."""
    x = torch.from_numpy(data.truth[:5])
    joints = lower_body(x[..., POINTS][..., :3], x[..., ROTATIONS]).flatten(-2)
    torch.testing.assert_close(joints, x[..., POINTS], atol=1e-5, rtol=0.0)
    path, yaw = paper_poses.root_path(data.truth[:5, :, ROOT])
    ours = root_path(x[..., ROOT]).numpy()
    np.testing.assert_allclose(ours[..., 2], yaw, atol=1e-5)
    np.testing.assert_allclose(ours[..., :2], path[..., [0, 2]], atol=1e-5)


def test_each_loss_sees_its_own(data: PaperData) -> None:
    """The beginning counts against the input, the path only where it has weight."""
    network = PaperNetwork("gru", 8).eval()
    network.fit(data.x, data.truth)
    x = torch.from_numpy(data.x[:4])
    truth = x.clone()
    truth[..., 0] += 0.01
    with torch.no_grad():
        parts = paper_loss(network, x, truth, 5, 0.0)
        followed = paper_loss(network, x, truth, 5, 1.0)
    assert parts["begin"] == 0.0
    assert parts["trajectory"] == 0.0
    assert followed["trajectory"] > 0.05
    assert x.shape[-1] == NUMBERS


def test_a_run_learns_its_pairs(data: PaperData, tmp_path: Path) -> None:
    """Steps on a handful of pairs bring poses nearer to the take's than springs do."""
    recipe = replace(PAPER, steps=60, width=48, batch=8, pool=8, averaging=0.0, learning_rate=3e-3)
    torch.manual_seed(0)
    task = PaperTask(recipe, data)
    before = float(task.loss(np.random.default_rng(0)).detach())
    Run(tmp_path, recipe, task, 0).train(lambda steps: None, 60)
    assert float(task.loss(np.random.default_rng(0)).detach()) < 0.9 * before


def test_the_exported_file_says_the_same(data: PaperData) -> None:
    """ONNX agrees with torch at other sizes than the example's, and slides over long motions."""
    network = PaperNetwork("blstm", 8).eval()
    network.fit(data.x, data.truth)
    torch.nn.init.normal_(network.decoder[-1].weight, std=0.3)
    told = {"seed": 0, "cell": "blstm", "budget_min": 1.0}
    refiner = PaperRefiner(OnnxModel("test", paper_to_onnx(network, told)))
    assert refiner.budget_min == 1.0
    for numbers in (data.x[:1], data.x[:5, :36], np.concatenate([data.x[:3], data.x[3:6]], axis=1)):
        np.testing.assert_allclose(
            refiner.refine(numbers), refine(network, numbers), atol=PARITY, rtol=0.0
        )
    long = np.concatenate([data.x[:2], data.x[2:4]], axis=1)
    slid = refiner.slide(long)
    np.testing.assert_allclose(slid[:, :30, :-2], refiner.refine(long[:, :60])[:, :30, :-2])
    assert np.abs(slid - long).max() > 0.0
