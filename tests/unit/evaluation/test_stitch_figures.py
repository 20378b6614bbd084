"""Judging stitching: the truth is right, the bare seam is worst, guidance that knows helps."""

import numpy as np
import pytest

from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.evaluation.seam_methods import plain_methods
from stridewire_engine.evaluation.seams import Poses, Windows, stitched
from stridewire_engine.evaluation.stitch_figures import Figures, Judge
from stridewire_engine.evaluation.stitch_table import rows
from stridewire_engine.networks.rmr import Guidance, Plans, shipped_refiner
from stridewire_engine.networks.rmr.assembly import assemble
from stridewire_engine.networks.rmr.features import inputs
from stridewire_engine.networks.rmr.guidance import guidance
from stridewire_engine.networks.rmr.takes import Takes
from stridewire_engine.stitchers.stance import Stance


@pytest.fixture(scope="module")
def judge() -> Judge:
    """Return pairs of synthetic walks and runs."""
    return Judge(Takes.of(clip for clip in synthetic_clips() if len(clip) < 400), 60)


@pytest.fixture(scope="module")
def measured(judge: Judge) -> dict[str, Figures]:
    """Return what every plain way measures."""
    return {name: judge.measure(method) for name, method in plain_methods().items()}


def told(windows: Windows) -> Poses:
    """Guide stance by what the actor did."""
    takes, pairs = windows.takes, windows.pairs
    made = assemble(takes, pairs, (windows.root, windows.yaw))
    true = takes.contacts[pairs.truth].astype(np.float64)
    said = Guidance(
        true, made.truth.toes - made.clip.toes, np.zeros(made.truth.toes.shape), np.ones(len(pairs))
    )
    return stitched(windows, Stance(), said)


def says(windows: Windows, loudness: float) -> Poses:
    """Guide stance by the network that ships, its output times `loudness`."""
    plans: Plans = assemble(windows.takes, windows.pairs, (windows.root, windows.yaw)).plans
    curves, contacts, distance = shipped_refiner().model.run(inputs(plans))
    said = guidance(plans, loudness * curves, loudness * contacts, distance)
    return stitched(windows, Stance(), said)


def value(figures: Figures, name: str) -> float:
    """Return a figure without its interval."""
    figure = figures[name]
    return float(figure.value(np.ones((1, figure.units)))[0])


def test_the_truth_is_right(measured: dict[str, Figures]) -> None:
    """It has no error, and its figures are the least of all that can be expected."""
    for name in ("position_error_cm", "foot_error_cm", "mse", "npss"):
        assert value(measured["truth"], name) == pytest.approx(0.0, abs=1e-6)


def test_the_bare_seam_is_worst(measured: dict[str, Figures]) -> None:
    """Everything that hides seams jumps less, the truth least."""
    raw = value(measured["raw"], "jump_pct")
    for name in ("paper-ib", "spring", "quintic", "dead-blend", "stance"):
        assert value(measured[name], "jump_pct") < 0.5 * raw


def test_locks_and_stance_slide_less_than_springs(measured: dict[str, Figures]) -> None:
    """Labels of the clips help, since clips that go alike step alike."""
    spring = value(measured["spring"], "sliding_c_cm_s")
    assert value(measured["spring-lock"], "sliding_c_cm_s") < 0.8 * spring
    assert value(measured["stance"], "sliding_c_cm_s") < 0.8 * spring


def test_true_contacts_and_targets_beat_stance(judge: Judge, measured: dict[str, Figures]) -> None:
    """What the network is to say, said right, plants feet where the actor did."""
    guided = judge.measure(told)
    for name, most in (("sliding_c_cm_s", 0.5), ("foot_error_cm", 0.8)):
        assert value(guided, name) < most * value(measured["stance"], name)


def test_rows_tell_ratios_with_intervals(measured: dict[str, Figures]) -> None:
    """Each method has a row; the spring is once the spring."""
    table = {row["method"]: row for row in rows({"data": "synthetic"}, measured)}
    assert set(table) == set(measured)
    assert table["spring"]["sliding_c_cm_s_of_spring"] == 1.0
    assert table["truth"]["toe_jerk_ratio"] == 1.0
    stance = table["stance"]
    low, high = (stance[f"sliding_c_cm_s_of_spring_{end}"] for end in ("low", "high"))
    assert low <= stance["sliding_c_cm_s_of_spring"] <= high


def test_a_smoothed_path_is_another_path(judge: Judge) -> None:
    """The path that is shown moves away from the take's, but not far."""
    smoothed = Judge(judge.takes, 60, "smoothed")
    windows, others = next(judge.windows()), next(smoothed.windows())
    away = np.linalg.norm(windows.root - others.root, axis=-1)
    assert 1e-4 < away.mean() < 0.15


def test_feet_fare_worse_when_the_network_falls_silent(judge: Judge) -> None:
    """Its output at zero, they slide more and are further from where the actor's were."""
    spoken, silent = (judge.measure(lambda w, k=k: says(w, k)) for k in (1.0, 0.0))
    for name, most in (("sliding_c_cm_s", 0.5), ("foot_error_cm", 0.8), ("position_error_cm", 0.9)):
        assert value(spoken, name) < most * value(silent, name)
