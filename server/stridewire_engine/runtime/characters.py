"""The state of all characters: one row a character, plain arrays, no objects a character."""

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors

MAX_TRAJECTORY_POINTS = 32
"""Most points of a trajectory that a caller gives."""


SHOWN_JOINTS = ("LeftFoot", "RightFoot", "LeftToe", "RightToe", "Hips")
"""Joints whose shown place is remembered for the next query."""
RECENT_CHOICES = 4
"""So many choices of a character are remembered."""


def _column(*shape: int | str, dtype: type = np.float32, fill: float = 0.0) -> Any:
    """Describe an array `(N, *shape)`; J stands for joints, C for channels."""
    return field(metadata={"shape": shape, "dtype": dtype, "fill": fill})


@dataclass
class Characters:
    """Arrays of N rows. World positions, angles and times are float64, since they are long sums."""

    # what the caller wants
    desired_velocity: Floats = _column(2, dtype=np.float64)
    """x and z in the world, m/s."""
    desired_facing: Floats = _column(dtype=np.float64, fill=np.nan)
    """World yaw, radians; NaN means along the velocity."""
    path: Floats = _column(MAX_TRAJECTORY_POINTS, 4, dtype=np.float64)
    """Given trajectory: x, z, yaw, time from when it was given; the last point repeats to the
    end."""
    has_path: Flags = _column(dtype=np.bool_)
    path_elapsed: Floats = _column(dtype=np.float64)
    """Seconds since the trajectory was given."""
    correction: Floats = _column(4, dtype=np.float64)
    """Root correction still to be blended in: x, y, z, yaw."""
    foot_lock: Flags = _column(dtype=np.bool_, fill=1)
    stitcher: Indices = _column(dtype=np.int8)
    """Index into `STITCHERS`."""
    filter: Indices = _column(dtype=np.int32)
    """Number of the candidate set in the crowd's table; 0 is all."""
    weights: Floats = _column("C", dtype=np.float64)
    """Of the schema's channels."""

    # the simulated root
    sim_position: Floats = _column(2, dtype=np.float64)
    """x and z."""
    sim_velocity: Floats = _column(2, dtype=np.float64)
    sim_acceleration: Floats = _column(2, dtype=np.float64)
    sim_yaw: Floats = _column(dtype=np.float64)
    sim_yaw_velocity: Floats = _column(dtype=np.float64)
    goal_yaw: Floats = _column(dtype=np.float64)
    """Where the simulated root turns to."""

    # the character root
    root_position: Vectors = _column(3, dtype=np.float64)
    root_yaw: Floats = _column(dtype=np.float64)
    root_offset: Floats = _column(3)
    """What is left of the root velocity before the last jump: x, z in the root's frame, yaw
    rate."""

    # playback and search
    clip: Indices = _column(dtype=np.int32, fill=-1)
    """Index of the clip; -1 before the first search."""
    clip_time: Floats = _column(dtype=np.float64)
    """Seconds within the clip."""
    since_jump: Floats = _column(dtype=np.float64)
    until_search: Floats = _column(dtype=np.float64, fill=1.0)
    stagger: Floats = _column(dtype=np.float64)
    """From 0 to 1: spreads the searches of characters that were forced to search together."""
    searched_velocity: Floats = _column(2, dtype=np.float64)
    """Desired velocity at the last search."""
    searched_yaw: Floats = _column(dtype=np.float64)
    """Goal yaw at the last search."""
    force_search: Flags = _column(dtype=np.bool_)
    recent: Indices = _column(RECENT_CHOICES, dtype=np.int64, fill=-1)
    """Rows chosen last, the newest first."""
    recent_time: Floats = _column(RECENT_CHOICES, dtype=np.float64)
    """`time` at which they were chosen."""
    root_speed: Floats = _column(dtype=np.float64)
    """Speed of the root in the last tick, m/s."""

    # the stitcher; see `StitchState`
    offset_hips: Vectors = _column(3)
    offset_hips_velocity: Vectors = _column(3)
    offset_rotations: Vectors = _column("J", 3)
    offset_angular_velocity: Vectors = _column("J", 3)
    stitch_time: Floats = _column()
    stitch_deficit: Floats = _column()
    curve_value: Floats = _column("1 + J")
    curve_speed: Floats = _column("1 + J")
    curve_end: Floats = _column("1 + J")
    curve_axis: Vectors = _column("1 + J", 3)
    dead_hips: Vectors = _column(3)
    dead_rotations: Quaternions = _column("J", 4)
    dead_velocity: Vectors = _column("1 + J", 3)
    dead_halflife: Vectors = _column("1 + J", 3)
    body_halflife: Floats = _column("1 + J")
    toe_shown: Vectors = _column(2, 3, dtype=np.float64)
    toe_speed: Vectors = _column(2, 3)
    toe_gap: Vectors = _column(2, 3)
    toe_gap_speed: Vectors = _column(2, 3)
    toe_swing: Floats = _column(2)
    toe_lift: Floats = _column(2)
    toe_lift_speed: Floats = _column(2)
    hip_drop: Floats = _column()
    hip_drop_speed: Floats = _column()
    legs_shown: Quaternions = _column(6, 4)
    stitched_by: Indices = _column(dtype=np.int8)
    """Index of the stitcher that hides the last transition; a change counts from the next."""

    # the feet: left and right
    planted: Flags = _column(2, dtype=np.bool_)
    """The clip's contact in the last frame."""
    locked: Flags = _column(2, dtype=np.bool_)
    lock_point: Vectors = _column(2, 3, dtype=np.float64)
    """World position of a locked toe."""
    toe: Vectors = _column(2, 3, dtype=np.float64)
    """World position of the toes before locking, in the last frame."""
    toe_offset: Vectors = _column(2, 3)
    toe_offset_velocity: Vectors = _column(2, 3)

    # what was shown last
    shown_world: Vectors = _column(len(SHOWN_JOINTS), 3, dtype=np.float64)
    """`SHOWN_JOINTS` in the world."""
    shown_local: Vectors = _column(len(SHOWN_JOINTS), 3)
    """The same in the root's frame."""
    shown_velocity: Vectors = _column(len(SHOWN_JOINTS), 3)
    """Their world velocity in the root's frame."""
    tag_bits: Indices = _column(dtype=np.uint64)
    contacts: Flags = _column(4, dtype=np.bool_)
    time: Floats = _column(dtype=np.float64)
    """Seconds since the character was added."""

    @classmethod
    def allocate(cls, rows: int, joints: int, channels: int) -> "Characters":
        """Return fresh rows."""
        sizes = {"J": joints, "1 + J": 1 + joints, "C": channels}
        arrays = {}
        for column in fields(cls):
            shape = [sizes.get(n, n) for n in column.metadata["shape"]]
            arrays[column.name] = np.full(
                (rows, *shape), column.metadata["fill"], column.metadata["dtype"]
            )
        return cls(**arrays)

    def __len__(self) -> int:
        return len(self.clip)

    def fresh(self, rows: int) -> "Characters":
        """Return fresh rows of the same shapes."""
        return self.allocate(rows, self.offset_rotations.shape[1], self.weights.shape[1])

    def take(self, rows: slice | Indices) -> "Characters":
        """Return some rows: views for a slice, copies for indices."""
        return Characters(**{name: array[rows] for name, array in vars(self).items()})

    def put(self, rows: slice | Indices, part: "Characters") -> None:
        """Write rows back."""
        for name, array in vars(self).items():
            array[rows] = getattr(part, name)

    def append(self, more: "Characters") -> "Characters":
        """Return these rows and then others."""
        return Characters(
            **{
                name: np.concatenate([array, getattr(more, name)])
                for name, array in vars(self).items()
            }
        )


def contiguous(rows: Indices) -> slice | Indices:
    """Return a slice for consecutive rows, so that no copy is made; else the rows."""
    if len(rows) and rows[-1] - rows[0] + 1 == len(rows) and np.all(np.diff(rows) == 1):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows
