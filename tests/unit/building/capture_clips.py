"""Importing files of the capture in tests, and what to ask of the outcome."""

from pathlib import Path

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.importing import Outcome, import_file


def imported(path: Path) -> Clip:
    """Import a file that must not be refused."""
    clip = import_file(path).clip
    assert clip is not None
    return clip


def said(outcome: Outcome) -> str:
    """Return the notes on a file as one text."""
    return "; ".join(outcome.notes)


def head_height(clip: Clip) -> float:
    """Return the median height of the head; metres."""
    positions, _ = kinematics.forward_world(REFERENCE, clip.pose)
    return float(np.median(positions[:, REFERENCE.index("Head"), 1]))
