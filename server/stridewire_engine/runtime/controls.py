"""Controls: what a step asks of a session's characters, written into their rows.

Whatever is wrong is left out, so that the previous control holds, and told.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from stridewire._errors import Violation
from stridewire._messages import (
    CorrectionMode,
    FrameFlag,
    Ground,
    Limits,
    RootCorrection,
    Sparse,
    Step,
    Trajectory,
)
from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.springs import wrap_angle
from stridewire_engine.matching.gaits import gait_filter
from stridewire_engine.runtime import admission
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.crowd import Crowd
from stridewire_engine.runtime.roster import Roster

_KEPT = (
    "desired_velocity",
    "desired_facing",
    "foot_lock",
    "stitcher",
    "filter",
    "weights",
    "stagger",
    "rate_divider",
    "has_ground",
    "ground_height",
    "ground_slope",
    "foot_heights",
    "foot_slopes",
    "ground_told_at",
)
"""What a character keeps when it is put somewhere else."""


def apply_step(roster: Roster, crowd: Crowd, step: Step, limits: Limits) -> Iterator[Violation]:
    """Apply a step's controls and yield what was wrong with them."""
    state = crowd.state
    places: Indices = np.arange(len(roster))
    if step.characters is not None and len(step.characters):
        places = roster.places(step.characters)
        for unknown in np.flatnonzero(places < 0):
            yield Violation(
                f"step.characters[{unknown}]", f"{step.characters[unknown]} is not in this session"
            )
    velocity, wrong = _shaped(roster, "step.velocity_xz", step.velocity_xz, (len(places), 2))
    yield from wrong
    facing, wrong = _shaped(roster, "step.facing_yaw", step.facing_yaw, (len(places),))
    yield from wrong
    good = places >= 0
    if velocity is not None:
        fine, complaints = admission.check_velocity(velocity, limits)
        yield from complaints
        good = _hold(roster, places, good, fine)
    if facing is not None:
        fine, complaints = admission.check_facing(facing)
        yield from complaints
        good = _hold(roster, places, good, fine)
    rows = roster.rows[places[good]]
    if velocity is not None:
        state.desired_velocity[rows] = velocity[good] / roster.scales[places[good], None]
        state.has_path[rows] = False
    if facing is not None:
        state.desired_facing[rows] = facing[good]
    for i, sparse in enumerate(step.sparse):
        yield from _apply_sparse(roster, crowd, f"step.sparse[{i}]", sparse)


def is_plain(step: Step, count: int) -> bool:
    """Tell whether a step says nothing but velocities and facings of all of `count` characters."""
    return (
        step.characters is None
        and not step.sparse
        and step.velocity_xz is not None
        and step.facing_yaw is not None
        and np.shape(step.velocity_xz) == (count, 2)
        and np.shape(step.facing_yaw) == (count,)
    )


def apply_plain(plain: Sequence[tuple[Roster, Step]], state: Characters, limits: Limits) -> bool:
    """Apply plain steps of many sessions at once; if any of them is wrong, none is applied."""
    velocity = np.concatenate([_given(step.velocity_xz) for _, step in plain])
    facing = np.concatenate([_given(step.facing_yaw) for _, step in plain])
    if not (np.abs(velocity) <= limits.max_speed).all() or np.isinf(facing).any():
        return False
    rows = np.concatenate([roster.rows for roster, _ in plain])
    scales = np.concatenate([roster.scales for roster, _ in plain])
    state.desired_velocity[rows] = velocity / scales[:, None]
    state.desired_facing[rows] = facing
    state.has_path[rows] = False
    return True


def _given(values: Floats | None) -> Floats:
    return np.asarray(values, np.float64)


def place(state: Characters, rows: Indices, positions: Floats, yaws: Floats) -> None:
    """Put characters somewhere, without a history: they begin there with their next tick.

    Args:
        state: Of the crowd.
        rows: `(M,)`.
        positions: `(M, 3)` world, metres of the reference skeleton's size.
        yaws: `(M,)` radians.
    """
    kept = {name: getattr(state, name)[rows] for name in _KEPT}
    state.put(rows, state.fresh(len(rows)))
    for name, values in kept.items():
        getattr(state, name)[rows] = values
    state.root_position[rows] = positions
    state.sim_position[rows] = positions[:, [0, 2]]
    for angles in (state.root_yaw, state.sim_yaw, state.goal_yaw):
        angles[rows] = yaws


def set_filter(crowd: Crowd, row: int, text: str) -> None:
    """Limit a character's choice by an expression that was checked; a change searches at once."""
    number = crowd.filter_number(text, "filter")
    if number != crowd.state.filter[row]:
        crowd.state.filter[row] = number
        crowd.state.force_search[row] = True


def follow(state: Characters, row: int, trajectory: Trajectory, scale: float = 1.0) -> None:
    """Give a character of a size a trajectory; the last point repeats to the end of its array."""
    positions = np.asarray(trajectory.positions_xz, np.float64) / scale
    count = len(positions)
    path = np.empty((count, 4))
    path[:, :2] = positions
    path[:, 2] = np.nan if trajectory.facings_yaw is None else trajectory.facings_yaw
    path[:, 3] = trajectory.times_s
    state.path[row, :count] = path
    state.path[row, count:] = path[-1]
    state.path_elapsed[row] = 0.0
    state.has_path[row] = True


def _shaped(
    roster: Roster, path: str, array: Floats | None, shape: tuple[int, ...]
) -> tuple[Floats | None, list[Violation]]:
    if array is None:
        return None, []
    array = np.asarray(array, np.float64)
    if array.shape == shape:
        return array, []
    roster.flag(slice(None), FrameFlag.HELD)
    expected = f"{array.size} values for {shape[0]} characters; expected {int(np.prod(shape))}"
    return None, [Violation(path, f"{expected}; the previous controls hold")]


def _hold(roster: Roster, places: Indices, good: Flags, fine: Flags) -> Flags:
    roster.flag(places[good & ~fine], FrameFlag.HELD)
    return good & fine


def _apply_sparse(roster: Roster, crowd: Crowd, path: str, sparse: Sparse) -> list[Violation]:
    at = roster.place(sparse.character)
    wrong = admission.check_sparse(path, sparse, crowd.matcher, known=at >= 0)
    if wrong:
        if at >= 0:
            roster.flag(at, FrameFlag.HELD)
        return wrong
    row, state, scale = int(roster.rows[at]), crowd.state, float(roster.scales[at])
    if sparse.filter is not None:
        set_filter(crowd, row, sparse.filter)
    if sparse.gait is not None:
        tags = crowd.library.tag_names
        set_filter(crowd, row, gait_filter(sparse.gait, path, tags))
    if sparse.trajectory is not None:
        follow(state, row, sparse.trajectory, scale)
    if sparse.ground is not None:
        _stand_on(state, row, sparse.ground, scale)
    if sparse.root_correction is not None:
        if sparse.root_correction.mode is CorrectionMode.TELEPORT:
            roster.flag(at, FrameFlag.TELEPORTED)
        _correct(state, row, sparse.root_correction, scale)
    if sparse.force_search:
        state.force_search[row] = True
    return []


def _stand_on(state: Characters, row: int, ground: Ground, scale: float) -> None:
    """Tell a character of a size about the ground under it."""
    state.has_ground[row] = True
    state.ground_height[row] = ground.height / scale
    state.ground_slope[row] = _slopes(np.array([ground.normal]))[0]
    state.ground_told_at[row, 0] = state.root_position[row, ::2]
    state.ground_told_at[row, 1:] = state.shown_world[row, :4, ::2]
    state.foot_heights[row] = np.nan
    if ground.foot_heights is not None:
        state.foot_heights[row] = np.asarray(ground.foot_heights, np.float64).ravel() / scale
    state.foot_slopes[row] = np.nan
    if ground.foot_normals is not None:
        normals = np.asarray(ground.foot_normals, np.float64).reshape(2, 2, 3).sum(axis=1)
        state.foot_slopes[row] = _slopes(normals)


def _slopes(normals: Floats) -> Floats:
    """Return by how much planes of normals `(K, 3)` rise along x and z, `(K, 2)`."""
    return np.asarray(-normals[:, ::2] / normals[:, 1:2])


def _correct(state: Characters, row: int, correction: RootCorrection, scale: float) -> None:
    root = correction.root
    # in float32, as places come over the wire: in process the same frames
    position = np.asarray(root.position, np.float32).astype(np.float64) / scale
    yaw = float(np.float32(root.yaw))
    if correction.mode is CorrectionMode.TELEPORT:
        place(state, np.array([row]), position[None], np.array([yaw]))
    else:
        state.correction[row, :3] = position - state.root_position[row]
        state.correction[row, 3] = wrap_angle(np.asarray(yaw - state.root_yaw[row]))
