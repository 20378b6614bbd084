"""Golden vectors: what positions and turns are in each engine, worked out by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stridewire.coordinates import (
    BLENDER,
    GLTF,
    GODOT,
    SYSTEMS,
    UNITY,
    UNREAL,
    CoordinateSystem,
)
from stridewire.motion import kinematics, quaternion
from stridewire.motion.skeleton import REFERENCE

S = np.sqrt(0.5)
LEFT, UP, AHEAD = np.eye(3)
TURN_LEFT = quaternion.from_yaw(np.array(0.5 * np.pi))
"""A quarter turn to the left, about up."""
NOD = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(0.5 * np.pi))
"""A quarter turn that brings ahead down: about the left."""
LEAN = quaternion.from_axis_angle((0.0, 0.0, 1.0), np.array(0.5 * np.pi))
"""A quarter turn that brings left up: about ahead."""

GOLDEN = [
    # system, left, up, ahead, turn left, nod, lean (in the engine's order)
    (UNITY, (-1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -S, 0, S), (S, 0, 0, S), (0, 0, -S, S)),
    (UNREAL, (0, -100, 0), (0, 0, 100), (100, 0, 0), (0, 0, -S, S), (0, S, 0, S), (-S, 0, 0, S)),
    (GODOT, (-1, 0, 0), (0, 1, 0), (0, 0, -1), (0, S, 0, S), (-S, 0, 0, S), (0, 0, -S, S)),
    (GLTF, (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, S, 0, S), (S, 0, 0, S), (0, 0, S, S)),
    (BLENDER, (1, 0, 0), (0, 0, 1), (0, -1, 0), (S, 0, 0, S), (S, S, 0, 0), (S, 0, -S, 0)),
]


@pytest.mark.parametrize("golden", GOLDEN, ids=lambda golden: golden[0].name)
def test_golden_vectors(golden: tuple[CoordinateSystem, ...]) -> None:
    """Axes and quarter turns about each of them."""
    system, *expected = golden
    made = [system.positions(v) for v in (LEFT, UP, AHEAD)]
    made += [system.rotations(q) for q in (TURN_LEFT, NOD, LEAN)]
    for ours, theirs in zip(made, expected, strict=True):
        np.testing.assert_allclose(ours, theirs, atol=1e-12)


def test_handedness_is_what_the_engines_say() -> None:
    """Unity and Unreal are left-handed, the others right-handed."""
    assert [system.handedness for system in SYSTEMS] == [-1.0, -1.0, 1.0, 1.0, 1.0]


def rotate_theirs(system: CoordinateSystem, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Turn a vector by the formula that every engine uses, q v q*, whatever its handedness."""
    scalar, vector = (q[3], q[:3]) if system.scalar_last else (q[0], q[1:])
    return np.asarray(v + 2.0 * np.cross(vector, np.cross(vector, v) + scalar * v))


@pytest.mark.parametrize("system", SYSTEMS, ids=lambda system: system.name)
@given(seed=st.integers(0, 2**32 - 1))
def test_turning_then_converting_is_converting_then_turning(
    system: CoordinateSystem, seed: int
) -> None:
    """The engine's own arithmetic gives the same places; there and back is where it was."""
    rng = np.random.default_rng(seed)
    q, v = quaternion.normalize(rng.normal(size=4)), rng.normal(size=3)
    here = system.positions(quaternion.rotate(q, v))
    there = rotate_theirs(system, system.rotations(q), system.positions(v))
    np.testing.assert_allclose(here, there, atol=1e-9)
    np.testing.assert_allclose(system.positions_back(system.positions(v)), v, atol=1e-12)
    np.testing.assert_allclose(system.rotations_back(system.rotations(q)), q, atol=1e-12)


@pytest.mark.parametrize("system", SYSTEMS, ids=lambda system: system.name)
def test_a_whole_pose_converts_joint_by_joint(
    system: CoordinateSystem, rng: np.random.Generator
) -> None:
    """Local rotations on a converted skeleton put every joint where it belongs."""
    local = quaternion.normalize(rng.normal(size=(22, 4)))
    ours, _ = kinematics.forward(REFERENCE, REFERENCE.offsets[0], local)
    skeleton = system.skeleton(REFERENCE)
    turned = system.rotations(local)
    places: list[np.ndarray] = []
    chains: list[list[np.ndarray]] = []
    for joint, parent in enumerate(REFERENCE.parents):
        above = chains[parent] if parent >= 0 else []
        offset = skeleton.offsets[joint]
        for q in reversed(above):
            offset = rotate_theirs(system, q, offset)
        places.append(offset + (places[parent] if parent >= 0 else 0.0))
        chains.append([*above, turned[joint]])
    np.testing.assert_allclose(places, system.positions(ours), atol=1e-9)
    np.testing.assert_allclose(system.skeleton_back(skeleton).offsets, REFERENCE.offsets)


@pytest.mark.parametrize("system", SYSTEMS, ids=lambda system: system.name)
def test_float32_stays_float32(system: CoordinateSystem) -> None:
    """What a frame holds is not widened."""
    assert system.positions(np.zeros((2, 3), np.float32)).dtype == np.float32
    assert system.rotations(np.zeros((2, 22, 4), np.float32)).dtype == np.float32
