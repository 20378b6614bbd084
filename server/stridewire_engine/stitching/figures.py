"""Figures of a stitched motion, before and after: sliding, jerk, steps in the toes' velocity.

Definitions are those of `stridewire evaluate`; a figure is 0 where no frame counts.
"""

from typing import NamedTuple

import numpy as np

from stridewire._messages import MotionFigures
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire_engine.stitchers import Roots
from stridewire_engine.stitchers.legs import leg_pose
from stridewire_engine.stitching.plan import Plan

_NEAR_GROUND = 0.02
_CHUNK = 20_000


class LegPaths(NamedTuple):
    """Where knees and toes are in the world; `(T, 2, 3)`."""

    knees: Vectors
    toes: Vectors


def leg_paths(plan: Plan, hips: Vectors, rotations: Quaternions) -> LegPaths:
    """Return knees and toes of poses under the plan's root."""
    paths = LegPaths(np.empty((len(plan), 2, 3)), np.empty((len(plan), 2, 3)))
    for start in range(0, len(plan), _CHUNK):
        part = slice(start, start + _CHUNK)
        pose = leg_pose(plan.legs, hips[part], rotations[part])
        roots = Roots(plan.root_position[part], plan.root_yaw[part])
        paths.knees[part] = roots.to_world(pose.knee)
        paths.toes[part] = roots.to_world(pose.toe)
    return paths


def figures(plan: Plan, paths: LegPaths, counted: Flags) -> MotionFigures:
    """Return the figures over the frames `(T,)` that are counted."""
    rate = plan.frame_rate
    way = np.diff(paths.toes[..., [0, 2]], axis=0, prepend=np.nan)
    speed = 100.0 * rate * np.sqrt(np.sum(way**2, axis=-1))
    steady = plan.contacts.copy()
    steady[1:] &= plan.contacts[:-1]
    ground = plan.root_position[:, None, 1] + plan.legs.toe_height
    near = paths.toes[..., 1] < ground + _NEAR_GROUND
    return MotionFigures(
        _mean(speed, steady & counted[:, None]),
        _mean(speed, near & counted[:, None]),
        _jerk(paths.toes, rate, counted),
        _jerk(paths.knees, rate, counted),
        _seam_step(plan, paths.toes, counted),
    )


def _mean(values: Floats, counted: Flags) -> float:
    chosen = values[counted & np.isfinite(values)]
    return float(chosen.mean()) if chosen.size else 0.0


def _jerk(points: Vectors, rate: float, counted: Flags) -> float:
    third = np.sqrt(np.sum(np.diff(points, n=3, axis=0) ** 2, axis=-1)) * rate**3
    return _mean(third, np.broadcast_to(counted[3:, None], third.shape))


def _seam_step(plan: Plan, toes: Vectors, counted: Flags) -> float:
    seams = plan.seams[counted[plan.seams]]
    if not len(seams):
        return 0.0
    step = 100.0 * plan.frame_rate * np.sqrt(np.sum(np.diff(toes, n=2, axis=0) ** 2, axis=-1))
    # a step ends at frame 2, 3, …; a seam shows in that of its frame and in the next
    pair = np.stack([step[seams - 2], step[np.minimum(seams - 1, len(step) - 1)]])
    return float(pair.max(axis=(0, 2)).mean())
