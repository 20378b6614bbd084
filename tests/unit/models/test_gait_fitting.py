"""Fitting the gait model: what was drawn with known steps is measured and fitted again."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stridewire.motion.clip import Clip
from stridewire.motion.mirror import mirror_clip
from stridewire_engine.building.gait.draw import draw_clip
from stridewire_engine.building.gait.model import GaitModel, decode, design
from stridewire_engine.building.gait.script import Segment
from stridewire_models.commands.train import train
from stridewire_models.gait.fitting import fit
from stridewire_models.gait.measuring import measure_standing, measure_steps
from stridewire_models.gait.takes import TRIALS, MissingCaptureError, take_files

MODEL = GaitModel.shipped()
HELD_OUT = {"06", "08", "16", "86", "94", "07", "09", "10", "12", "26", "27", "29"}


def _clip(speed: float, turn: float = 0.0, seed: int = 0) -> Clip:
    script = [Segment(1.0), Segment(5.0, speed, turn), Segment(1.5)]
    return draw_clip(MODEL, f"{speed}-{turn}", script, np.random.default_rng(seed))


@pytest.mark.parametrize(("speed", "runs"), [(0.8, False), (1.4, False), (3.3, True)])
def test_steps_are_found_with_their_speed_and_gait(speed: float, runs: bool) -> None:
    """A steady clip shows the speed and the gait that it was drawn with, and alternating steps."""
    steps = measure_steps(_clip(speed), "s")
    assert steps is not None
    steady = np.abs(steps.acceleration) < 0.1
    assert abs(np.median(steps.speed[steady]) - speed) < 0.05
    assert np.mean(steps.run[steady] == runs) > 0.95
    assert np.all(np.diff(steps.phase)[np.diff(steps.step) == 0] >= 0.0)


def test_turning_is_positive_to_the_left() -> None:
    """A left curve has the turning rate of its script."""
    steps = measure_steps(_clip(1.2, turn=0.6), "s")
    assert steps is not None
    steady = np.abs(steps.acceleration) < 0.1
    assert abs(np.median(steps.turn[steady]) - 0.6) < 0.06


def test_a_standing_clip_has_standing_frames_and_no_steps() -> None:
    """Standing is measured as standing only."""
    clip = draw_clip(MODEL, "idle", [Segment(4.0)], np.random.default_rng(0))
    assert measure_steps(clip, "s") is None
    standing = measure_standing(clip, "s")
    assert standing is not None
    assert len(standing.rotations) > 60


def test_fitting_drawn_clips_gives_the_model_again() -> None:
    """Ankles of a model fitted on drawn clips lie within 3 cm of the drawing model's in walking."""
    clips = [
        _clip(speed, turn, seed)
        for seed, (speed, turn) in enumerate(
            [(v, w) for v in (0.8, 1.1, 1.4, 3.0, 3.4) for w in (-0.3, 0.0, 0.3)]
        )
    ]
    both = [c for clip in clips for c in (clip, mirror_clip(clip))]
    steps = [s for c in both if (s := measure_steps(c, c.name)) is not None]
    standing = [t for c in both if (t := measure_standing(c, c.name)) is not None]
    again = fit(steps, standing)
    phase = np.linspace(0.0, 1.0, 20, endpoint=False)
    rows = design(phase, *np.zeros((3, 20)))
    _, old = decode(rows @ MODEL.walk.coefficients, MODEL.base)
    _, new = decode(rows @ again.walk.coefficients, again.base)
    assert np.linalg.norm(old - new, axis=-1)[:, [1, 3]].mean() < 0.03
    assert abs(again.walk.cadence[0] - MODEL.walk.cadence[0]) < 0.1


def test_no_held_out_subject_is_trained_on() -> None:
    """Validation and test subjects, and the two-second cuts, are not among the takes."""
    assert not HELD_OUT & set(TRIALS)
    assert not {"38", "39", "43", "55", "118"} & set(TRIALS)


def test_missing_capture_is_named(tmp_path: Path) -> None:
    """The error says which trial is missing and what to give."""
    with pytest.raises(MissingCaptureError, match=r"no 02/02_01.*unpacked CMU"):
        take_files(tmp_path)


@pytest.mark.skipif(
    not Path(os.environ.get("STRIDEWIRE_DATA", "/absent"), "cmu").is_dir(),
    reason="STRIDEWIRE_DATA does not name a folder with the unpacked CMU trials",
)
def test_training_again_gives_the_shipped_weights(tmp_path: Path) -> None:
    """The command's coefficients are the ones that ship, to half precision."""
    data = os.environ["STRIDEWIRE_DATA"]
    result = CliRunner().invoke(
        train, ["gait", "--data", data, "--out", str(tmp_path), "--json"], catch_exceptions=False
    )
    assert json.loads(result.output)["walk_steps"] > 250
    with (tmp_path / "gait.npz").open("rb") as file:
        again = GaitModel.load(file)
    np.testing.assert_allclose(again.walk.coefficients, MODEL.walk.coefficients, atol=2e-3)
    np.testing.assert_allclose(again.run.coefficients, MODEL.run.coefficients, atol=2e-3)
