"""The captured motion: figures of every frame of a library, to be read off wherever it is played.

So the captured row of a table is what the very frames that were streamed measure in their own
clips, and a stream of sprints is not compared with captured standing.
"""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from stridewire.motion import kinematics
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.evaluation import metrics
from stridewire_engine.library import Library

TOES = ("LeftToe", "RightToe")
KNEES = ("LeftLeg", "RightLeg")
_LEGS = (("LeftUpLeg", "RightUpLeg"), KNEES, ("LeftFoot", "RightFoot"))
_STEP_PERCENT = 99.9


@dataclass(frozen=True)
class Measured:
    """What every frame measures; leading shape `(T, S)` for streams, `(F,)` for libraries."""

    toe_speed: Floats
    """`(…, 2)` over the ground, m/s."""
    toe_height: Floats
    """`(…, 2)` above the floor, metres."""
    planted: Flags
    """`(…, 2)` the clip's labels."""
    jerk: Floats
    """`(…)` mean over joints, m/s³."""
    toe_jerk: Floats
    """`(…, 2)`."""
    knee_jerk: Floats
    """`(…, 2)`."""
    step: Floats
    """`(…, J)` change of velocity, m/s."""
    extension: Floats
    """`(…, 2)` of the legs."""

    def __getitem__(self, index: Indices) -> "Measured":
        """Read frames off."""
        return Measured(*(getattr(self, f.name)[index] for f in fields(self)))


def measure(
    skeleton: Skeleton, positions: Vectors, planted: Flags, floor: float, rate: float
) -> Measured:
    """Measure joints in the world.

    Args:
        skeleton: The reference.
        positions: `(T, S, J, 3)`.
        planted: `(T, S, 2)` labels of the toes.
        floor: Height that toes have when they stand, metres.
        rate: Frames per second.
    """
    toes = positions[..., skeleton.indices(TOES), :]
    third = metrics.jerk(positions, rate)
    return Measured(
        metrics.planar_speed(toes, rate),
        toes[..., 1] - floor,
        planted,
        third.mean(axis=-1),
        third[..., skeleton.indices(TOES)],
        third[..., skeleton.indices(KNEES)],
        metrics.velocity_step(positions, rate),
        metrics.extension(*(positions[..., skeleton.indices(joints), :] for joints in _LEGS)),
    )


class Captured:
    """Positions and figures of a library's frames."""

    def __init__(self, library: Library) -> None:
        """Measure all clips."""
        self.library = library
        toes = library.skeleton.indices(TOES)
        planted = library.contacts[:, 1::2]
        parts = [_world(library, entry.start, entry.frames) for entry in library.clips]
        self.positions: Vectors = np.concatenate(parts).astype(np.float32)
        """`(F, J, 3)` in each clip's own space."""
        standing = self.positions[:, toes, 1][planted]
        self.floor = float(np.percentile(standing, 5.0)) if len(standing) else 0.0
        """Height of standing toes: 5th percentile of all planted ones, metres."""
        measured = []
        for entry, part in zip(library.clips, parts, strict=True):
            rows = slice(entry.start, entry.start + entry.frames)
            one = measure(
                library.skeleton, part[:, None], planted[rows, None], self.floor, library.frame_rate
            )
            measured.append(Measured(*(getattr(one, f.name)[:, 0] for f in fields(one))))
        self.frames = Measured(
            *(np.concatenate([getattr(m, f.name) for m in measured]) for f in fields(Measured))
        )
        self.step_limits: Floats = np.nanpercentile(self.frames.step, _STEP_PERCENT, axis=0)
        """`(J,)` changes of velocity that captured joints hardly ever exceed, m/s."""

    @cached_property
    def toes_under_root(self) -> Vectors:
        """The toes `(F, 2, 3)` in the root's frame."""
        library = self.library
        toes = self.positions[:, library.skeleton.indices(TOES)] - library.root_position[:, None]
        sine, cosine = np.sin(library.root_yaw)[:, None], np.cos(library.root_yaw)[:, None]
        x, y, z = np.moveaxis(toes, -1, 0)
        return np.stack([x * cosine - z * sine, y, x * sine + z * cosine], axis=-1)


def _world(library: Library, start: int, count: int) -> Vectors:
    rows = slice(start, start + count)
    yaw = library.root_yaw[rows].astype(np.float64)
    turn = np.stack([np.cos(yaw / 2), 0 * yaw, np.sin(yaw / 2), 0 * yaw], axis=-1)
    pose = Pose(library.root_position[rows], turn, library.hips[rows], library.rotations[rows])
    return kinematics.forward_world(library.skeleton, pose.astype(np.float64))[0]
