"""What an import really loads, each seen from a process of its own."""

import subprocess
import sys

import pytest

LOADS = "import sys, {module}; print(*sorted(m for m in sys.modules if '.' not in m))"


def loaded_by(module: str) -> set[str]:
    """Return the top-level modules in a fresh process after importing one."""
    run = subprocess.run(
        [sys.executable, "-c", LOADS.format(module=module)],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(run.stdout.split())


@pytest.mark.parametrize(
    ("module", "without"),
    [
        ("stridewire", {"grpc", "google", "click", "matplotlib", "numpy"}),
        ("stridewire.motion.clip", {"grpc", "google", "click", "matplotlib", "scipy"}),
        ("stridewire.motion.two_bone_ik", {"grpc", "google", "click", "matplotlib", "scipy"}),
        ("stridewire.drawing", {"grpc", "matplotlib"}),
        ("stridewire.scripts", {"grpc", "google", "matplotlib"}),
        ("stridewire.client", {"click", "matplotlib", "faiss"}),
        ("stridewire.commands", {"grpc", "matplotlib", "numpy"}),
        ("stridewire_engine.runtime", {"grpc", "torch", "matplotlib", "click"}),
        ("stridewire_engine.in_process", {"grpc", "torch", "matplotlib", "click"}),
    ],
)
def test_an_import_leaves_out(module: str, without: set[str]) -> None:
    """The kernel loads without gRPC, the engine too; heavy packages load when they are used."""
    assert not loaded_by(module) & without
