"""Writing BVH: read back and imported, a clip has the same poses."""

from pathlib import Path

import numpy as np
import pytest

from stridewire.formats.bvh import read_bvh
from stridewire.formats.bvh_writing import write_bvh
from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.importing import import_file

ONE_MILLIMETRE = 1e-3


def circling_clip(frame_rate: float) -> Clip:
    """Joints on smooth random curves, walking a circle."""
    rng = np.random.default_rng(3)
    t = np.arange(round(2 * frame_rate)) / frame_rate
    phase = rng.uniform(0.0, 6.28, (len(REFERENCE), 3))
    sway = 0.4 * np.sin(3.0 * t[:, None, None] + phase)
    rotations = quaternion.from_scaled_axis(sway)
    rotations[:, 0] = quaternion.multiply(quaternion.from_yaw(0.8 * t), rotations[:, 0])
    hips = np.stack([np.sin(0.8 * t), 0.95 + 0.02 * np.sin(9 * t), np.cos(0.8 * t)], axis=-1)
    pose = extract_root(REFERENCE, hips, rotations, frame_rate)
    return Clip("sway", REFERENCE, frame_rate, pose, np.zeros((len(t), 4), bool))


@pytest.mark.parametrize("frame_rate", [30.0, 60.0, 120.0])
def test_round_trip_through_the_importer(tmp_path: Path, frame_rate: float) -> None:
    """A clip on the reference skeleton comes back within a millimetre."""
    clip = circling_clip(frame_rate)
    path = tmp_path / "sway.bvh"
    write_bvh(path, clip)
    back = import_file(path).clip
    assert back is not None
    assert back.frame_rate == 60.0
    every, each = max(1, round(frame_rate / 60.0)), max(1, round(60.0 / frame_rate))
    was, _ = kinematics.forward_world(REFERENCE, clip.pose[::every])
    now, _ = kinematics.forward_world(REFERENCE, back.pose[::each])
    assert np.abs(was[: len(now)] - now[: len(was)]).max() < ONE_MILLIMETRE


def test_the_file_is_in_centimetres_with_the_hips_in_the_root(tmp_path: Path) -> None:
    """Offsets and root are 100 times the metres."""
    clip = circling_clip(60.0)
    path = tmp_path / "sway.bvh"
    write_bvh(path, clip)
    motion = read_bvh(path)
    np.testing.assert_allclose(motion.skeleton.offsets, 100.0 * REFERENCE.offsets, atol=1e-5)
    np.testing.assert_allclose(motion.root_positions, 100.0 * clip.pose.world_hips[0], atol=1e-4)
    assert set(motion.tips) == {
        REFERENCE.index(n) for n in ("LeftToe", "RightToe", "Head", "LeftHand", "RightHand")
    }
