"""The wheel as users get it: built, installed without extras in an environment of its own, used."""

import os
import re
import subprocess
import sys
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest

from source_imports import PACKAGES, ROOT

INSTALL_S = 300
"""Longest that building or installing may take before it counts as stuck."""

pytestmark = pytest.mark.timeout(2 * INSTALL_S)


def run(*command: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command outside of the checkout, without its environment's leftovers."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "PYTEST"))}
    return subprocess.run(
        command, capture_output=True, text=True, cwd=cwd, env=environment, timeout=INSTALL_S
    )


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the wheel of this checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    built = run(
        sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(ROOT)
    )
    assert built.returncode == 0, built.stderr
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="session")
def clean(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the `bin` folder of an environment with the wheel and its base dependencies alone."""
    folder = tmp_path_factory.mktemp("clean") / "venv"
    assert run(sys.executable, "-m", "venv", str(folder)).returncode == 0
    installed = run(str(folder / "bin" / "python"), "-m", "pip", "install", "-q", str(wheel))
    assert installed.returncode == 0, installed.stderr
    return folder / "bin"


def test_the_wheel_holds_the_five_packages_and_nothing_else(wheel: Path) -> None:
    """No `client`, `server`, `tests` or `docs` at the top; types and data are there."""
    names = zipfile.ZipFile(wheel).namelist()
    tops = {name.split("/")[0] for name in names if ".dist-info" not in name}
    assert tops == set(PACKAGES)
    assert all(f"{package}/py.typed" in names for package in PACKAGES)
    assert "stridewire/v1/animation_pb2.pyi" in names
    assert not [name for name in names if name.endswith((".bvh", ".amc", ".asf", ".pyc"))]


def test_the_metadata_says_licence_and_extras(wheel: Path) -> None:
    """Apache-2.0 with its text; the extras that the documentation names."""
    archive = zipfile.ZipFile(wheel)
    info = next(n.split("/")[0] for n in archive.namelist() if ".dist-info" in n)
    metadata = Parser().parsestr(archive.read(f"{info}/METADATA").decode())
    assert metadata["License-Expression"] == "Apache-2.0"
    assert "Apache License" in archive.read(f"{info}/licenses/LICENSE").decode()
    extras = set(metadata.get_all("Provides-Extra", []))
    assert {"server", "train", "loadtest", "view", "dev"} <= extras
    requirements = [r.replace("'", '"') for r in metadata.get_all("Requires-Dist", [])]
    base = {re.split("[^a-z-]", r)[0] for r in requirements if "extra ==" not in r}
    assert base == {"click", "googleapis-common-protos", "grpcio", "numpy", "protobuf"}
    server = {re.split("[^a-z-]", r)[0] for r in requirements if 'extra == "server"' in r}
    assert "faiss-cpu" in server
    assert "torch" not in server


def test_every_client_module_loads_with_the_base_dependencies(clean: Path, tmp_path: Path) -> None:
    """Nothing that a user imports needs an extra before it is called."""
    code = (
        "import importlib, pkgutil, stridewire\n"
        "for name in stridewire.__all__: getattr(stridewire, name)\n"
        "for m in pkgutil.walk_packages(stridewire.__path__, 'stridewire.'):\n"
        "    if m.name.endswith('__main__'): continue\n"
        "    importlib.import_module(m.name); print(m.name)\n"
    )
    loaded = run(str(clean / "python"), "-W", "error", "-c", code, cwd=tmp_path)
    assert loaded.returncode == 0, loaded.stderr
    assert "stridewire.client" in loaded.stdout.split()


def test_the_command_lists_its_commands(clean: Path, tmp_path: Path) -> None:
    """`stridewire --help` works without extras and lists commands of all packages."""
    shown = run(str(clean / "stridewire"), "--help", cwd=tmp_path)
    assert shown.returncode == 0, shown.stderr
    for command in ("stream", "search", "health", "render", "library", "serve", "demo"):
        assert command in shown.stdout


def test_the_command_says_its_version(clean: Path, wheel: Path, tmp_path: Path) -> None:
    """The version is the wheel's."""
    shown = run(str(clean / "stridewire"), "--version", cwd=tmp_path)
    assert wheel.name.split("-")[1] in shown.stdout, shown.stderr


@pytest.mark.parametrize(
    "command", ["serve --address 127.0.0.1:0", "demo", "library info .", "stream --library ."]
)
def test_a_command_of_an_absent_extra_says_what_to_install(
    clean: Path, tmp_path: Path, command: str
) -> None:
    """No traceback: the extra by name, and a failure's exit code."""
    shown = run(str(clean / "stridewire"), *command.split(), cwd=tmp_path)
    assert shown.returncode != 0
    assert "stridewire[server]" in shown.stderr + shown.stdout
    assert "Traceback" not in shown.stderr


def test_running_in_process_without_the_extra_says_what_to_install(
    clean: Path, tmp_path: Path
) -> None:
    """The library's error is typed and names the extra too."""
    code = (
        "from stridewire import StridewireError\n"
        "from stridewire._transport import in_process_transport\n"
        "try: in_process_transport(None)\n"
        "except StridewireError as error: print(error)\n"
    )
    shown = run(str(clean / "python"), "-c", code, cwd=tmp_path)
    assert "stridewire[server]" in shown.stdout, shown.stderr
