"""Where the capture is: `STRIDEWIRE_DATA` names its folders, or its archives, unpacked once."""

import os
import sys
import tarfile
from functools import cache
from pathlib import Path

from points import ROOT

GIVEN = Path(os.environ.get("STRIDEWIRE_DATA", ""))
BUILD = ROOT / "build" / "show"
DATA = GIVEN if (GIVEN / "lafan1").is_dir() else BUILD / "capture"


@cache
def capture() -> Path:
    """Return the folder of the capture, unpacked."""
    if not (GIVEN / "split.csv").is_file():
        sys.exit(f"STRIDEWIRE_DATA={GIVEN} holds no capture; name the folder of its archives")
    for archive in [] if GIVEN == DATA else sorted(GIVEN.glob("*.tar.xz")):
        folder = DATA / archive.name.removesuffix(".tar.xz")
        if not folder.is_dir():
            # an archive that is cut off half-way must not pass for a whole one
            part = DATA / f"{folder.name}.part"
            with tarfile.open(archive) as tar:
                tar.extractall(part, filter="data")
            (part / folder.name).rename(folder)
    return DATA
