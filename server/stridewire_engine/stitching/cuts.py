"""Cuts: better seams near the ends of clips, found by how alike the poses and their motion are."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.clip import Clip
from stridewire_engine.stitching.alignment import root_steps

SHORTEST = 10
"""A clip is never left fewer frames."""
_VELOCITY_S = 0.05
"""A difference of 1 m/s counts like one of so many metres."""


class Cut(NamedTuple):
    """Frames that are left out at a seam."""

    before: int
    """At the end of the clip before."""
    after: int
    """At the start of the clip that follows."""


class _Edge(NamedTuple):
    """What is compared, of K frames near an end of a clip."""

    joints: Vectors
    """`(K, J, 3)` under the root."""
    velocity: Vectors
    """`(K, J, 3)` m/s, the root's included, as seen from it."""


def best_cuts(clips: Sequence[Clip], reach: int) -> list[Cut]:
    """Return for each seam the cut of at most `reach` frames on either side that costs least."""
    cuts = []
    for before, after in pairwise(clips):
        # both ends of a clip may be cut
        left = min(reach, (len(before) - SHORTEST) // 2)
        right = min(reach, (len(after) - SHORTEST) // 2)
        tail = _edge(before.cut(len(before) - left - 2, len(before)), slice(1, None))
        head = _edge(after.cut(0, right + 2), slice(None, -1))
        cost = _cost(tail, head)
        ends, starts = np.unravel_index(int(np.argmin(cost)), cost.shape)
        cuts.append(Cut(left - int(ends), int(starts)))
    return cuts


def cut_clips(clips: Sequence[Clip], cuts: Sequence[Cut]) -> list[Clip]:
    """Return the clips without what the cuts leave out."""
    starts = [0, *(cut.after for cut in cuts)]
    ends = [*(cut.before for cut in cuts), 0]
    return [
        clip.cut(start, len(clip) - end)
        for clip, start, end in zip(clips, starts, ends, strict=True)
    ]


def _cost(tail: _Edge, head: _Edge) -> Floats:
    """Return `(K, L)` squared metres by which frames differ, mean over the joints."""
    way = tail.joints[:, None] - head.joints
    rate = (tail.velocity[:, None] - head.velocity) * _VELOCITY_S
    return np.asarray(np.sum(way**2 + rate**2, axis=-1).mean(axis=-1))


def _edge(clip: Clip, frames: slice) -> _Edge:
    """See frames of an end of a clip, all but the outermost on the other side."""
    pose = clip.pose
    joints, _ = kinematics.forward(clip.skeleton, pose.hips, pose.rotations)
    yaw = np.unwrap(quaternion.to_yaw(pose.root_rotation.astype(np.float64)))
    steps = root_steps(pose.root_position.astype(np.float64), yaw)
    joints = joints.astype(np.float64)
    moved = np.diff(joints, axis=0)
    turn = steps[:, None, 2]
    moved[..., 0] += steps[:, None, 0] + turn * joints[1:, :, 2]
    moved[..., 2] += steps[:, None, 1] - turn * joints[1:, :, 0]
    return _Edge(joints[frames], moved * clip.frame_rate)
