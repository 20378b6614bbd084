"""Fixtures of the judge's tests: a library, what it measures, a clip as stream."""

from collections.abc import Callable

import numpy as np
import pytest

from stridewire.motion.clip import Pose
from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.streaming import Seams, Stream, Wanted
from stridewire_engine.library import Library
from stridewire_engine.runtime.sampling import Moments


@pytest.fixture(scope="session")
def captured(small_library: Library) -> Captured:
    """Return the figures of the small library's frames."""
    return Captured(small_library)


@pytest.fixture
def replay(captured: Captured) -> Callable[[str], Stream]:
    """Return a maker of streams of one character that shows a clip of the library, untouched."""

    def make(name: str) -> Stream:
        library = captured.library
        entry = library.entry(name)
        rows = np.arange(entry.start, entry.start + entry.frames - 1)[:, None]
        clip = library.clip(name)
        pose = Pose(
            clip.pose.root_position[:-1, None].astype(float),
            clip.pose.root_rotation[:-1, None].astype(float),
            clip.pose.hips[:-1, None].astype(float),
            clip.pose.rotations[:-1, None].astype(float),
        )
        velocity = np.diff(clip.pose.root_position[:, [0, 2]], axis=0)[:, None] * 60.0
        none = np.zeros(0, int)
        return Stream(
            pose,
            captured.positions[rows].astype(float),
            rows,
            Moments(rows, np.zeros(rows.shape, np.float32)),
            np.full(rows.shape, 1000),
            np.full((*rows.shape, 2, 3), np.nan),
            np.zeros((*rows.shape, 4)),
            np.zeros(rows.shape, bool),
            # as long as the way really is, so that what is asked is what is done
            Wanted(np.concatenate([velocity[:1], velocity[:-1]]), np.full(rows.shape, np.nan)),
            Seams(none, none, none),
        )

    return make
