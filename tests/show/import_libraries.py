"""Libraries of `importing.py`: the judge's by one command each, a person's own step by step."""

import shlex
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from capture import BUILD, GIVEN, capture
from import_figures import outcomes
from points import ROOT, Point

from stridewire.formats.bvh_writing import write_source_bvh
from stridewire.formats.reading import read_motion
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.building import embedded_library
from stridewire_engine.building.importing import motion_files
from stridewire_engine.building.sidecars import read_splits
from stridewire_engine.library import Library

LOCOMOTION = ("idle", "walk", "jog", "run", "turn", "start", "stop")
OTHERS = ("low", "aloft", "fall", "push", "fight", "sport", "dance", "jump", "aiming")
"""Tags of what is no plain locomotion; long takes hold both, so it is cut out of them."""
UNKNOWN = "exporters/odd/mixamo_walk_circle_65j.bvh"
"""A walk on a circle; its joints are renamed, so that only the tree tells what they are."""


@dataclass(frozen=True)
class Recipe:
    """How a library of the judge is built."""

    name: str
    inputs: tuple[str, ...]
    split: tuple[str, ...]
    tagged: tuple[str, ...]
    without: tuple[str, ...] = ()

    def command(self, out: Path) -> list[str | Path]:
        """Return the arguments that build it."""
        words: list[str | Path] = ["library", "build", *(capture() / part for part in self.inputs)]
        words += ["--out", out, "--split-file", GIVEN / "split.csv"]
        words += [word for split in self.split for word in ("--split", split)]
        words += [word for tag in self.tagged for word in ("--tagged", tag)]
        return words + [word for tag in self.without for word in ("--without", tag)]

    def minutes(self) -> float:
        """Return how much motion is read for it."""
        splits = read_splits(GIVEN / "split.csv")
        files = set(motion_files([capture() / part for part in self.inputs], self.split, splits))
        return sum(o.clip.seconds for o in outcomes() if o.clip and o.path in files) / 60.0


LIBRARIES = (
    Recipe("cmu-seen", ("cmu", "cmu-more"), ("train",), LOCOMOTION),
    Recipe("cmu-heldout", ("cmu", "cmu-more"), ("test",), LOCOMOTION),
    Recipe("lafan1-dev", ("lafan1",), ("train", "validation"), (), OTHERS),
    Recipe("lafan1", ("lafan1",), ("test",), (), OTHERS),
)
STANDARD = Recipe("cmu-locomotion", ("cmu", "cmu-more"), (), LOCOMOTION)
"""Of the standard load: everybody's, since `cmu-seen` alone has 38 k frames, not 60 k."""


def libraries() -> Iterator[Point]:
    """The judge's libraries: one command each, streamed and drawn."""
    for recipe in LIBRARIES:
        out = BUILD / "libraries" / recipe.name
        seconds = _run(recipe.command(out))
        library = Library.open(out)
        kept = sum(clip.frames for clip in library.clips) / library.frame_rate / 60.0
        read = recipe.minutes()
        yield Point(
            f"library {recipe.name} by one command",
            f"{len(library.clips)} clips, {kept:.1f} min with mirrored copies, of {read:.1f} min "
            f"captured in {seconds:.0f} s, {seconds / read:.2f} s per minute of capture",
            "it opens",
            True,
        )
        yield _streamed(recipe.name, ["--library", out])
    yield Point(
        "the synthetic library",
        f"{len(embedded_library().clips)} clips",
        "marked synthetic",
        embedded_library().info().synthetic,
    )
    yield _streamed("synthetic", ["--library", embedded_library().path])


def own_file() -> Iterator[Point]:
    """A person's own file of an unknown skeleton, from file to streamed motion."""
    folder = BUILD / "own"
    folder.mkdir(parents=True, exist_ok=True)
    mine = _renamed(capture() / UNKNOWN, folder / "me.bvh")
    steps: list[list[str | Path]] = [
        ["library", "profile", mine, "--out", folder / "me.toml"],
        ["library", "build", mine, "--profile", folder / "me.toml", "--out", folder / "library"],
        ["library", "report", folder / "library", "--out", folder / "report.png"],
        ["stream", "--library", folder / "library", "--out", folder / "walk.bvh"],
        ["render", folder / "walk.bvh", "--out", folder / "walk.png"],
    ]
    for step in steps:
        seconds = _run(step)
        said = shlex.join(str(word).removeprefix(f"{folder}/") for word in step)
        yield Point(f"own file: stridewire {said}", f"{seconds:.1f} s", "it succeeds", True)


def _streamed(name: str, where: list[str | Path]) -> Point:
    """Drive a character over a library, and draw it."""
    bvh, png = (BUILD / "libraries" / f"{name}{ending}" for ending in (".bvh", ".png"))
    bvh.parent.mkdir(parents=True, exist_ok=True)
    seconds = _run(["stream", *where, "--script", "walk-turn-stop", "--out", bvh])
    _run(["render", bvh, "--out", png])
    return Point(
        f"library {name} streamed", f"{seconds:.1f} s, {png.relative_to(ROOT)}", "look at it", True
    )


def _renamed(known: Path, out: Path) -> Path:
    """Write a motion anew whose joints have numbers for names."""
    motion = read_motion(known)
    skeleton = motion.skeleton
    names = tuple(f"Bone.{number:03}" for number in range(1, len(skeleton) + 1))
    renamed = Skeleton(names, skeleton.parents, skeleton.offsets)
    write_source_bvh(out, replace(motion, skeleton=renamed))
    return out


def _run(words: list[str | Path]) -> float:
    """Run a command of ours and return its seconds; one that fails ends the stage."""
    command = [str(Path(sys.executable).with_name("stridewire")), *map(str, words)]
    start = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{shlex.join(command)}: {done.stderr[-300:]}")
    return time.monotonic() - start
