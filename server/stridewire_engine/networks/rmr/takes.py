"""Takes: the frames of captured clips and their mirrored copies, one after another."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.clip import Clip
from stridewire.motion.mirror import mirror_clip
from stridewire.motion.root_frame import turn_to_root
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE, Skeleton
from stridewire_engine.networks.rmr.plans import FRAME_RATE, WINDOW

_OTHER_GAITS = {
    "aloft", "low", "jump", "climb", "sit", "fight", "dance", "sport", "crouch", "fall", "push",
    "obstacles",
}  # fmt: skip
_MOVING = 0.2
_SHORTEST = WINDOW + 4
TOES = REFERENCE.indices(CONTACT_JOINTS)[[1, 3]]
ANKLES = REFERENCE.indices(CONTACT_JOINTS)[[0, 2]]
HIP_JOINTS = REFERENCE.indices(("LeftUpLeg", "RightUpLeg"))
_LOWER = 9
LOWER = Skeleton(REFERENCE.names[:_LOWER], REFERENCE.parents[:_LOWER], REFERENCE.offsets[:_LOWER])
"""The hips and both legs: the reference's first joints."""


@dataclass(frozen=True)
class Takes:
    """F frames of C clips."""

    hips: Vectors
    """`(F, 3)` relative to the root, float32."""
    rotations: Quaternions
    """`(F, J, 4)` local, float32."""
    joints: Vectors
    """`(F, J, 3)` in the root's frame, float32."""
    root: Vectors
    """`(F, 3)` in the clips' own spaces, float64."""
    yaw: Floats
    """`(F,)`, no jumps within a clip, float64."""
    contacts: Flags
    """`(F, 2)` whether toes are planted."""
    locomotion: Flags
    """`(F,)` whether the body goes somewhere, on its feet."""
    starts: Indices
    """`(C,)` first frame of each clip."""
    lengths: Indices
    """`(C,)` frames of each clip."""
    clip: Indices
    """`(F,)` which clip a frame is of."""
    originals: int
    """Clips that are no mirrored copies; clip `i + originals` mirrors clip `i`."""

    def __len__(self) -> int:
        return len(self.hips)

    @property
    def frame(self) -> Indices:
        """`(F,)` frame within its clip."""
        return np.arange(len(self)) - self.starts[self.clip]

    @staticmethod
    def of(clips: Iterable[Clip], mirror: bool = True) -> "Takes":
        """Gather clips of 60 frames/s that hold a window at least.

        Args:
            clips: On the reference skeleton, standing on the ground y = 0.
            mirror: Whether to add mirrored copies.

        Raises:
            ValueError: If there is none, or one has another rate.
        """
        kept = [clip for clip in clips if len(clip) >= _SHORTEST]
        if not kept:
            raise ValueError(f"no clip is long enough for pairs; expected {_SHORTEST} frames")
        for clip in kept:
            if clip.frame_rate != FRAME_RATE:
                raise ValueError(
                    f"clip {clip.name!r} has {clip.frame_rate:g} frames/s; expected {FRAME_RATE:g}"
                )
        both = [*kept, *map(mirror_clip, kept)] if mirror else kept
        lengths = np.array([len(clip) for clip in both], np.intp)
        hips = np.concatenate([clip.pose.hips for clip in both]).astype(np.float32)
        rotations = np.concatenate([clip.pose.rotations for clip in both]).astype(np.float32)
        yaws = [np.unwrap(quaternion.to_yaw(clip.pose.root_rotation)) for clip in both]
        return Takes(
            hips,
            rotations,
            kinematics.forward(REFERENCE, hips, rotations)[0],
            np.concatenate([clip.pose.root_position for clip in both]).astype(np.float64),
            np.concatenate(yaws).astype(np.float64),
            np.concatenate([clip.contacts[:, [1, 3]] for clip in both]),
            np.concatenate([_locomotion(clip) for clip in both]),
            np.cumsum(lengths) - lengths,
            lengths,
            np.repeat(np.arange(len(both)), lengths),
            len(kept),
        )

    def windows(self, stride: int, frames: int = WINDOW) -> Indices:
        """Return first rows of windows in which the body goes somewhere, every `stride` frames."""
        first = np.flatnonzero(self.frame % stride == 0)
        # rates need the frames around
        room = (self.frame[first] >= 2) & (
            self.frame[first] + frames + 1 < self.lengths[self.clip[first]]
        )
        first = first[room]
        moving = np.concatenate([[0], np.cumsum(self.locomotion)])
        share = (moving[first + frames] - moving[first]) / frames
        return np.asarray(first[share > 0.5])

    def root_path(self, rows: Indices) -> tuple[Vectors, Floats]:
        """Return roots `(N, T, 3)` and yaws `(N, T)` of rows `(N, T)`, the first at the origin."""
        root, yaw = self.root[rows], self.yaw[rows]
        first = yaw[:, 0]
        return turn_to_root(root - root[:, :1], first), yaw - first[:, None]


def _locomotion(clip: Clip) -> Flags:
    """Tell in which frames a clip's body goes somewhere and only walks, runs or turns."""
    step = np.gradient(clip.pose.root_position[:, [0, 2]], axis=0) * clip.frame_rate
    out = np.asarray(np.linalg.norm(step, axis=-1) > _MOVING)
    for tag in clip.tags:
        if tag.name in _OTHER_GAITS:
            out[tag.start : tag.end] = False
    return out
