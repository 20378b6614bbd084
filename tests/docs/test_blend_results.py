"""The records of the blend network's trainings: complete, of committed code, and what is quoted."""

import json
from pathlib import Path
from typing import Any

import pytest

from stridewire_engine.evaluation.checkout import CHANGED
from stridewire_engine.networks.blend import blend_network

ROOT = Path(__file__).parents[2]
RECORDS = sorted((ROOT / "docs" / "results").glob("blend-*.json"))
SEEDS = 3


def read(path: Path) -> dict[str, Any]:
    """Return a record."""
    record: dict[str, Any] = json.loads(path.read_text())
    return record


def over_all(record: dict[str, Any], data: str, method: str) -> dict[str, Any]:
    """Return the row of a data set's test subjects over all weights and durations."""
    about = {"data": data, "split": "test", "method": method, "weight": "all", "duration_s": 0}
    rows: list[dict[str, Any]] = record["rows"]
    return next(row for row in rows if about.items() <= row.items() and "mse" in row)


@pytest.mark.parametrize("path", RECORDS, ids=lambda path: path.stem)
def test_a_record_says_how_to_make_it_again(path: Path) -> None:
    """Commands, commits without changes, minutes, and a curve up to the last step."""
    settings = read(path)["settings"]
    training = settings["training"]
    assert settings["command"].startswith("stridewire evaluate blend --run ")
    assert training["command"].startswith("stridewire train blend ")
    for commit in (settings["commit"], training["commit"]):
        assert commit
        assert CHANGED not in commit
    assert training["cpu_minutes"] > 0.0
    assert training["curve"][-1]["step"] == training["steps"] <= training["asked_steps"]


def test_three_seeds_and_the_best_of_them_ships() -> None:
    """Chosen by the loss on validation subjects, told apart by the hash of the weights."""
    ours = [
        read(path)["settings"]
        for path in RECORDS
        if read(path)["settings"]["training"]["variant"] == "correction"
    ]
    assert len({one["training"]["seed"] for one in ours}) == len(ours) == SEEDS
    best = min(ours, key=lambda one: float(one["training"]["validation"]))
    assert best["model_sha256"] == blend_network().model.hash


def test_the_page_and_the_card_quote_the_records() -> None:
    """Position error and sliding of each seed stand in the page, those that ship in the card."""
    page = (ROOT / "docs" / "blending.md").read_text()
    card = (ROOT / "models" / "stridewire_models" / "weights" / "blend.md").read_text()
    for record in map(read, RECORDS):
        if record["settings"]["training"]["variant"] != "correction":
            continue
        ships = record["settings"]["model_sha256"] == blend_network().model.hash
        for data in ("cmu", "lafan1"):
            row = over_all(record, data, "neural")
            for figure in (f"{row['position_error_cm']:.2f}", f"{row['sliding_c_cm_s']:.1f}"):
                assert figure in page
                assert not ships or figure in card
