"""`stridewire play` without a browser: what it serves, and the files that it makes of frames."""

import json
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from serving import DEADLINE_S, LoopThread, opening, stepping
from stridewire.formats.bvh_writing import write_bvh
from stridewire.formats.reading import read_motion
from stridewire.motion.clip import Clip
from stridewire.v1 import animation_pb2 as pb
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_server.page.site import Site, about
from stridewire_server.server import AnimationServer
from stridewire_server.settings import ServerSettings


@pytest.fixture(scope="module")
def host(loop_thread: LoopThread, small_library: Library) -> Iterator[str]:
    """Return `host:port` of a page over the small library."""
    runtime = Runtime([small_library])
    settings = ServerSettings("127.0.0.1:0", websocket="127.0.0.1:0", drain_s=0.2)

    async def start() -> AnimationServer:
        server = AnimationServer(runtime, settings, Site(about(runtime)))
        await server.start()
        return server

    server = loop_thread.call(start())
    yield server.websocket_address
    loop_thread.call(server.stop())


@pytest.fixture
def play(tmp_path: Path) -> Iterator[Callable[..., str]]:
    """Return a starter of the command; gives the page's address."""
    running = []

    def start(*arguments: object) -> str:
        command = [sys.executable, "-m", "stridewire", "play", "--no-browser", "--json"]
        words = [*command, "--port", "0", *map(str, arguments)]
        running.append(subprocess.Popen(words, stdout=subprocess.PIPE, text=True, cwd=tmp_path))
        assert running[-1].stdout is not None
        return str(json.loads(running[-1].stdout.readline())["url"])

    yield start
    for process in running:
        process.terminate()
        assert process.wait(DEADLINE_S) == 0
        assert process.stdout is not None
        process.stdout.close()


def fetch(url: str) -> bytes:
    """Return what lies at an address."""
    with urllib.request.urlopen(url, timeout=DEADLINE_S) as response:
        return bytes(response.read())


def test_the_page_is_told_what_there_is(host: str) -> None:
    """Libraries with tags and channels, stitchers: what its switches offer."""
    told = json.loads(fetch(f"http://{host}/page/about.json"))
    (library,) = told["libraries"]
    assert (library["name"], library["synthetic"]) == ("small", True)
    assert {"idle", "walk"} <= set(library["tags"])
    assert library["channels"]["foot-position"] > 0.0
    assert {"none", "spring"} <= set(told["stitchers"])
    assert told["files"] == []


@pytest.mark.parametrize("kind", ["bvh", "glb"])
def test_frames_that_were_kept_become_a_file(host: str, tmp_path: Path, kind: str) -> None:
    """What a session sent, sent back, is a motion file of as many frames that goes as far."""
    with connect(f"ws://{host}/v1/animate", compression=None) as session:
        session.send(opening().SerializeToString())
        kept = [bytes(session.recv(DEADLINE_S, decode=False))]
        for i in range(90):
            step = stepping(step=i + 1, velocity_xz=[0.0, 1.3], last_frame=i)
            session.send(step.SerializeToString())
            kept.append(bytes(session.recv(DEADLINE_S, decode=False)))
    with connect(f"ws://{host}/page/convert/{kind}", compression=None, max_size=None) as making:
        for message in (*kept, b""):
            making.send(message)
        path = tmp_path / f"walked.{kind}"
        path.write_bytes(bytes(making.recv(DEADLINE_S, decode=False)))
    motion = read_motion(path)
    assert len(motion) == 90
    last = pb.AnimateResponse.FromString(kept[-1]).frame
    metres = 0.01 if kind == "bvh" else 1.0
    walked = (motion.root_positions[-1] - motion.root_positions[0]) * metres
    assert walked[2] == pytest.approx(last.root[2], abs=0.1)
    assert last.root[2] > 0.5


@pytest.mark.parametrize(
    ("messages", "says"),
    [
        ([b""], "must be Opened"),
        ([pb.AnimateResponse().SerializeToString() + b"\x7a\x00", b""], "that a session sent"),
        ([b"\xff" * 9, b""], "no message"),
        (["text"], "a text message"),
    ],
)
def test_what_is_no_recording_is_refused(host: str, messages: list[bytes | str], says: str) -> None:
    """INVALID_ARGUMENT with the reason; nothing is made of it."""
    with connect(f"ws://{host}/page/convert/bvh", compression=None) as making:
        for message in messages:
            making.send(message)
        with pytest.raises(ConnectionClosed):
            making.recv(DEADLINE_S)
        assert making.close_code == 4003
        assert says in str(making.close_reason)


def test_files_are_shown_as_joints_in_the_world(
    play: Callable[..., str], swaying_clip: Clip, tmp_path: Path
) -> None:
    """Each file with its frames, rate, skeleton and positions in metres, in the order given."""
    write_bvh(tmp_path / "one.bvh", swaying_clip)
    write_bvh(tmp_path / "two.bvh", swaying_clip.cut(0, 61))
    url = play(tmp_path / "one.bvh", tmp_path / "two.bvh")
    told = json.loads(fetch(f"{url}page/about.json"))["files"]
    assert [(file["name"], file["frames"]) for file in told] == [("one", 121), ("two", 61)]
    block = np.frombuffer(fetch(url + told[0]["url"][1:]), "<f4")
    positions = block.reshape(told[0]["frames"], len(told[0]["parents"]), 3)
    assert np.ptp(positions[..., 2]) > 2.0, "it walks 2.6 m along +Z"
    assert positions[..., 1].max() < 2.5, "metres, not centimetres"
    with pytest.raises(urllib.error.HTTPError, match="404"):
        fetch(f"{url}v1/animate")


def test_a_file_that_cannot_be_read_is_told_at_once(tmp_path: Path) -> None:
    """One line, exit code 2, before anything listens."""
    (tmp_path / "bad.bvh").write_text("HIERARCHY\n")
    command = [sys.executable, "-m", "stridewire", "play", "--no-browser", "--port", "0"]
    ran = subprocess.run(
        [*command, tmp_path / "bad.bvh"], capture_output=True, text=True, timeout=60
    )
    assert ran.returncode == 2
    assert "bad.bvh" in ran.stderr
    assert "Traceback" not in ran.stderr
