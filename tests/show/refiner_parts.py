"""Train the refiner with a part of the people's clips and tell how good it is.

`STRIDEWIRE_DATA=DIR python tests/show/refiner_parts.py PART OUT` trains with a share of the clips,
six to eight minutes of one thread, measures the weights on CMU's test subjects, and puts the row
into `docs/results/refiner-parts.json`.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from points import ROOT

RESULTS = ROOT / "docs" / "results" / "refiner-parts.json"
_FIGURES = ("sliding_a_cm_s", "sliding_c_cm_s", "position_error_cm", "foot_error_cm", "npss")


def _stridewire(*words: str) -> Any:
    command = [sys.executable, "-m", "stridewire", *words, "--json"]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout)


def row(part: float, folder: Path) -> dict[str, Any]:
    """Train in a folder, measure, return what is told of it.

    Args:
        part: Share of the training clips.
        folder: Of the run; an unfinished one goes on.
    """
    told = _stridewire("train", "rmr", "--out", str(folder), "--part", str(part))
    subprocess.run([sys.executable, "-m", "stridewire", "export", "rmr", str(folder)], check=True)
    network = f"part={folder / 'rmr.onnx'}"
    found = _stridewire(
        "evaluate", "stitch", "--set", "cmu", "--path", "source", "--network", network
    )
    measured = next(row for row in found["rows"] if row["method"] == "part")
    ratios = {f"{name}_of_spring": measured[f"{name}_of_spring"] for name in _FIGURES}
    return {"part": part, **{k: told[k] for k in ("clips", "steps", "validation")}, **ratios}


if __name__ == "__main__":
    part, folder = float(sys.argv[1]), Path(sys.argv[2])
    new = row(part, folder)
    kept = json.loads(RESULTS.read_text())["rows"] if RESULTS.exists() else []
    rows = sorted([r for r in kept if r["part"] != part] + [new], key=lambda r: r["part"])
    command = "python tests/show/refiner_parts.py PART OUT"
    RESULTS.write_text(json.dumps({"settings": {"command": command}, "rows": rows}, indent=1))
