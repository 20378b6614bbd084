"""The committed stubs are what the oldest supported generator makes of `proto/`."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
STUBS = ROOT / "client" / "stridewire" / "v1"


@pytest.fixture
def generator() -> Path:
    """Return the Python that has the pinned generator."""
    python = Path(os.environ.get("PROTO_VENV", ROOT / ".proto-venv")) / "bin" / "python"
    if not python.exists():
        pytest.skip("needs the pinned generator in .proto-venv: make .proto-venv")
    return python


def test_regenerating_changes_nothing(generator: Path, tmp_path: Path) -> None:
    """Edit `proto/`, then `make proto`; never edit stubs."""
    protos = sorted(str(p) for p in (ROOT / "proto").rglob("*.proto"))
    outputs = [f"--{kind}_out={tmp_path}" for kind in ("python", "pyi", "grpc_python")]
    subprocess.run(
        [str(generator), "-m", "grpc_tools.protoc", f"-I{ROOT / 'proto'}", *outputs, *protos],
        check=True,
    )
    made = {p.name: p.read_text() for p in (tmp_path / "stridewire" / "v1").iterdir()}
    kept = {p.name: p.read_text() for p in STUBS.glob("*_pb2*")}
    assert made == kept
