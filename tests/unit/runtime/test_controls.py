"""Controls: what is refused is named and held; one bad row harms nobody else."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from stridewire._messages import (
    CorrectionMode,
    Frame,
    FrameFlag,
    Ground,
    GroundPose,
    RootCorrection,
    Sparse,
    Step,
    Trajectory,
)
from stridewire.motion import quaternion
from stridewire_engine.runtime import Runtime
from unit.runtime.conftest import DT, one, opening

Walk = Callable[..., Iterator[Frame]]
NAN = float("nan")


def test_one_bad_control_among_256_holds_that_character_alone(runtime: Runtime) -> None:
    """The bad row keeps its previous control and is flagged; all 255 others take the new one."""
    session = runtime.open(opening(256))
    for i in range(60):
        runtime.advance([(session, Step(i, DT, velocity_xz=np.tile([0.0, 1.2], (256, 1))))])
    velocity = np.tile([1.2, 0.0], (256, 1))
    velocity[100, 1] = NAN
    frame, fields = one(runtime, session, Step(61, DT, velocity_xz=velocity))
    assert fields == ["step.velocity_xz[201]"]
    assert frame.flagged(FrameFlag.HELD).tolist() == [110]
    velocity[100] = [np.inf, 0.0]
    for i in range(120):
        frame, _ = one(runtime, session, Step(62 + i, DT, velocity_xz=velocity))
    moved = frame.root[:, [0, 2]] - np.stack([3.0 * np.arange(256), np.zeros(256)], axis=1)
    assert moved[100, 1] > 1.5 * np.abs(moved[100, 0])
    assert np.all(np.delete(moved[:, 0], 100) > 0.5)


@pytest.mark.parametrize("dt", [NAN, -0.001, -np.inf])
def test_a_bad_dt_lets_no_time_pass(runtime: Runtime, walk: Walk, dt: float) -> None:
    """Negative or NaN: refused, told, all held, the same pose again, and the stream goes on."""
    session = runtime.open(opening(2))
    *_, before = walk(session, 0.5, (0.0, 1.0))
    frame, fields = one(runtime, session, Step(9, dt))
    assert fields == ["step.dt_s"]
    assert np.array_equal(frame.rotations, before.rotations)
    assert frame.flagged(FrameFlag.HELD).tolist() == [10, 11]
    frame, fields = one(runtime, session, Step(10, DT))
    assert not fields
    assert not frame.flags.any()


def test_a_long_dt_is_clamped_and_flagged(runtime: Runtime) -> None:
    """Up to 0.25 s a step is taken as it is, above it is cut and said so."""
    session = runtime.open(opening(1))
    frame, fields = one(runtime, session, Step(1, 0.25))
    assert (frame.time_s, fields) == (0.25, [])
    assert not frame.flags.any()
    frame, fields = one(runtime, session, Step(2, 7.0))
    assert (frame.time_s, fields) == (0.5, [])
    assert frame.flagged(FrameFlag.DT_CLAMPED).tolist() == [10]


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"velocity_xz": np.zeros((3, 2))}, "step.velocity_xz"),
        ({"velocity_xz": np.zeros(4)}, "step.velocity_xz"),
        ({"velocity_xz": [[0, 20.01], [0, 0]]}, "step.velocity_xz[1]"),
        ({"facing_yaw": np.zeros(3)}, "step.facing_yaw"),
        ({"facing_yaw": [0.0, np.inf]}, "step.facing_yaw[1]"),
        ({"characters": np.array([10, 99])}, "step.characters[1]"),
    ],
)
def test_bad_controls_are_told_by_path(runtime: Runtime, changes: dict, field: str) -> None:
    """Wrong lengths, values out of range and unknown ids never raise and name their field."""
    session = runtime.open(opening(2))
    _, fields = one(runtime, session, Step(1, DT, **changes))
    assert fields == [field]


def test_ids_choose_whom_a_control_is_for(runtime: Runtime) -> None:
    """Controls may name some characters in any order; the others hold theirs."""
    session = runtime.open(opening(3))
    one(runtime, session, Step(1, DT, velocity_xz=np.tile([0.0, 1.0], (3, 1))))
    ids = np.array([12, 10])
    one(runtime, session, Step(2, DT, characters=ids, velocity_xz=[[2.0, 0.0], [3.0, 0.0]]))
    wanted = session.crowd.state.desired_velocity[session.rows]
    assert wanted.tolist() == [[3.0, 0.0], [0.0, 1.0], [2.0, 0.0]]


def test_a_facing_turns_a_character_that_walks_elsewhere(runtime: Runtime) -> None:
    """Heading and direction of travel are independent; NaN means along the velocity."""
    session = runtime.open(opening(1))
    velocity = [[0.0, 0.8]]
    for i in range(240):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=velocity, facing_yaw=[1.2]))
    assert quaternion.to_yaw(frame.root[0, 3:]) > 0.5
    for i in range(240):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=velocity, facing_yaw=[NAN]))
    assert abs(quaternion.to_yaw(frame.root[0, 3:])) < 0.5


@pytest.mark.parametrize(
    ("sparse", "field"),
    [
        (Sparse(99), "step.sparse[0].character"),
        (Sparse(10, filter="wlk"), "step.sparse[0].filter"),
        (Sparse(10, filter="walk & idle"), "step.sparse[0].filter"),
        (Sparse(10, gait="hop"), "step.sparse[0].gait"),
        (Sparse(10, gait="walk", filter="walk"), "step.sparse[0].gait"),
        (Sparse(10, ground=Ground(np.inf)), "step.sparse[0].ground"),
        (Sparse(10, ground=Ground(normal=(0.0, 2.0, 0.0))), "step.sparse[0].ground.normal"),
        (Sparse(10, ground=Ground(normal=(1.0, 0.0, 0.0))), "step.sparse[0].ground.normal"),
        (Sparse(10, ground=Ground(foot_heights=np.zeros(3))), "step.sparse[0].ground.foot_heights"),
        (
            Sparse(10, ground=Ground(foot_normals=np.zeros((4, 3)))),
            "step.sparse[0].ground.foot_normals",
        ),
        (
            Sparse(10, root_correction=RootCorrection(GroundPose((NAN, 0, 0)))),
            "step.sparse[0].root_correction.root.position.x",
        ),
        (
            Sparse(10, root_correction=RootCorrection(GroundPose(yaw=np.inf))),
            "step.sparse[0].root_correction.root.yaw",
        ),
        (
            Sparse(10, Trajectory(np.zeros((0, 2)), np.zeros(0))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((33, 2)), np.linspace(0, 1, 33))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((2, 2)), np.array([1.0, 1.0]))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((2, 2)), np.array([0.0, 10.1]))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((3, 2)), np.array([0.0, 1.0]))),
            "step.sparse[0].trajectory.positions_xz",
        ),
        (
            Sparse(10, Trajectory(np.full((1, 2), NAN), np.zeros(1))),
            "step.sparse[0].trajectory.positions_xz",
        ),
        (
            Sparse(10, Trajectory(np.zeros((1, 2)), np.zeros(1), np.array([NAN]))),
            "step.sparse[0].trajectory.facings_yaw",
        ),
    ],
)
def test_bad_sparse_controls_are_told_by_path(runtime: Runtime, sparse: Sparse, field: str) -> None:
    """Whatever is wrong with one character's rarer controls is named; the stream goes on."""
    session = runtime.open(opening(2))
    frame, fields = one(runtime, session, Step(1, DT, sparse=[sparse]))
    assert fields == [field]
    assert frame.flagged(FrameFlag.HELD).tolist() == ([10] if sparse.character == 10 else [])


def test_a_trajectory_is_followed_until_the_next_velocity(runtime: Runtime) -> None:
    """A character walks a given path, stops at its end, and obeys velocities again afterwards."""
    session = runtime.open(opening(1))
    path = Trajectory(np.array([[0, 0], [0, 2], [2, 2.0]]), np.array([0.0, 2.0, 4.0]))
    one(runtime, session, Step(0, DT, sparse=[Sparse(10, trajectory=path)]))
    for i in range(420):
        frame, _ = one(runtime, session, Step(i, DT))
    assert np.linalg.norm(frame.root[0, [0, 2]] - [2.0, 2.0]) < 0.5
    for i in range(180):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=[[0.0, -1.4]]))
    assert frame.root[0, 2] < 1.0


def test_a_teleport_moves_at_once_and_starts_anew(runtime: Runtime, walk: Walk) -> None:
    """The root is there in the same frame, its delta is not a leap, the flag says so."""
    session = runtime.open(opening(2))
    list(walk(session, 1.0, (0.0, 1.4)))
    there = RootCorrection(GroundPose((50.0, 2.0, -20.0), 1.0), CorrectionMode.TELEPORT)
    frame, _ = one(runtime, session, Step(1, DT, sparse=[Sparse(11, root_correction=there)]))
    assert np.allclose(frame.root[1, :3], [50.0, 2.0, -20.0], atol=0.1)
    assert np.linalg.norm(frame.root_delta[1, :3]) < 0.1
    assert frame.flagged(FrameFlag.TELEPORTED).tolist() == [11]
    assert np.isfinite(frame.rotations).all()
    assert np.linalg.norm(frame.root[0, :3]) < 5.0


def test_an_adjustment_blends(runtime: Runtime, walk: Walk) -> None:
    """A corrected root goes there within half a second, no frame by more than a part of the way."""
    session = runtime.open(opening(1))
    *_, before = walk(session, 1.0, (0.0, 0.0))
    goal = (0.5, 0.0, 0.3)
    correction = RootCorrection(GroundPose(goal, 0.0), CorrectionMode.ADJUST)
    sparse = [Sparse(10, root_correction=correction)]
    positions = [before.root[0, :3]]
    frame, _ = one(runtime, session, Step(0, DT, sparse=sparse))
    positions.append(frame.root[0, :3])
    for i in range(60):
        frame, _ = one(runtime, session, Step(i, DT))
        positions.append(frame.root[0, :3])
        assert np.linalg.norm(frame.root_delta[0, :3]) < 0.02
    assert np.linalg.norm(positions[-1] - goal) < 0.06
    assert np.linalg.norm(np.diff(positions, axis=0), axis=1).max() < 0.1


def test_a_forced_search_searches_now(runtime: Runtime, walk: Walk) -> None:
    """`force_search` resets the character's clock, whatever its interval."""
    session = runtime.open(opening(2))
    list(walk(session, 0.5, (0.0, 1.0)))
    state = session.crowd.state
    state.until_search[session.rows] = 10.0
    one(runtime, session, Step(1, DT, sparse=[Sparse(10, force_search=True)]))
    assert state.until_search[session.rows[0]] < 1.0
    assert state.until_search[session.rows[1]] > 9.0
