"""Judging blends: the truth is perfect, linear is the baseline, a network set to nothing is it."""

import json
from pathlib import Path

import numpy as np
import pytest

from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.evaluation.blend_methods import as_served, by_network
from stridewire_engine.evaluation.blend_table import mean_share, rows
from stridewire_engine.evaluation.blending import LINEAR, Measured, Sums, measure
from stridewire_engine.evaluation.split_clips import import_clips
from stridewire_engine.networks.blend import BlendNetwork, Postures, blend_network
from stridewire_engine.networks.blend.pairs import Frames, Pairs

DURATIONS = (0.3, 0.8)


class Silenced(BlendNetwork):
    """The shipped network with its output set to nothing."""

    def __init__(self) -> None:
        super().__init__(blend_network().model)

    def coefficients(
        self, start: Postures, end: Postures, duration: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Say nothing."""
        coefficients, distance = super().coefficients(start, end, duration)
        return np.zeros_like(coefficients), distance


@pytest.fixture(scope="module")
def frames() -> Frames:
    """Return frames of a few synthetic clips."""
    return Frames.of(synthetic_clips()[:8])


@pytest.fixture(scope="module")
def measured(frames: Frames) -> Measured:
    """Measure the truth itself, a shifted truth and a silenced network."""

    def shifted(pairs: Pairs) -> Postures:
        return Postures(pairs.truth.hips + np.float32(0.02), pairs.truth.rotations)

    methods = {
        "truth": lambda pairs: pairs.truth,
        "shifted": shifted,
        "silenced": by_network(Silenced()),
    }
    return measure(frames, methods, blend_network().deviation, DURATIONS, step=0.5)


def mean(sums: Sums) -> float:
    """Return the mean over clips and weights."""
    return float(sums.total.sum() / sums.weight.sum())


def test_the_truth_is_perfect(measured: Measured) -> None:
    """What was captured has no error, and slides less than the linear blend."""
    for duration in DURATIONS:
        truth, linear = measured[duration, "truth"], measured[duration, LINEAR]
        assert mean(truth["position_error_cm"]) == mean(truth["mse"]) == 0.0
        assert mean(truth["sliding_c_cm_s"]) < mean(linear["sliding_c_cm_s"])
        assert truth["collisions"].total.sum() == 0.0


def test_a_shift_is_measured_as_it_is(measured: Measured) -> None:
    """Two centimetres along each axis are 3.46 cm a joint, four times that at four ends."""
    shifted = measured[0.8, "shifted"]
    np.testing.assert_allclose(mean(shifted["position_error_cm"]), 2.0 * 3**0.5, rtol=1e-3)
    np.testing.assert_allclose(mean(shifted["end_effector_cm"]), 8.0 * 3**0.5, rtol=1e-3)


def test_a_network_set_to_nothing_is_linear(measured: Measured) -> None:
    """All it gains is gone: every figure is the linear blend's."""
    for duration in DURATIONS:
        for name, sums in measured[duration, "silenced"].items():
            np.testing.assert_allclose(
                sums.total, measured[duration, LINEAR][name].total, rtol=1e-4, atol=1e-4
            )


def test_ends_are_not_counted(frames: Frames) -> None:
    """A value at weight 0 or 1 says nothing about blending."""
    pairs = frames.every(0.5, 1.0, np.array([0.0, 0.5, 1.0]))
    sums = Sums.of(np.ones(pairs.weights.shape), pairs, len(frames.lengths))
    assert sums.total.sum() == sums.weight.sum() == len(pairs)
    assert sums.total[:, 5].sum() == len(pairs)


def test_rows_are_flat_and_complete(measured: Measured) -> None:
    """A row a method and duration, a method and weight, and two over all; JSON takes them."""
    table = list(rows("synthetic", "all", measured))
    assert len(table) == 4 * (len(DURATIONS) + 9 + 2)
    json.dumps(table, allow_nan=False)
    linear = next(r for r in table if r["method"] == LINEAR and r["weight"] == 0.5)
    assert linear["end_effector_gain_cm"] == 0.0
    assert linear["collisions_pct_of_linear"] is None


def test_shares_are_of_measurable_durations_only() -> None:
    """Durations with fewer than 100 linear collisions do not count; others weigh alike."""

    def collisions(count: float) -> dict[str, Sums]:
        return {"collisions": Sums(np.full((5, 11), count / 55), np.ones((5, 11)))}

    measured = {
        (0.1, LINEAR): collisions(99), (0.1, "a"): collisions(0),
        (0.5, LINEAR): collisions(200), (0.5, "a"): collisions(50),
        (1.0, LINEAR): collisions(1000), (1.0, "a"): collisions(750),
    }  # fmt: skip
    share = mean_share(measured, "a")
    assert share["durations"] == 2
    assert share["collisions_pct_of_linear"] == pytest.approx(50.0)
    assert mean_share({key: measured[key] for key in list(measured)[:2]}, "a")["durations"] == 0


def test_the_shipped_network_beats_linear_and_its_silence_does_not(capture: Path) -> None:
    """On walks of a person it never saw; with the network set to nothing the gain is gone."""
    files = sorted((capture / "cmu" / "08").glob("*.bvh"))[:4]
    frames = Frames.of(clip for clip in import_clips(files) if clip is not None)
    methods = {"served": as_served(blend_network()), "silenced": as_served(Silenced())}
    measured = measure(frames, methods, blend_network().deviation, (0.6,), step=0.2)
    served, silenced, linear = (measured[0.6, m] for m in ("served", "silenced", LINEAR))
    for figure in ("position_error_cm", "end_effector_cm", "sliding_c_cm_s"):
        assert mean(served[figure]) < 0.9 * mean(linear[figure])
        assert mean(served[figure]) < 0.95 * mean(silenced[figure])
