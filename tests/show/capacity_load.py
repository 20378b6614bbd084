"""Load tests of `make show-capacity`: one command each, its row read back."""

import json
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

from capture import GIVEN
from import_libraries import STANDARD
from judge_results import library
from points import ROOT

from stridewire_engine.library import Library

REPORTS = ROOT / "build" / "show" / "capacity"
STITCHER = "refine"


@cache
def standard_library() -> Library:
    """Return the library of the standard load: captured, or synthetic where there is no capture."""
    return library(STANDARD.name if (GIVEN / "split.csv").is_file() else "synthetic")


def load(scenario: str, characters: int, seconds: float, *more: str) -> list[dict[str, Any]]:
    """Return the rows of a load test."""
    path: Path = standard_library().path
    words = [sys.executable, "-m", "stridewire", "loadtest", scenario, "--json"]
    words += ["--characters", str(characters), "--seconds", str(seconds)]
    words += ["--stitch", STITCHER, "--library", str(path), "--out", str(REPORTS), *more]
    # a void run ends with 1 and says so in its row
    ran = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    rows: list[dict[str, Any]] = json.loads(ran.stdout)["rows"]
    return rows
