"""The lower bounds of the dependencies are true: the suite's core runs on just those versions."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from source_imports import ROOT

INTEGRATION = ("one_interface", "bad_input", "blend", "websocket", "play", "stitch_command")

CORE = (
    "tests/unit/motion",
    "tests/property",
    "tests/contract",
    *(f"tests/integration/test_{name}.py" for name in INTEGRATION),
)
"""Arithmetic, codec, wire, and a real server with a real client behind each dependency."""

TOOLS = ("pytest", "pytest-timeout", "hypothesis")


def floors(project: dict[str, object]) -> list[str]:
    """Return base and server requirements with `==` for `>=`."""
    requirements = [*project["dependencies"], *project["optional-dependencies"]["server"]]  # type: ignore[misc, index]
    return [requirement.replace(">=", "==") for requirement in requirements]


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_core_passes_on_the_oldest_versions(tmp_path: Path) -> None:
    """An environment of lower bounds, the checkout, and the tests that touch dependencies."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    python = tmp_path / "venv" / "bin" / "python"
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "venv")], check=True)
    pip = [str(python), "-m", "pip", "install", "-q", "--disable-pip-version-check"]
    subprocess.run([*pip, *floors(project), *TOOLS, "hatchling", "editables"], check=True)
    subprocess.run([*pip, "--no-deps", "--no-build-isolation", "-e", str(ROOT)], check=True)
    # compiled beforehand, as servers that are tested are not waited for so long
    subprocess.run([str(python), "-m", "stridewire_server.warming"], check=True)
    tests = [str(ROOT / part) for part in CORE]
    ran = subprocess.run(
        [str(python), "-m", "pytest", "-p", "no:cacheprovider", "-x", *tests],
        cwd=ROOT,
        env={**os.environ, "STRIDEWIRE_DATA": ""},  # the capture says nothing of versions
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stdout[-4000:] + ran.stderr[-1000:]
