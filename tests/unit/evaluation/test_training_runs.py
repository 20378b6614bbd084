"""What a run's folder tells: all of a training that ended, nothing of one that did not."""

import json
from pathlib import Path

import pytest

from stridewire_engine.evaluation.training_runs import (
    CONFIGURATION,
    CURVE,
    ENDED,
    RunError,
    record,
)

CURVES = [
    {"step": 5, "validation": 0.5, "cpu_s": 30.0},
    {"step": 10, "validation": 0.25, "cpu_s": 60.0},
    {"step": 15, "validation": 0.375, "cpu_s": 90.0},
]


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """Return the folder of a run that was stopped by its patience."""
    phases = [{"steps": 20}, {"steps": 10}]
    told = {"variant": "paper", "seed": 3, "commit": "abc", "phases": phases, ENDED: True}
    (tmp_path / CONFIGURATION).write_text(json.dumps(told))
    (tmp_path / CURVE).write_text(json.dumps(CURVES))
    return tmp_path


def test_a_training_that_ended_is_told(run: Path) -> None:
    """Command, commit, steps done and asked for, time, best validation loss and curve."""
    told = dict(record(run))
    assert told.pop("curve") == CURVES
    assert told == {
        "command": "stridewire train blend --variant paper --seed 3",
        "commit": "abc",
        "variant": "paper",
        "seed": 3,
        "steps": 15,
        "asked_steps": 30,
        "cpu_minutes": 1.5,
        "validation": 0.25,
    }


def test_a_training_that_has_not_ended_is_no_record(run: Path, tmp_path: Path) -> None:
    """Figures of weights from the middle of a run would be taken for the run's."""
    told = json.loads((run / CONFIGURATION).read_text())
    (run / CONFIGURATION).write_text(json.dumps({**told, ENDED: False}))
    with pytest.raises(RunError, match="has not ended"):
        record(run)
    with pytest.raises(RunError, match="stridewire train blend --out"):
        record(tmp_path / "nowhere")
