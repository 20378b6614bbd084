"""Humans use grpcurl: it lists, checks, searches and streams without the proto files."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from stridewire_engine.library import Library

BINARY = shutil.which("grpcurl", path=Path(sys.executable).parent) or shutil.which("grpcurl")

pytestmark = pytest.mark.skipif(BINARY is None, reason="grpcurl is not installed")


def grpcurl(address: str, *arguments: str, data: str | None = None) -> str:
    """Run grpcurl against a server and return what it prints."""
    sent = ["-d", "@"] if data is not None else []
    done = subprocess.run(
        [str(BINARY), "-plaintext", *sent, address, *arguments],
        input=data,
        capture_output=True,
        text=True,
        check=True,
        timeout=30.0,
    )
    return done.stdout


def test_services_are_listed(address: str) -> None:
    """`grpcurl list` names them."""
    assert "stridewire.v1.AnimationService" in grpcurl(address, "list").splitlines()


def test_health_is_serving(address: str) -> None:
    """`Health/Check` says SERVING."""
    assert json.loads(grpcurl(address, "grpc.health.v1.Health/Check")) == {"status": "SERVING"}


def test_a_search_is_a_one_liner(address: str, small_library: Library) -> None:
    """A clip, a time, a velocity: matches come back as JSON."""
    query = {
        "pose": {"clip": {"clip": small_library.clips[3].name, "time_s": 1.0}},
        "motion": {"velocity_z": 1.2},
        "k": 3,
    }
    answer = grpcurl(address, "stridewire.v1.MatchService/Search", data=json.dumps(query))
    assert len(json.loads(answer)["matches"]) == 3


def test_a_stream_comes_from_text(address: str) -> None:
    """Open, one Step and Close typed as JSON give Opened and a Frame with numbers in it."""
    messages = [
        {"open": {"characters": [{"id": 7}]}},
        {"step": {"step": 1, "dt_s": 0.0166, "velocity_xz": [0, 1.3]}},
        {"close": {}},
    ]
    text = "\n".join(map(json.dumps, messages))
    answer = grpcurl(address, "stridewire.v1.AnimationService/Animate", data=text)
    decoder, position, parts = json.JSONDecoder(), 0, []
    while position < len(answer.rstrip()):
        part, position = decoder.raw_decode(answer, position)
        position += len(answer[position:]) - len(answer[position:].lstrip())
        parts.append(part)
    assert parts[0]["opened"]["skeleton"]["joints"][0] == "Hips"
    assert len(parts[1]["frame"]["rotations"]) == 4 * 22
