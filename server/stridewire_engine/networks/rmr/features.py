"""Features: what the network reads of each frame of a plan.

Everything is told in the plan's frame: under the root, and looking where it looks, in the frame
before the first seam.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire_engine.networks.rmr.plans import Plans

INPUTS = 43
"""Numbers a frame."""
_STEP_SCALE = 30.0
_FOOT_SCALE = 5.0
_FADE = 10.0
_LONG = 60.0


class PlanFrame(NamedTuple):
    """Frames of N plans in the world."""

    origin: Vectors
    """`(N, 3)` on the ground."""
    yaw: Floats
    """`(N,)`."""

    @classmethod
    def of(cls, plans: Plans) -> "PlanFrame":
        """Return the frames of plans."""
        rows, before = np.arange(len(plans)), plans.first_seam - 1
        return cls(plans.root[rows, before] * np.array([1.0, 0.0, 1.0]), plans.yaw[rows, before])

    def enter(self, points: Vectors) -> Vectors:
        """Take points `(N, ..., 3)` of the world into the frames."""
        shape = (-1, *(1,) * (points.ndim - 2), 3)
        return turn_to_root(points - self.origin.reshape(shape), self.yaw)

    def leave(self, vectors: Vectors) -> Vectors:
        """Turn vectors `(N, ..., 3)` of the frames into the world."""
        return turn_to_world(vectors, self.yaw)


def inputs(plans: Plans) -> Floats:
    """Return the features `(N, T, 43)`, float32."""
    frame = PlanFrame.of(plans)
    root = frame.enter(plans.root)
    toes, clip = frame.enter(plans.toes), frame.enter(plans.clip_toes)
    ankles = frame.enter(plans.ankles)
    forward = plans.yaw - frame.yaw[:, None]
    under = root * np.array([1.0, 0.0, 1.0])
    since = plans.since_last
    fresh = since >= 0
    parts = [
        root[..., [0, 2]],
        np.stack([np.sin(forward), np.cos(forward)], axis=-1),
        frame.enter(plans.hips) - under,
        _flat(toes - under[:, :, None]),
        _flat(clip - under[:, :, None]),
        _STEP_SCALE * _flat(steps(toes)),
        _STEP_SCALE * _flat(steps(clip)),
        _FOOT_SCALE * _flat(ankles - toes),
        plans.contacts,
        np.stack(
            [
                np.where(fresh, np.exp(-np.maximum(since, 0) / _FADE), 0.0),
                np.where(fresh, since / _LONG, 0.0),
                ~fresh,
                np.broadcast_to(plans.imposed[:, None], since.shape),
            ],
            axis=-1,
        ),
    ]
    return np.concatenate(parts, axis=-1).astype(np.float32)


def steps(points: Vectors) -> Vectors:
    """Return the way since the frame before `(N, T, ...)`; the first frame repeats the second's."""
    way = np.diff(points, axis=1)
    return np.concatenate([way[:, :1], way], axis=1)


def _flat(feet: Floats) -> Floats:
    return feet.reshape(*feet.shape[:2], -1)
