"""Figures of `importing.py`: how well limbs and planted toes of a file survive retargeting."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from capture import capture

from stridewire.formats.reading import read_motion
from stridewire.motion import kinematics
from stridewire.motion.array_types import Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.cleaning import leading_pose, mend_spikes
from stridewire_engine.building.figure import NEXT, SIDES, Figure, direction, see
from stridewire_engine.building.importing import (
    ACCLAIM_RATE,
    Outcome,
    import_files,
    motion_files,
)
from stridewire_engine.building.onto_reference import find_profile
from stridewire_engine.building.profiles import shipped_profiles
from stridewire_engine.building.retarget import retarget
from stridewire_engine.building.sidecars import Sidecars

PLANTED = 0.25
"""Speed below which a low toe of the source counts as planted; m/s."""


@dataclass(frozen=True)
class Family:
    """Files of one skeleton family."""

    frames: int
    limbs: float
    """Mean angle between limbs of source and result; degrees."""
    planted: int
    source_slide: float
    """Mean speed over the ground of planted toes of the source, scaled; cm/s."""
    slide: float
    """The same of the result."""

    @staticmethod
    def together(files: Sequence["Family"]) -> "Family":
        """Return the mean over frames and over planted frames."""
        frames = sum(file.frames for file in files)
        planted = sum(file.planted for file in files)
        return Family(
            frames,
            sum(file.limbs * file.frames for file in files) / frames,
            planted,
            sum(file.source_slide * file.planted for file in files) / max(planted, 1),
            sum(file.slide * file.planted for file in files) / max(planted, 1),
        )


@cache
def outcomes() -> tuple[Outcome, ...]:
    """Import every motion file of the capture once."""
    return tuple(import_files(motion_files([capture()]), jobs=2))


def measure(path: Path) -> Family | None:
    """Retarget a file and compare; None where it is shorter than 30 frames."""
    source = read_motion(path)
    rate = Sidecars().of(path).frame_rate or source.frame_rate or ACCLAIM_RATE
    source, _ = mend_spikes(source.after(leading_pose(source)), rate)
    if len(source) < 30:
        return None
    profile = find_profile(source, shipped_profiles())
    figure = see(source, profile.source_joints(source.skeleton), profile.up)
    result = retarget(source, profile, rate)
    now, _ = kinematics.forward(REFERENCE, result.hips, result.rotations)
    limbs = float(np.mean([_apart(figure, now, part, end) for part, end in NEXT.items()]))
    slides = [_slides(figure, now, side, result.scale, rate) for side in SIDES]
    planted = sum(len(was) for was, _ in slides)
    if not planted:
        return Family(len(source), limbs, 0, 0.0, 0.0)
    was, after = (100.0 * float(np.concatenate(p).mean()) for p in zip(*slides, strict=True))
    return Family(len(source), limbs, planted, was, after)


def _apart(figure: Figure, now: Vectors, part: str, end: str) -> float:
    was = direction(figure.at(end) - figure.at(part))
    limb = direction(now[:, REFERENCE.index(end)] - now[:, REFERENCE.index(part)])
    return float(np.rad2deg(np.arccos(np.clip(np.sum(was * limb, axis=-1), -1.0, 1.0))).mean())


def _slides(
    figure: Figure, now: Vectors, side: str, scale: float, rate: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return speeds over the ground of the source's and the result's toe while planted; m/s."""
    if side not in figure.toes:
        return np.zeros(0), np.zeros(0)
    toe = figure.toes[side] * scale
    velocity = np.gradient(toe, 1.0 / rate, axis=0)
    low = toe[:, 1] < np.percentile(toe[:, 1], 10.0) + 0.05
    planted = low & (np.linalg.norm(velocity, axis=-1) < PLANTED)
    result = np.gradient(now[:, REFERENCE.index(f"{side}Toe")], 1.0 / rate, axis=0)
    was, after = (np.linalg.norm(v[planted][:, [0, 2]], axis=-1) for v in (velocity, result))
    return was, after
