"""Paths: a root path that the caller imposes, whatever the clips do."""

from dataclasses import replace

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from stridewire._messages import RootPath
from stridewire.motion.array_types import Floats
from stridewire_engine.stitching.plan import Plan

_STANDING = 0.05
"""Slower than this, in m/s, a path has no direction of its own."""


def impose(plan: Plan, path: RootPath) -> Plan:
    """Return the plan under another root path; heights stay.

    Between its points the path goes along modified Akima cubics, which hardly overshoot.

    Args:
        plan: Of clips.
        path: From 0 to the end of the plan at least.
    """
    at = np.asarray(path.times_s, np.float64)
    times = np.minimum(np.arange(len(plan)) / plan.frame_rate, at[-1])
    along = Akima1DInterpolator(at, np.asarray(path.positions_xz, np.float64), method="makima")
    position = plan.root_position.copy()
    position[:, ::2] = along(times)
    if path.facings_yaw is None:
        yaw = _headings(along.derivative()(times))
    else:
        facings = np.unwrap(np.asarray(path.facings_yaw, np.float64))
        yaw = Akima1DInterpolator(at, facings, method="makima")(times)
    return replace(plan, root_position=position, root_yaw=yaw, imposed=True)


def _headings(velocity: Floats) -> Floats:
    """Return where velocities `(T, 2)` point; where there is none, as before, else as after."""
    moves = np.hypot(velocity[:, 0], velocity[:, 1]) > _STANDING
    if not moves.any():
        return np.zeros(len(velocity))
    frames = np.arange(len(velocity))
    last = np.maximum.accumulate(np.where(moves, frames, -1))
    source = np.where(last >= 0, last, int(np.argmax(moves)))
    yaw = np.arctan2(velocity[:, 0], velocity[:, 1])
    return np.asarray(np.unwrap(yaw[source]))
