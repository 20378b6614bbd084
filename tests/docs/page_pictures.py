"""Takes the pictures of the page that the documents show, anew: `make page-pictures`.

Needs Chromium and Playwright. On a machine without a graphics card it takes minutes: all that is
seen is drawn with shadows on the processor.
"""

import argparse
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from browsing import Visit, absent, visit
from stridewire.formats.bvh_writing import write_bvh
from stridewire_engine.building.synthetic import synthetic_clips

IMAGES = Path(__file__).parents[2] / "docs" / "images"
WIDE = (1280, 760)
PHONE = (390, 780)


@contextmanager
def playing(*arguments: str) -> Iterator[str]:
    """Run `stridewire play`; gives the address of its page."""
    command = [sys.executable, "-m", "stridewire", "play", "--no-browser", "--port", "0", "--json"]
    with subprocess.Popen([*command, *arguments], stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        try:
            yield json.loads(server.stdout.readline())["url"]
        finally:
            server.terminate()


def shoot(visiting: Visit, path: Path) -> None:
    """Write a picture of what is shown, drawn as well as can be."""
    visiting.ask("stage.choose(0);")
    visiting.page.wait_for_timeout(4000.0)
    visiting.page.screenshot(path=path, timeout=120_000.0)
    print(path)


def drive(visiting: Visit, seconds: float, *keys: str) -> None:
    """Hold keys until so many seconds more were played, the camera turning half way."""
    for key in keys:
        visiting.page.keyboard.down(key)
    end = visiting.ask("return play.history.end;") + seconds
    visiting.wait(f"play.history.end > {end - 0.5 * seconds}", 300.0)
    visiting.ask("stage.look.yaw -= 1.2;")
    visiting.wait(f"play.history.end > {end}", 300.0)


def driven(url: str, out: Path) -> None:
    """One character that runs a curve, looked back at in the middle of a transition."""
    with visit(url, WIDE) as visiting:
        visiting.wait("play.drawn", 300.0)
        visiting.page.get_by_label("raw ghost").check(timeout=120_000.0)
        visiting.page.evaluate("document.activeElement.blur()")
        drive(visiting, 9.0, "KeyW", "ShiftLeft")
        visiting.ask("play.cursor = play.history.transitions.at(-2).time + 0.1;")
        visiting.ask("Object.assign(stage.look, { distance: 4.6, pitch: 0.3 });")
        visiting.ask(
            "const [w, , y] = play.drawn.root.slice(3);"
            " stage.look.yaw = 2 * Math.atan2(y, w) + 0.8;"
        )
        visiting.page.wait_for_timeout(1500.0)
        shoot(visiting, out / "play.png")


def crowded(url: str, out: Path) -> None:
    """A crowd of 64."""
    with visit(url, WIDE) as visiting:
        visiting.wait("play.drawn", 300.0)
        visiting.page.get_by_label("crowd of 64").check(timeout=120_000.0)
        visiting.page.evaluate("document.activeElement.blur()")
        visiting.ask("Object.assign(stage.look, { distance: 10, pitch: 0.5 });")
        drive(visiting, 6.0, "KeyW")
        shoot(visiting, out / "play-crowd.png")


def on_a_phone(url: str, out: Path) -> None:
    """The same at phone width."""
    phone = {"has_touch": True, "is_mobile": True, "device_scale_factor": 2}
    with visit(url, PHONE, **phone) as visiting:
        visiting.wait("play.drawn", 300.0)
        drive(visiting, 5.0, "KeyW")
        shoot(visiting, out / "play-phone.png")


def side_by_side(folder: Path, out: Path) -> None:
    """Two generated clips at the same moment.

    Args:
        folder: Where their files go.
        out: Where the picture goes.
    """
    clips = {clip.name: clip for clip in synthetic_clips()}
    files = [folder / "walk.bvh", folder / "about-turn.bvh"]
    for path, name in zip(files, ("walk-1.4", "about-turn-1.3-left"), strict=True):
        write_bvh(path, clips[name])
    with playing(*map(str, files)) as url, visit(url, WIDE) as visiting:
        visiting.wait("play.time > 0 && play.subjects.every(({ bodies }) => bodies)", 300.0)
        visiting.page.get_by_label("time").fill("2.6")
        shoot(visiting, out / "play-files.png")


def main() -> int:
    """Take all pictures, or those that are named."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, default=IMAGES)
    parser.add_argument("--library", help="built before; else the embedded one")
    parser.add_argument("names", nargs="*", metavar="NAME")
    given = parser.parse_args()
    if reason := absent():
        print(reason, file=sys.stderr)
        return 1
    live = [take for take in (driven, crowded, on_a_phone) if wanted(take, given.names)]
    if live:
        with playing(*(["--library", given.library] if given.library else [])) as url:
            for take in live:
                take(url, given.out)
    if wanted(side_by_side, given.names):
        with TemporaryDirectory() as folder:
            side_by_side(Path(folder), given.out)
    return 0


def wanted(take: Callable[..., None], names: list[str]) -> bool:
    """Tell whether a picture was named, or none."""
    return not names or take.__name__ in names


if __name__ == "__main__":
    sys.exit(main())
