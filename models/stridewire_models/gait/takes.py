"""Takes: which captured trials the gait model is fitted on.

All are of training subjects of the CMU Graphics Lab database who walk, run and turn as people do;
trials on uneven ground, sad or stealthy ones, jumps, dodges and quick stops are left out, and the
two-second cuts, whose timing is wrong.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from stridewire.motion.clip import Clip
from stridewire_engine.building.importing import import_files

TRIALS: dict[str, tuple[int, ...]] = {
    "02": (1, 2, 3),
    "05": (1,),
    "32": (1, 2),
    "35": (*range(1, 27), *range(28, 35)),
    "46": (1,),
    "49": (1,),
    "69": (6,),
    "83": (37, 38, 39),
    "91": (1, 2, 4, 17),
    "127": (3, 4, *range(6, 13), 15, 16),
}
"""Trials by subject."""


class MissingCaptureError(ValueError):
    """The capture is not where it was said to be; the message says what to do."""


@dataclass(frozen=True)
class Take:
    """One trial on the reference skeleton."""

    subject: str
    clip: Clip


def take_files(data: Path) -> list[Path]:
    """Return the files of all trials.

    Args:
        data: Folder that holds `cmu/`, unpacked, or `cmu/` itself.

    Raises:
        MissingCaptureError: If a trial is not there.
    """
    root = data / "cmu" if (data / "cmu").is_dir() else data
    return [
        _find(root, subject, f"{subject}_{trial:02d}")
        for subject, trials in TRIALS.items()
        for trial in trials
    ]


def load_takes(files: list[Path]) -> Iterator[Take]:
    """Import the trials one by one.

    Raises:
        MissingCaptureError: If one cannot be imported.
    """
    for outcome in import_files(files):
        if outcome.clip is None:
            raise MissingCaptureError(f"{outcome.path}: {outcome.problem}")
        yield Take(outcome.path.parent.name, outcome.clip)


def _find(root: Path, subject: str, name: str) -> Path:
    for ending in (".amc", ".bvh"):
        path = root / subject / (name + ending)
        if path.is_file():
            return path
    raise MissingCaptureError(
        f"no {subject}/{name}.amc or .bvh in {root}; give the folder that holds the unpacked CMU "
        "trials by subject, from mocap.cs.cmu.edu"
    )
