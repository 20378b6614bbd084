"""`make pictures`: the animation of the README, by the commands that a reader has.

stridewire serve
stridewire stream --script zigzag --seconds 6 --no-realtime --out run.bvh
stridewire render run.bvh --start 1 --animate docs/images/run.webp
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from stridewire.testing import serve

IMAGES = Path(__file__).parents[2] / "docs" / "images"


def animation() -> None:
    """Draw a character that runs along a zigzag."""
    with tempfile.TemporaryDirectory() as folder, serve() as address:
        run = Path(folder) / "run.bvh"
        drive = ["--script", "zigzag", "--seconds", "6", "--no-realtime", "--address", address]
        stridewire("stream", *drive, "--out", str(run))
        picture = str(IMAGES / "run.webp")
        stridewire("render", str(run), "--start", "1", "--animate", picture)


def stridewire(*arguments: str) -> None:
    """Run a command."""
    subprocess.run([sys.executable, "-m", "stridewire", *arguments], check=True)


if __name__ == "__main__":
    animation()
