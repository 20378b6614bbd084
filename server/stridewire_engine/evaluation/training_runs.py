"""Training runs: what a run's folder tells of how its weights came to be."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

CONFIGURATION, CURVE, WEIGHTS = "run.json", "curve.json", "blend.onnx"
ENDED = "ended"
"""Entry of the configuration: true once training has come to its end, by length or patience."""


class RunError(ValueError):
    """A run's folder does not hold what is needed; the message says what to do."""


def configuration(folder: Path) -> Mapping[str, Any]:
    """Return seed, commit and recipe of a run.

    Raises:
        RunError: If the folder is none of a run.
    """
    path = folder / CONFIGURATION
    if not path.is_file():
        raise RunError(
            f"{folder} holds no {CONFIGURATION}; give the folder of `stridewire train blend --out`"
        )
    told: Mapping[str, Any] = json.loads(path.read_text())
    return told


def record(folder: Path) -> Mapping[str, Any]:
    """Return what is to be told of a run beside figures of its weights.

    Raises:
        RunError: If its training has not ended.
    """
    told = configuration(folder)
    if not told.get(ENDED):
        raise RunError(
            f"the training in {folder} has not ended; the command that began it goes on with it"
        )
    curve = json.loads((folder / CURVE).read_text())
    return {
        "command": f"stridewire train blend --variant {told['variant']} --seed {told['seed']}",
        "commit": told["commit"],
        "variant": told["variant"],
        "seed": told["seed"],
        "steps": curve[-1]["step"],
        "asked_steps": sum(phase["steps"] for phase in told["phases"]),
        "cpu_minutes": round(curve[-1]["cpu_s"] / 60.0, 1),
        "validation": round(min(look["validation"] for look in curve), 5),
        "curve": curve,
    }
