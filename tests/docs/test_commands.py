"""What the documents show works: their commands and programs run, in order, as for a reader.

A fenced block `console` holds commands after `$ `, and below each, where it is short, what it
prints (not compared: figures change). A block `python` is a program. `stridewire serve` and
`stridewire play` keep running until the document ends. Blocks `sh` are not run; the `make` targets
that they name must exist.
"""

import os
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")])
PORTS = {"stridewire serve": 50051, "stridewire play": 8484}
"""Where the commands that keep running listen."""
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(document: Path, *kinds: str) -> list[tuple[str, str]]:
    """Return kind and content of the fenced blocks of some kinds, in order."""
    return [(kind, text) for kind, text in BLOCK.findall(document.read_text()) if kind in kinds]


def commands(text: str) -> list[str]:
    """Return the commands of a console block."""
    return [line[2:] for line in text.splitlines() if line.startswith("$ ")]


@contextmanager
def serving(command: str, folder: Path, environment: dict[str, str]) -> Iterator[None]:
    """Keep a server running; it is ready when it says where it listens."""
    with subprocess.Popen(
        ["bash", "-c", f"exec {command}"],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
    ) as server:
        try:
            assert server.stdout is not None
            assert "listening" in server.stdout.readline()
            yield
        finally:
            server.terminate()


def programs(document: Path) -> list[list[str]]:
    """Return the command lines that run what a document shows."""
    found = []
    for kind, text in blocks(document, "console", "python"):
        if kind == "python":
            found.append([sys.executable, "-c", text])
        else:
            found += [["bash", "-c", command] for command in commands(text)]
    return found


RUNNABLE = [document for document in DOCUMENTS if programs(document)]


@pytest.mark.parametrize("document", RUNNABLE, ids=lambda d: str(d.relative_to(ROOT)))
def test_what_a_document_shows_runs(document: Path, tmp_path: Path) -> None:
    """Every command and program ends with 0; one that fails is shown with what it printed."""
    binaries = Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{binaries}:{os.environ['PATH']}"}
    to_run = programs(document)
    for command, port in PORTS.items():
        if any(words[-1].startswith(command) for words in to_run) and _taken(port):
            pytest.skip(f"port {port}, which the document uses, is taken on this machine")
    with ExitStack() as running:
        for words in to_run:
            if _is_server(words):
                running.enter_context(serving(words[-1], tmp_path, environment))
            else:
                _run(words, tmp_path, environment)


def test_make_targets_that_documents_name_exist() -> None:
    """Every `make TARGET` in a block is a target of the Makefile."""
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    for document in DOCUMENTS:
        for _, text in blocks(document, "sh", "console"):
            for line in re.findall(r"^(?:\$ )?make ([^#\n]*)", text, re.MULTILINE):
                named = [word for word in line.split() if re.fullmatch(r"[a-z-]+", word)]
                assert set(named) <= targets, (document.name, line)


def test_links_between_documents_lead_somewhere() -> None:
    """Relative links name files that exist."""
    for document in DOCUMENTS:
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", document.read_text()):
            assert (document.parent / target).exists(), (document.name, target)


def _is_server(words: list[str]) -> bool:
    return words[-1].startswith(tuple(PORTS))


def _run(words: list[str], folder: Path, environment: dict[str, str]) -> None:
    ran = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    assert ran.returncode == 0, f"{words[-1]}\n{ran.stdout}\n{ran.stderr}"


def _taken(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
