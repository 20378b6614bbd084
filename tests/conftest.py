"""Fixtures of the whole suite: seeded motion, and the capture where it is present."""

import os
import tarfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions
from stridewire.motion.clip import Clip, Pose, TagSpan
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building import build_library
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.library import Library

# the machine decides how long an example takes, and a seed which examples there are
settings.register_profile("suite", deadline=None, derandomize=True, database=None)
settings.load_profile("suite")

ARCHIVES = ("lafan1", "cmu", "cmu-more", "exporters")


@pytest.fixture
def rng() -> np.random.Generator:
    """Return the one source of randomness of a test."""
    return np.random.default_rng(20240229)


@pytest.fixture
def random_rotations(rng: np.random.Generator) -> Callable[..., Quaternions]:
    """Return a maker of uniformly distributed unit quaternions `(*shape, 4)` in float64."""

    def make(*shape: int) -> Quaternions:
        return quaternion.normalize(rng.normal(size=(*shape, 4)))

    return make


@pytest.fixture
def random_pose(
    rng: np.random.Generator, random_rotations: Callable[..., Quaternions]
) -> Callable[..., Pose]:
    """Return a maker of arbitrary float64 poses `(*shape)` on the reference skeleton."""

    def make(*shape: int) -> Pose:
        return Pose(
            rng.normal(size=(*shape, 3)) * (3.0, 0.0, 3.0),
            quaternion.from_yaw(rng.uniform(-np.pi, np.pi, shape)),
            rng.normal(size=(*shape, 3)) * 0.1 + (0.0, 0.9, 0.0),
            random_rotations(*shape, len(REFERENCE)),
        )

    return make


@pytest.fixture
def swaying_clip(rng: np.random.Generator) -> Clip:
    """Return two seconds at 60 fps of smooth motion that walks along +Z, with three tags."""
    frames = 121
    time = np.arange(frames) / 60.0
    phases = rng.uniform(0.0, 2.0 * np.pi, (len(REFERENCE), 3))
    sway = 0.4 * np.sin(2.0 * np.pi * time[:, None, None] + phases)
    root = np.stack([np.sin(time), np.zeros(frames), 1.3 * time], axis=-1)
    hips = np.stack([0.02 * np.sin(6.0 * time), 0.9 + 0.02 * np.cos(12.0 * time), 0.0 * time], -1)
    return Clip(
        "sway",
        REFERENCE,
        60.0,
        Pose(
            root, quaternion.from_yaw(0.3 * np.sin(time)), hips, quaternion.from_scaled_axis(sway)
        ),
        np.sin(2.0 * np.pi * time[:, None] + np.arange(4)) > 0.0,
        (TagSpan("walk", 0, 121), TagSpan("turn-left", 10, 40), TagSpan("stop", 100, 121)),
        "test",
    )


@pytest.fixture(scope="session")
def small_library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Return a library of a few synthetic clips and their mirrored copies."""
    wanted = ("idle-", "walk-1.4", "walk-turn", "run-3", "start-walk", "stop")
    clips = [clip for clip in synthetic_clips() if clip.name.startswith(wanted)]
    folder = tmp_path_factory.mktemp("library") / "small"
    return build_library(clips, folder, name="small", synthetic=True, licence="none")


@pytest.fixture(scope="session")
def capture(pytestconfig: pytest.Config) -> Path:
    """Return the folder of the unpacked capture; unpack archives once, into pytest's cache."""
    given = os.environ.get("STRIDEWIRE_DATA", "")
    folder = Path(given)
    if not given or not folder.is_dir():
        pytest.skip("needs the capture: STRIDEWIRE_DATA names no folder")
    if any((folder / name).is_dir() for name in ARCHIVES):
        return folder
    archives = sorted(folder.glob("*.tar.xz"))
    if not archives:
        pytest.skip(f"needs the capture: {folder} holds neither its folders nor .tar.xz archives")
    unpacked = pytestconfig.cache.mkdir("capture")
    for archive in archives:
        _unpack(archive, unpacked)
    return unpacked


def _unpack(archive: Path, into: Path) -> None:
    """Unpack unless this very archive was unpacked before."""
    state = archive.stat()
    stamp = into / f"{archive.name}.done"
    signature = f"{state.st_size} {state.st_mtime_ns}"
    if stamp.exists() and stamp.read_text() == signature:
        return
    with tarfile.open(archive) as tar:
        tar.extractall(into, filter="data")
    stamp.write_text(signature)
