"""Fetching a public capture: from a local server, resumed, verified, terms shown first."""

import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from tests.unit.formats.test_acclaim import AMC, ASF

from stridewire_engine.building.captures import CaptureError, find_capture
from stridewire_engine.commands.library import library

LIST = """
name = "tiny"
title = "Tiny capture"
base_url = "http://nowhere.invalid"
licence = "free for all"
credit = "Thank the leg."
files = [["07/07.asf", 0, "skeleton"], ["07/07_02.amc", 120, "walk"]]
"""


class Server(ThreadingHTTPServer):
    """Serves files from memory and remembers what was asked for."""

    files: dict[str, bytes]
    asked: list[tuple[str, str | None]]
    cut: int = 0
    """After how many bytes of a motion the connection ends; 0 for never."""


class Handler(BaseHTTPRequestHandler):
    """Answers GET, with ranges."""

    server: Server

    def do_GET(self) -> None:
        """Send a file or the rest of it."""
        begin = self.headers.get("Range")
        self.server.asked.append((self.path, begin))
        body = self.server.files.get(self.path)
        if body is None:
            self.send_error(404)
            return
        start = int(begin.removeprefix("bytes=").removesuffix("-")) if begin else 0
        self.send_response(206 if begin else 200)
        self.send_header("Content-Length", str(len(body) - start))
        self.end_headers()
        cut = self.server.cut if self.path.endswith(".amc") else 0
        self.wfile.write(body[start : cut or None])

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture
def server() -> Iterator[Server]:
    """Serve a skeleton and a motion."""
    server = Server(("127.0.0.1", 0), Handler)
    server.files = {"/07/07.asf": ASF.encode(), "/07/07_02.amc": AMC.encode()}
    server.asked = []
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


def run(folder: Path, server: Server, *more: str, answer: str | None = None) -> Result:
    """Fetch the tiny capture into `folder/out`."""
    (folder / "tiny.toml").write_text(LIST)
    url = f"http://127.0.0.1:{server.server_address[1]}"
    args = ["fetch", str(folder / "tiny.toml"), "--out", str(folder / "out"), "--base-url", url]
    return CliRunner().invoke(library, [*args, *more], input=answer)


def test_terms_come_first_and_no_means_no(tmp_path: Path, server: Server) -> None:
    """Licence and credit are shown, and nothing is fetched without consent."""
    result = run(tmp_path, server, answer="n\n")
    assert result.exit_code == 1
    assert "free for all" in result.output
    assert "Thank the leg." in result.output
    assert server.asked == []


def test_all_is_fetched_with_an_index(tmp_path: Path, server: Server) -> None:
    """Files arrive whole, and the index says rates and descriptions."""
    result = run(tmp_path, server, "--yes")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "out/07/07_02.amc").read_text() == AMC
    assert "07/07_02.amc,120,walk" in (tmp_path / "out/index.csv").read_text()


def test_it_goes_on_where_it_stopped(tmp_path: Path, server: Server) -> None:
    """What is there is not asked for again; of a half only the rest is."""
    half = tmp_path / "out/07/07_02.amc.part"
    half.parent.mkdir(parents=True)
    half.write_bytes(AMC.encode()[:40])
    (tmp_path / "out/07/07.asf").write_text(ASF)
    result = run(tmp_path, server, "--yes")
    assert result.exit_code == 0, result.output
    assert server.asked == [("/07/07_02.amc", "bytes=40-")]
    assert (tmp_path / "out/07/07_02.amc").read_text() == AMC


def test_a_connection_that_ends_early_is_noticed_and_resumed(
    tmp_path: Path, server: Server
) -> None:
    """A motion cut off at the end of a frame would read; its length tells, the rest is fetched."""
    server.cut = AMC.index("\n2\n") + 1
    cut = run(tmp_path, server, "--yes")
    assert cut.exit_code == 1
    assert f"ended after {server.cut} of {len(AMC)} bytes" in cut.output
    assert not (tmp_path / "out/07/07_02.amc").exists()
    rest, server.cut, server.asked = f"bytes={server.cut}-", 0, []
    assert run(tmp_path, server, "--yes").exit_code == 0
    assert server.asked == [("/07/07_02.amc", rest)]
    assert (tmp_path / "out/07/07_02.amc").read_text() == AMC


def test_what_is_there_already_is_read_too(tmp_path: Path, server: Server) -> None:
    """A damaged file of an earlier day is named, dropped and fetched the next time."""
    assert run(tmp_path, server, "--yes").exit_code == 0
    motion = tmp_path / "out/07/07_02.amc"
    motion.write_text("<html>")
    assert run(tmp_path, server, "--yes").exit_code == 1
    assert not motion.exists()
    assert run(tmp_path, server, "--yes").exit_code == 0
    assert motion.read_text() == AMC


def test_what_does_not_read_is_not_kept(tmp_path: Path, server: Server) -> None:
    """A page of HTML in place of a motion is named and fetched again the next time."""
    server.files["/07/07_02.amc"] = b"<html>moved</html>"
    result = run(tmp_path, server, "--yes")
    assert result.exit_code == 1
    assert "07_02.amc" in result.output
    assert not (tmp_path / "out/07/07_02.amc").exists()
    server.files["/07/07_02.amc"] = AMC.encode()
    assert run(tmp_path, server, "--yes").exit_code == 0


def test_a_missing_file_is_named(tmp_path: Path, server: Server) -> None:
    """One absent file does not stop the others."""
    del server.files["/07/07.asf"]
    result = run(tmp_path, server, "--yes")
    assert result.exit_code == 1
    assert "404" in result.output


def test_the_shipped_list_reads() -> None:
    """It has a skeleton for every motion; unknown names say what is known."""
    capture = find_capture("cmu-locomotion")
    skeletons = {f.path.split("/")[0] for f in capture.files if f.path.endswith(".asf")}
    assert len(capture.files) > 200
    assert {f.path.split("/")[0] for f in capture.files} == skeletons
    with pytest.raises(CaptureError, match="cmu-locomotion"):
        find_capture("nothing")


def test_paths_may_not_leave_the_folder(tmp_path: Path) -> None:
    """A list cannot write outside the folder that it is fetched into."""
    path = tmp_path / "bad.toml"
    path.write_text(LIST.replace("07/07.asf", "../07.asf"))
    with pytest.raises(CaptureError, match="leaves the folder"):
        find_capture(str(path))
