"""Ground: characters stand and walk on what the caller tells of; level ground changes nothing."""

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, Frame, Ground, Open, Sparse, Step
from stridewire.motion import kinematics
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.runtime import Runtime
from unit.runtime.conftest import DT, one

TOES = REFERENCE.indices(["LeftToe", "RightToe"])
STITCHERS = ("spring", "stance")


def walk(runtime: Runtime, stitcher: str, ground: object, seconds: float = 4.0) -> list[Frame]:
    """Walk along z; `ground` tells of the ground under a root, or gives None."""
    session = runtime.open(Open([CharacterSpec(1, stitcher=stitcher)], seed=3))
    frames: list[Frame] = []
    for i in range(round(seconds / DT)):
        root = frames[-1].root[0] if frames else np.zeros(7)
        told = ground(root)  # type: ignore[operator]
        sparse = [] if told is None else [Sparse(1, ground=told)]
        frame, wrong = one(runtime, session, Step(i, DT, velocity_xz=[[0.0, 1.3]], sparse=sparse))
        assert not wrong
        frames.append(frame)
    return frames


def toes(frame: Frame) -> np.ndarray:
    """Return the toes `(2, 3)` in the world."""
    pose = Pose(frame.root[:, :3], frame.root[:, 3:], frame.hips, frame.rotations)
    return kinematics.forward_world(REFERENCE, pose)[0][0, TOES]


@pytest.mark.parametrize("stitcher", STITCHERS)
def test_level_ground_changes_nothing(runtime: Runtime, stitcher: str) -> None:
    """Told of ground that is where the floor is, a character moves as if told of none."""
    plain = walk(runtime, stitcher, lambda root: None)
    told = walk(runtime, stitcher, lambda root: Ground())
    for a, b in zip(plain, told, strict=True):
        assert np.allclose(a.root, b.root, atol=1e-6)
        assert np.allclose(a.hips, b.hips, atol=2e-3)
        assert np.allclose(toes(a), toes(b), atol=2e-3)


@pytest.mark.parametrize("stitcher", STITCHERS)
@pytest.mark.parametrize("degrees", [-15.0, 15.0])
def test_feet_stand_on_a_slope(runtime: Runtime, stitcher: str, degrees: float) -> None:
    """Up and down a slope the root is on it, and toes are above it as on the floor."""
    rise = np.tan(np.radians(degrees))
    normal = np.array([0.0, 1.0, -rise]) / np.hypot(1.0, rise)
    flat = walk(runtime, stitcher, lambda root: None)
    sloped = walk(runtime, stitcher, lambda root: Ground(rise * root[2], tuple(normal)))
    assert sloped[-1].root[0, 2] > 2.0
    for a, b in zip(flat, sloped, strict=True):
        assert b.root[0, 1] == pytest.approx(rise * b.root[0, 2], abs=1e-4)
        above = toes(b)[:, 1] - rise * toes(b)[:, 2]
        assert np.allclose(above, toes(a)[:, 1], atol=0.01)


def test_a_step_is_climbed_smoothly(runtime: Runtime) -> None:
    """Where the ground rises by 20 cm the root rises within half a second and never jumps."""
    frames = walk(runtime, "stance", lambda root: Ground(0.2 if root[2] > 1.5 else 0.0), 5.0)
    heights = np.array([frame.root[0, 1] for frame in frames])
    assert heights[-1] == pytest.approx(0.2, abs=1e-3)
    # a spring of 0.08 s that moves 20 cm is never faster than 1.3 m/s
    assert np.abs(np.diff(heights)).max() < 1.3 * DT
    deltas = np.sum([frame.root_delta[0, 1] for frame in frames])
    assert deltas == pytest.approx(heights[-1], abs=1e-4)


def test_each_foot_stands_at_its_own_height(runtime: Runtime) -> None:
    """Standing with the right foot on a box, the left one stays down."""
    box = Ground(foot_heights=np.array([0.0, 0.0, 0.15, 0.15]))
    session = runtime.open(Open([CharacterSpec(1, stitcher="stance")], seed=3))
    for i in range(180):
        frame, _ = one(runtime, session, Step(i, DT, sparse=[Sparse(1, ground=box)]))
    left, right = toes(frame)[:, 1]
    assert right - left == pytest.approx(0.15, abs=0.01)
    assert frame.foot_targets[0, 1, 1] == pytest.approx(0.15 + 0.02, abs=0.01)
