"""The commands against real servers: what they print, write and exit with."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from serving import DEADLINE_S
from stridewire import Client, Pacing, UnavailableError
from stridewire.commands import main
from stridewire.formats.bvh import read_bvh
from stridewire.formats.gltf import read_gltf
from stridewire.v1 import animation_pb2 as pb
from stridewire_engine.library import Library


def run(*arguments: object) -> Result:
    """Run the command line in this process."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@contextmanager
def serving(*arguments: object) -> Iterator[tuple[subprocess.Popen[str], dict[str, object]]]:
    """Run `stridewire serve` as a process; gives it and what it said when ready."""
    command = [sys.executable, "-m", "stridewire", "serve", "--json", *map(str, arguments)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stdout is not None
            yield process, json.loads(process.stdout.readline())
        finally:
            process.kill()


def test_health(address: str) -> None:
    """0 and `serving` where a server is ready, 1 where none answers."""
    assert run("health", "--address", address).output == f"{address}: serving\n"
    told = run("health", "--address", address, "--json")
    assert json.loads(told.output) == {"address": address, "state": "serving"}
    absent = run("health", "--address", "127.0.0.1:1")
    assert absent.exit_code == 1
    assert "no answer (unavailable)" in absent.output


def test_search(address: str, small_library: Library) -> None:
    """As a table and as JSON, over the wire and in this process, the same matches."""
    query = ("search", "--clip", small_library.clips[3].name, "--time", 1.5)
    query = (*query, "--velocity", "0,1.4", "-k", 3)
    over_wire = json.loads(run(*query, "--address", address, "--json").output)
    here = json.loads(run(*query, "--library", small_library.path, "--json").output)
    assert len(over_wire["matches"]) == 3
    assert [m["clip"] for m in over_wire["matches"]] == [m["clip"] for m in here["matches"]]
    table = run(*query, "--address", address).output
    assert table.splitlines()[1].startswith(over_wire["matches"][0]["clip"])


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (("search", "--clip", "idle-1", "--velocity", "fast"), 2, "expected two numbers"),
        (("search", "--clip", "idle-1", "--facing", 1.0), 2, "--facing needs --velocity"),
        (("search", "--clip", "moonwalk", "--address", "ADDRESS"), 1, "no clip 'moonwalk'"),
        (("search", "--clip", "idle-1", "-k", 9999, "--address", "ADDRESS"), 2, "k: 9999"),
        (("search", "--clip", "idle-1", "--address", "127.0.0.1:1"), 1, "`stridewire serve`"),
        (("stream", "--library", "/nowhere"), 2, "/nowhere"),
        (("stream", "--address", "a:1", "--library", "."), 2, "exclude each other"),
        (("serve", "--address", "0.0.0.0:0"), 2, "add --insecure"),
        (("serve", "--library", "/nowhere"), 2, "/nowhere"),
    ],
)
def test_what_is_wrong_is_one_line(
    address: str, arguments: tuple[str, ...], code: int, says: str
) -> None:
    """No traceback: a line that says what to do, and an exit code."""
    result = run(*(address if a == "ADDRESS" else a for a in arguments))
    assert result.exit_code == code
    assert says in result.output
    assert "Traceback" not in result.output
    assert result.output.splitlines()[-1].startswith("Error: ")


def test_stream_writes_motion_and_figures(
    address: str, small_library: Library, tmp_path: Path
) -> None:
    """A BVH for each character, all frames in it, figures as JSON; the same in this process."""
    for target in (("--address", address, "--no-realtime"), ("--library", small_library.path)):
        out = tmp_path / "walk.bvh"
        result = run(
            *("stream", "--script", "walk-turn-stop", "--seconds", 2, "--characters", 2),
            *("--out", out, "--json", *target),
        )
        assert result.exit_code == 0, result.output
        told = json.loads(result.stdout)
        assert told["settings"]["synthetic"] is True
        (row,) = told["rows"]
        assert (row["library"], row["characters"], row["frames"]) == ("small", 2, 120)
        assert told["files"] == [str(out), str(tmp_path / "walk-2.bvh")]
        for file in told["files"]:
            assert len(read_bvh(file).rotations) == 120
            Path(file).unlink()


def test_stream_writes_glb(small_library: Library, tmp_path: Path) -> None:
    """By the ending of --out; one that nothing writes is refused before anybody walks."""
    target = ("--library", small_library.path, "--seconds", 0.5)
    result = run("stream", "--out", tmp_path / "walk.glb", *target)
    assert result.exit_code == 0, result.output
    assert len(read_gltf(tmp_path / "walk.glb")) == 30
    refused = run("stream", "--out", tmp_path / "walk.fbx", *target)
    assert refused.exit_code == 2
    assert "expected .bvh, .glb, .npz" in refused.output
    assert "latency" not in refused.output


def test_stream_in_words(address: str) -> None:
    """People are told the library, that it is synthetic, and how latency was measured."""
    result = run("stream", "--seconds", 0.5, "--no-realtime", "--address", address)
    assert "small (synthetic: generated, not captured" in result.output
    assert "not at 60 frames/s" in result.output


def test_demo(small_library: Library, tmp_path: Path) -> None:
    """A server, four characters, one second at wall-clock speed; motion, sheet, figures."""
    out, sheet = tmp_path / "demo.bvh", tmp_path / "demo.png"
    result = run(
        *("demo", "--seconds", 1, "--library", small_library.path, "--stitcher", "refine"),
        *("--out", out, "--sheet", sheet, "--json"),
    )
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    (row,) = told["rows"]
    assert told["settings"]["realtime"] is True
    assert (row["characters"], row["frames"], row["dropped_pct"]) == (4, 60, 0.0)
    assert 0.0 < row["p50_ms"] <= row["p99_ms"] <= row["max_ms"]
    assert 0.0 <= row["refined_pct"] <= 100.0
    assert len(read_bvh(out).rotations) == 60
    assert sheet.read_bytes().startswith(b"\x89PNG")


def test_serve_stops_in_good_order(small_library: Library) -> None:
    """SIGTERM: open sessions are told, new ones refused, and the exit code is 0."""
    with serving("--address", "127.0.0.1:0", "--library", f"mine={small_library.path}") as (
        process,
        ready,
    ):
        assert ready["libraries"] == [{"name": "mine", "synthetic": True}]
        with Client(str(ready["address"]), timeout_s=DEADLINE_S) as client:
            session = client.open_session(pacing=Pacing.SERVER, library="mine")
            frames = session.frames()
            next(frames)
            process.send_signal(signal.SIGTERM)
            while not session.notices:
                next(frames)
            (notice,) = session.notices
            assert notice.kind == pb.NOTICE_KIND_DRAINING
            assert notice.deadline_s > 0.0
            with pytest.raises(UnavailableError, match="the server is stopping"):
                client.open_session()
            assert run("health", "--address", ready["address"]).exit_code == 1
            session.close()
        assert process.wait(DEADLINE_S) == 0


def test_serve_keeps_a_port_to_itself(address: str, small_library: Library) -> None:
    """A second server on the same port fails and says so."""
    command = [sys.executable, "-m", "stridewire", "serve", "--address", address]
    command += ["--library", str(small_library.path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60.0)
    assert done.returncode == 2
    assert "is the port taken?" in done.stderr
    assert "Traceback" not in done.stderr


def test_serve_calms_numpy_before_it_loads(small_library: Library) -> None:
    """The thread counts are set in the process before numpy is imported."""
    code = (
        "import sys, os, stridewire.commands.health\n"
        "from stridewire_server.commands.serve import serve\n"
        "assert 'numpy' not in sys.modules, 'numpy came before serve could set its threads'\n"
        "try: serve(['--library', '/nowhere'], standalone_mode=False)\n"
        "except ValueError: pass\n"
        "assert 'numpy' in sys.modules\n"
        "print(os.environ['OMP_NUM_THREADS'], os.environ['OPENBLAS_NUM_THREADS'])\n"
    )
    clean = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    done = subprocess.run(
        [sys.executable, "-c", code], env=clean, capture_output=True, text=True, timeout=60.0
    )
    assert done.stdout.split() == ["1", "1"], done.stderr


def test_a_wildcard_address_needs_consent(small_library: Library) -> None:
    """With --insecure it listens beyond loopback."""
    with serving("--address", "0.0.0.0:0", "--insecure", "--library", small_library.path) as (
        _,
        ready,
    ):
        port = str(ready["address"]).rpartition(":")[2]
        with socket.create_connection(("127.0.0.1", int(port)), timeout=DEADLINE_S):
            pass
