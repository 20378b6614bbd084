"""The report on a library: minutes by class, faults of clips, what to capture next."""

from pathlib import Path

import numpy as np
import pytest
from tests.unit.building.figures import walking

from stridewire_engine.building.build import build_library
from stridewire_engine.building.cleaning import clean
from stridewire_engine.building.coverage import clip_quality, examine
from stridewire_engine.building.tagging import tag


def test_minutes_lie_in_their_classes_and_gaps_are_named(tmp_path: Path) -> None:
    """A walk of 0.6 m/s that turns left at 29 degrees/s fills one class, twice with its mirror."""
    clip = tag(clean("walk", *walking(1200), 60.0, "walk.bvh"), "walk")
    report = examine(build_library([clip], tmp_path / "lib", name="lib"))
    assert report.minutes.sum() == pytest.approx(2 * 1200 / 3600.0)
    assert report.minutes[1, [2, 4]].sum() > 0.9 * report.minutes.sum()
    assert [clip.name for clip in report.clips] == ["walk"]
    wanted = {name for name, _, _ in report.wanted}
    assert {"run", "idle", "backward"} <= wanted


def test_noise_and_impossible_knees_are_named() -> None:
    """Clean motion has no problems of its own making; shaken and broken motion has."""
    hips, rotations = walking()
    assert "noisy" not in clip_quality(clean("walk", hips, rotations, 60.0, "")).problems
    rng = np.random.default_rng(2)
    shaken = clip_quality(clean("a", hips + rng.normal(0, 0.02, hips.shape), rotations, 60.0, ""))
    assert shaken.noise > clip_quality(clean("b", hips, rotations, 60.0, "")).noise
    broken = rotations.copy()
    broken[:, 2] = (np.cos(0.4), -np.sin(0.4), 0.0, 0.0)
    problems = clip_quality(clean("c", hips, broken, 60.0, "")).problems
    assert "knees or elbows out of range" in problems
