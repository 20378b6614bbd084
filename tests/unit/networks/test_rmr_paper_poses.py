"""Poses as the paper writes them: nothing is lost, wherever the body stands and looks."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.rmr.paper_poses import (
    CONTACTS,
    NUMBERS,
    ROOT,
    VELOCITIES,
    read,
    root_path,
    write,
)


@pytest.fixture
def motion() -> tuple[np.ndarray, ...]:
    """Return bodies that walk in curves and take any pose."""
    rng = np.random.default_rng(0)
    root = np.cumsum(rng.normal(0.02, 0.01, (3, 20, 3)), axis=1) * np.array([1.0, 0.0, 1.0])
    yaw = np.cumsum(rng.normal(0.03, 0.02, (3, 20)), axis=1)
    turns = rng.normal(0.0, 0.5, (3, 20, len(REFERENCE), 3))
    hips = rng.normal(0.0, 0.05, (3, 20, 3)) + np.array([0.0, 0.9, 0.0])
    contacts = rng.random((3, 20, 2)) < 0.5
    return root, yaw, hips, quaternion.from_scaled_axis(turns), contacts


def test_poses_come_back(motion: tuple[np.ndarray, ...]) -> None:
    """What is written reads as the same hips, rotations and contacts."""
    numbers = write(*motion)
    assert numbers.shape == (3, 20, NUMBERS)
    hips, rotations = read(numbers)
    np.testing.assert_allclose(hips, motion[2], atol=1e-6)
    same = np.abs(np.sum(rotations * motion[3], axis=-1))
    np.testing.assert_allclose(same, 1.0, atol=1e-6)
    np.testing.assert_array_equal(numbers[..., CONTACTS] > 0.5, motion[4])


def test_the_path_comes_back(motion: tuple[np.ndarray, ...]) -> None:
    """Root motion adds up to the path that it was taken from."""
    root, yaw = motion[:2]
    path, turn = root_path(write(*motion)[..., ROOT].astype(np.float64))
    np.testing.assert_allclose(turn - turn[:, :1], yaw - yaw[:, :1], atol=1e-6)
    back = turn_to_root(root - root[:, :1], yaw[:, 0])
    ours = turn_to_root(path - path[:, :1], turn[:, 0])
    np.testing.assert_allclose(ours, back, atol=1e-5)


def test_numbers_do_not_tell_where_the_world_is(motion: tuple[np.ndarray, ...]) -> None:
    """The same motion elsewhere and turned is written the same; what stands still has no speed."""
    root, yaw, *body = motion
    moved = turn_to_world(root, np.full(3, 1.0)) + np.array([5.0, 0.0, -2.0])
    np.testing.assert_allclose(write(moved, yaw + 1.0, *body), write(root, yaw, *body), atol=1e-4)
    still = [np.repeat(part[:, :1], 4, axis=1) for part in motion]
    assert not write(*still)[..., VELOCITIES].any()
