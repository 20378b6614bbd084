"""Mutated motion files: a clear error or a finite motion, never another exception, a hang or NaN.

500 files by default; `STRIDEWIRE_FUZZ_FILES` asks for another number.
"""

import os
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np
import pytest
from tests.unit.building.figures import source
from tests.unit.formats.test_acclaim import AMC, ASF

from stridewire.formats.bvh_writing import write_source_bvh
from stridewire.formats.reading import read_motion
from stridewire_engine.building.importing import import_file

T = TypeVar("T")

FILES = int(os.environ.get("STRIDEWIRE_FUZZ_FILES", "500"))

TOKENS = (
    *(b"nan", b"inf", b"-", b"1e308", b"1e12", b"-0", b"0", b"1,5", b"{", b"}", b"#", b":", b""),
    *(b"JOINT", b"ROOT", b"End Site", b"OFFSET", b"CHANNELS 3", b"MOTION", b"Frames: 99999999"),
    *(
        b"Frame Time: 1e-9",
        b"begin",
        b"end",
        b"root",
        b"dof rx",
        b"\xff\xfe",
        b"\x00",
        b"\r",
        b"9" * 400,
    ),
)


def mutated(text: bytes, rng: np.random.Generator) -> bytes:
    """Change a file in one to four places: tokens, lines, bytes, its end."""
    for _ in range(rng.integers(1, 5)):
        lines = text.split(b"\n")
        at = int(rng.integers(len(lines)))
        match rng.integers(7):
            case 0:
                del lines[at]
            case 1:
                lines.insert(at, lines[int(rng.integers(len(lines)))])
            case 2:
                lines = lines[:at]
            case 3:
                lines[at], lines[-1] = lines[-1], lines[at]
            case 4:
                words = lines[at].split(b" ")
                words[int(rng.integers(len(words)))] = TOKENS[int(rng.integers(len(TOKENS)))]
                lines[at] = b" ".join(words)
            case 5:
                words = lines[at].split(b" ")
                del words[int(rng.integers(len(words)))]
                lines[at] = b" ".join(words)
            case _:
                raw = bytearray(text)
                if raw:
                    raw[int(rng.integers(len(raw)))] = int(rng.integers(256))
                lines = bytes(raw).split(b"\n")
        text = b"\n".join(lines)
    return text


def seeds(folder: Path) -> list[tuple[str, bytes]]:
    """Return endings and texts of small files to mutate."""
    short = replace(source(frames=20, frame_rate=30.0), path=folder / "a.bvh")
    write_source_bvh(folder / "a.bvh", short)
    text = re.sub(rb"(\.\d\d)\d+", rb"\1", (folder / "a.bvh").read_bytes())
    return [(".bvh", text), (".amc", AMC.encode()), (".asf", ASF.encode())]


@pytest.mark.timeout(0 if FILES > 500 else 120)
def test_no_file_breaks_a_reader(tmp_path: Path, rng: np.random.Generator) -> None:
    """Readers and importer refuse with a message or return finite numbers."""
    originals = seeds(tmp_path)
    read, imported = 0, 0
    for _ in range(FILES):
        (tmp_path / "a.asf").write_bytes(ASF.encode())
        (tmp_path / "a.amc").write_bytes(AMC.encode())
        ending, original = originals[int(rng.integers(len(originals)))]
        path = tmp_path / f"a{ending}"
        path.write_bytes(mutated(original, rng))
        motion = path.with_suffix(".amc") if ending == ".asf" else path
        found, problem = _attempt(read_motion, motion)
        if found is None:
            assert str(tmp_path) in problem
            continue
        read += 1
        assert np.isfinite(found.rotations).all()
        assert np.isfinite(found.global_poses()[0]).all()
        outcome, problem = _attempt(import_file, motion)
        assert outcome is not None or problem
        imported += outcome is not None
    assert read > FILES // 20
    assert imported > FILES // 200


def _attempt(job: Callable[[Path], T], path: Path) -> tuple[T | None, str]:
    """Return the result, or None and the message of a refusal."""
    try:
        return job(path), ""
    except ValueError as error:
        return None, str(error)
