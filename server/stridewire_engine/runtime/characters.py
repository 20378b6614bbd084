"""The state of all characters: one row a character, plain arrays, no objects a character."""

from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.runtime.response import NEUTRAL
from stridewire_engine.stitchers.columns import Columns, allocate, column

MAX_TRAJECTORY_POINTS = 32
"""Most points of a trajectory that a caller gives."""


SHOWN_JOINTS = ("LeftFoot", "RightFoot", "LeftToe", "RightToe", "Hips")
"""Joints whose shown place is remembered for the next query."""
RECENT_CHOICES = 4
"""So many choices of a character are remembered."""
PAST_FRAMES, GUIDED_FRAMES = 8, 52
"""Frames before and after a transition that a network is told of."""


@dataclass
class Characters(Columns):
    """Arrays of N rows. World positions, angles and times are float64, since they are long sums."""

    # what the caller wants
    desired_velocity: Floats = column(2, dtype=np.float64)
    """x and z in the world, m/s."""
    desired_facing: Floats = column(dtype=np.float64, fill=np.nan)
    """World yaw, radians; NaN means along the velocity."""
    path: Floats = column(MAX_TRAJECTORY_POINTS, 4, dtype=np.float64)
    """Given trajectory: x, z, yaw, time from when it was given; the last point repeats to the
    end."""
    has_path: Flags = column(dtype=np.bool_)
    path_elapsed: Floats = column(dtype=np.float64)
    """Seconds since the trajectory was given."""
    correction: Floats = column(4, dtype=np.float64)
    """Root correction still to be blended in: x, y, z, yaw."""
    foot_lock: Flags = column(dtype=np.bool_, fill=1)
    stitcher: Indices = column(dtype=np.int8)
    """Index into `STITCHERS`."""
    filter: Indices = column(dtype=np.int32)
    """Number of the candidate set in the crowd's table; 0 is all."""
    weights: Floats = column("C", dtype=np.float64)
    """Of the schema's channels."""
    responsiveness: Floats = column(dtype=np.float64, fill=NEUTRAL)
    """From 0, quality, to 1, response."""

    # the simulated root
    sim_position: Floats = column(2, dtype=np.float64)
    """x and z."""
    sim_velocity: Floats = column(2, dtype=np.float64)
    sim_acceleration: Floats = column(2, dtype=np.float64)
    sim_yaw: Floats = column(dtype=np.float64)
    sim_yaw_velocity: Floats = column(dtype=np.float64)
    goal_yaw: Floats = column(dtype=np.float64)
    """Where the simulated root turns to."""

    # the character root
    root_position: Vectors = column(3, dtype=np.float64)
    root_yaw: Floats = column(dtype=np.float64)
    root_offset: Floats = column(3)
    """What is left of the root velocity before the last jump: x, z in the root's frame, yaw
    rate."""

    # the ground
    has_ground: Flags = column(dtype=np.bool_)
    """Whether the caller told of it; else it is level, at the root's height."""
    ground_height: Floats = column(dtype=np.float64)
    """Under the root, in the world, metres."""
    ground_slope: Floats = column(2, dtype=np.float64)
    """By how much it rises along x and z in the world, metres a metre."""
    foot_heights: Floats = column(4, dtype=np.float64, fill=np.nan)
    """Under left foot, left toe, right foot, right toe; NaN for the plane under the root."""
    foot_slopes: Floats = column(2, 2, dtype=np.float64, fill=np.nan)
    """Under the left and the right foot; NaN for that under the root."""
    ground_told_at: Floats = column(5, 2, dtype=np.float64)
    """x and z of root, left and right foot, left and right toe when it was told of."""
    ground_points: Floats = column(3, 2, dtype=np.float64)
    """x and z of root, left and right toe in the last frame."""
    on_ground: Flags = column(dtype=np.bool_)
    """Whether the ground has been shown."""
    terrain: Floats = column(7, dtype=np.float64)
    """What is shown of it: root and feet above the floor, slopes under both feet."""
    terrain_speed: Floats = column(7, dtype=np.float64)
    ground_sink: Floats = column(dtype=np.float64)
    """Metres that the hips are lowered by for its sake."""
    ground_sink_speed: Floats = column(dtype=np.float64)

    # playback and search
    clip: Indices = column(dtype=np.int32, fill=-1)
    """Index of the clip; -1 before the first search."""
    clip_time: Floats = column(dtype=np.float64)
    """Seconds within the clip."""
    pace: Floats = column(dtype=np.float64, fill=1.0)
    """Seconds of the clip for each second that passes; -1 where a standing character goes back."""
    goes_back: Flags = column(dtype=np.bool_)
    since_jump: Floats = column(dtype=np.float64)
    until_search: Floats = column(dtype=np.float64, fill=1.0)
    stagger: Floats = column(dtype=np.float64)
    """From 0 to 1: spreads the searches of characters that were forced to search together."""
    searched_velocity: Floats = column(2, dtype=np.float64)
    """Desired velocity at the last search."""
    searched_yaw: Floats = column(dtype=np.float64)
    """Goal yaw at the last search."""
    force_search: Flags = column(dtype=np.bool_)
    recent: Indices = column(RECENT_CHOICES, dtype=np.int64, fill=-1)
    """Rows chosen last, the newest first."""
    recent_time: Floats = column(RECENT_CHOICES, dtype=np.float64)
    """`time` at which they were chosen."""
    root_speed: Floats = column(dtype=np.float64)
    """Speed of the root in the last tick, m/s."""

    # the stitcher; see `StitchState`
    offset_hips: Vectors = column(3)
    offset_hips_velocity: Vectors = column(3)
    offset_rotations: Vectors = column("J", 3)
    offset_angular_velocity: Vectors = column("J", 3)
    stitch_time: Floats = column()
    stitch_deficit: Floats = column()
    curve_value: Floats = column("1 + J")
    curve_speed: Floats = column("1 + J")
    curve_end: Floats = column("1 + J")
    curve_axis: Vectors = column("1 + J", 3)
    dead_hips: Vectors = column(3)
    dead_rotations: Quaternions = column("J", 4)
    dead_velocity: Vectors = column("1 + J", 3)
    dead_halflife: Vectors = column("1 + J", 3)
    body_halflife: Floats = column("1 + J")
    toe_shown: Vectors = column(2, 3, dtype=np.float64)
    toe_speed: Vectors = column(2, 3)
    toe_gap: Vectors = column(2, 3)
    toe_gap_speed: Vectors = column(2, 3)
    toe_swing: Floats = column(2)
    toe_lift: Floats = column(2)
    toe_lift_speed: Floats = column(2)
    toe_step: Floats = column(2)
    hip_drop: Floats = column()
    hip_drop_speed: Floats = column()
    legs_shown: Quaternions = column(6, 4)
    stitched_by: Indices = column(dtype=np.int8)
    """Index of the stitcher that hides the last transition; a change counts from the next."""

    # the network that guides feet; see `refining`
    past_root: Floats = column(PAST_FRAMES, 4, dtype=np.float64)
    """x, y, z, yaw in the last frames, the newest last."""
    past_shown: Vectors = column(PAST_FRAMES, len(SHOWN_JOINTS), 3, dtype=np.float64)
    """`SHOWN_JOINTS` in the world in the last frames."""
    past_contacts: Flags = column(PAST_FRAMES, 2, dtype=np.bool_)
    past_frames: Indices = column(dtype=np.int8)
    """How many of them follow each other evenly."""
    past_uneven: Flags = column(dtype=np.bool_)
    """The frame before those was not a sixtieth of a second long."""
    guide_frames: Indices = column(dtype=np.int8)
    """For how many frames after the last transition there is a guide."""
    guide_planted: Floats = column(GUIDED_FRAMES, 2)
    guide_offset: Vectors = column(GUIDED_FRAMES, 2, 3)
    """In the world."""
    fallback: Indices = column(dtype=np.int8)
    """Why there is no guide: a `FallbackReason`, or 0."""
    refined_frames: Indices = column(dtype=np.int8)
    """For how many frames there was a guide after the transition before the last."""

    # the feet: left and right
    planted: Flags = column(2, dtype=np.bool_)
    """The clip's contact in the last frame."""
    locked: Flags = column(2, dtype=np.bool_)
    lock_point: Vectors = column(2, 3, dtype=np.float64)
    """World position of a locked toe."""
    toe: Vectors = column(2, 3, dtype=np.float64)
    """World position of the toes before locking, in the last frame."""
    toe_offset: Vectors = column(2, 3)
    toe_offset_velocity: Vectors = column(2, 3)

    # what was shown last
    shown_world: Vectors = column(len(SHOWN_JOINTS), 3, dtype=np.float64)
    """`SHOWN_JOINTS` in the world."""
    shown_local: Vectors = column(len(SHOWN_JOINTS), 3)
    """The same in the root's frame."""
    shown_velocity: Vectors = column(len(SHOWN_JOINTS), 3)
    """Their world velocity in the root's frame."""
    tag_bits: Indices = column(dtype=np.uint64)
    contacts: Flags = column(4, dtype=np.bool_)
    time: Floats = column(dtype=np.float64)
    """Seconds since the character was added."""

    # those who are far away; see `holding`
    rate_divider: Indices = column(dtype=np.int8)
    """Stepped every so many ticks; 0 means every tick, too."""
    ticks_left: Indices = column(dtype=np.int8)
    """Until the next step."""
    owed: Floats = column(dtype=np.float64)
    """Seconds since the last step."""
    held_root: Floats = column(7)
    """Shown last, as are the others, in float32."""
    held_hips: Vectors = column(3)
    held_rotations: Quaternions = column("J", 4)
    held_foot_targets: Vectors = column(2, 3)
    held_simulated_root: Floats = column(4)
    held_fallback: Indices = column(dtype=np.int8)

    @classmethod
    def allocate(cls, rows: int, joints: int, channels: int) -> "Characters":
        """Return fresh rows."""
        sizes = {"J": joints, "1 + J": 1 + joints, "C": channels}
        return cls(**allocate(cls, rows, sizes))

    def __len__(self) -> int:
        return len(self.clip)

    def fresh(self, rows: int) -> "Characters":
        """Return fresh rows of the same shapes."""
        return self.allocate(rows, self.offset_rotations.shape[1], self.weights.shape[1])

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
