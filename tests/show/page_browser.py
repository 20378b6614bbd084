"""What `make show-page` shows of the page and its door; its stages are in page.py."""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from points import ROOT, Point

sys.path.insert(0, str(ROOT / "tests"))

DOOR_TESTS = "tests/fault/test_websocket_door.py"
BROWSER_TESTS = "tests/end_to_end/test_browser.py"
DOOR = {
    "wrong origin": "refused",
    "text frames": "refused",
    "giant frames": "refused",
    "half-open sockets": "bounded",
    "1,000 connects": "bounded",
}
"""What comes to the door, and what was asked to happen then; others unharmed."""
DOOR_TEST = {
    "wrong origin": "a_foreign_page_is_not_let_in",
    "text frames": "text_ends_the_stream_alone",
    "giant frames": "giant",
    "half-open sockets": "half_open_sockets",
    "1,000 connects": "a_thousand_connects",
}
FIGURES = re.compile(r"([\d.]+) frames/s arrived, control to frame ([\d.]+) ms")
NEAR_60 = (54.0, 66.0)
PICTURE_BYTES = 60_000
"""An empty page compresses to less."""


def door() -> Iterator[Point]:
    """Bad input at the door; each test keeps a session through each door beside it."""
    for what, wanted in DOOR.items():
        passed, failed, skipped, _ = tested(DOOR_TESTS, "-k", DOOR_TEST[what])
        yield Point(f"{what} at the door", f"{passed} tests pass, {failed} fail",
                    f"{wanted}, others unharmed", passed > 0 and not failed + skipped)  # fmt: skip


def browser() -> Iterator[Point]:
    """The page in Chromium, and what arrived there."""
    passed, failed, skipped, text = tested(BROWSER_TESTS, "-s")
    figure = f"{passed} pass, {failed} fail, {skipped} are skipped"
    yield Point("browser test", figure, "green", passed > 0 and not failed + skipped)
    found = FIGURES.search(text)
    rate, latency = map(float, found.groups()) if found else (0.0, 0.0)
    yield Point("frames arriving in the browser", f"{rate:.1f} a second", "near 60 a second",
                NEAR_60[0] <= rate <= NEAR_60[1])  # fmt: skip
    yield Point("control to frame, median", f"{latency:.1f} ms", "told", found is not None)


def screenshot() -> Iterator[Point]:
    """The page while a character runs."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "tests/docs/page_pictures.py", "--out", folder, "driven"]
        ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        path = Path(folder) / "play.png"
        size = path.stat().st_size if path.exists() else 0
    yield Point("a screenshot of the page while a character runs, by a command",
                f"{size} bytes" if size else ran.stderr[-200:], "made by a command",
                size > PICTURE_BYTES)  # fmt: skip


def new_user() -> Iterator[Point]:
    """From clone to driving as a new user would, in an environment and a cache of their own."""
    with tempfile.TemporaryDirectory() as folder:
        steps = dict(walk(Path(folder)))
    told = ", ".join(f"{name} {seconds:.1f} s" for name, seconds in steps.items())
    figure = f"{told}; {sum(steps.values()):.0f} s in all"
    driving = "first step of the character" in steps
    yield Point("from clone to driving", figure, "each step timed and written down", driving)


def walk(folder: Path) -> Iterator[tuple[str, float]]:
    """Do what a new user does; yield each step and its seconds."""
    from browsing import visit

    clone, python = folder / "stridewire", folder / "venv" / "bin" / "python"
    yield "clone", timed("git", "clone", "-q", str(ROOT), str(clone))
    yield "environment", timed(sys.executable, "-m", "venv", str(folder / "venv"))
    install = [str(python), "-m", "pip", "install", "-q", f"{clone}[view]"]
    yield "pip install '.[view]'", timed(*install)
    begun = time.monotonic()
    command = [str(python), "-m", "stridewire", "play", "--no-browser", "--port", "0", "--json"]
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}
    with subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True
    ) as server:
        assert server.stdout is not None
        url = json.loads(server.stdout.readline())["url"]
        yield "first `stridewire play`", time.monotonic() - begun
        begun = time.monotonic()
        with visit(url) as visiting:
            visiting.wait("play.drawn", 300.0)
            yield "page", time.monotonic() - begun
            begun = time.monotonic()
            visiting.page.keyboard.down("KeyW")
            visiting.wait("Math.hypot(play.drawn.root[0], play.drawn.root[2]) > 0.3", 300.0)
            yield "first step of the character", time.monotonic() - begun
        server.terminate()


def timed(*command: str) -> float:
    """Run a command and return how long it took; seconds."""
    begun = time.monotonic()
    subprocess.run(command, check=True, capture_output=True)
    return time.monotonic() - begun


def tested(*arguments: str) -> tuple[int, int, int, str]:
    """Run tests; return how many passed, failed and were skipped, and what was printed."""
    command: Sequence[str] = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    counts = [
        sum(map(int, re.findall(rf"(\d+) {word}", ran.stdout)))
        for word in ("passed", "(?:failed|error)", "skipped")
    ]
    return counts[0], counts[1], counts[2], ran.stdout
