"""A recording: the frames of a session, and the clips that they make."""

import numpy as np

from stridewire._messages import Frame
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.kinematics import forward_world
from stridewire.motion.skeleton import Skeleton

_CONTACT_BITS = np.array([1, 2, 4, 8], np.uint32)


class Recording:
    """Collects frames.

    Args:
        skeleton: The session's, `session.opened.skeleton`.
    """

    def __init__(self, skeleton: Skeleton) -> None:
        self._skeleton = skeleton
        self._frames: list[Frame] = []

    def add(self, frame: Frame) -> None:
        """Take a frame."""
        self._frames.append(frame)

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def characters(self) -> list[int]:
        """Ids of all characters that occur."""
        return sorted({int(id) for frame in self._frames for id in frame.characters})

    def clip(self, character: int, name: str, frame_rate: float = 60.0) -> Clip:
        """Return what a character did, at an even rate; frames that were dropped are filled in.

        Args:
            character: Its id.
            name: Name of the clip.
            frame_rate: Frames per second.

        Raises:
            LookupError: If the character is in no frame.
        """
        rows = [
            (frame, int(row[0]))
            for frame in self._frames
            if len(row := np.flatnonzero(frame.characters == character))
        ]
        if not rows:
            raise LookupError(f"character {character} is in no frame of the recording")
        times = np.array([frame.time_s for frame, _ in rows])
        kept = np.flatnonzero(np.diff(times, prepend=-np.inf) > 0.0)  # a paused frame takes no time
        rows, times = [rows[i] for i in kept], times[kept]
        root = np.stack([frame.root[row] for frame, row in rows])
        pose = Pose(
            root[:, :3],
            root[:, 3:],
            np.stack([frame.hips[row] for frame, row in rows]),
            np.stack([frame.rotations[row] for frame, row in rows]),
        )
        masks = np.array([frame.contacts[row] for frame, row in rows], np.uint32)
        contacts = masks[:, None] & _CONTACT_BITS != 0
        even_pose, even_contacts = _evenly(times, pose, contacts, frame_rate)
        return Clip(
            name, self._skeleton, frame_rate, even_pose, even_contacts, source="a recorded session"
        )


def toe_sliding(clip: Clip) -> Floats:
    """Return the planar speed of each planted toe in each frame where it stays planted; m/s.

    Args:
        clip: On a skeleton with the joints LeftToe and RightToe.
    """
    positions, _ = forward_world(clip.skeleton, clip.pose)
    toes = positions[:, clip.skeleton.indices(("LeftToe", "RightToe"))]
    speed = np.linalg.norm(np.diff(toes[..., (0, 2)], axis=0), axis=-1) * clip.frame_rate
    planted = clip.contacts[:, (1, 3)]
    return np.asarray(speed[planted[1:] & planted[:-1]])


def _evenly(times: Floats, pose: Pose, contacts: Flags, rate: float) -> tuple[Pose, Flags]:
    """Sample poses at uneven times `(T,)` evenly; contacts are those of the frame before."""
    count = round((times[-1] - times[0]) * rate) + 1
    at = times[0] + np.arange(count) / rate
    after = np.clip(np.searchsorted(times, at + 1e-6, side="right"), 1, max(len(times) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(times) - 1)
    span = np.maximum(times[after] - times[before], 1e-9)
    weight = np.clip((at - times[before]) / span, 0.0, 1.0).astype(np.float32)
    a, b = pose[before], pose[after]
    sampled = Pose(
        a.root_position + weight[:, None] * (b.root_position - a.root_position),
        quaternion.nlerp(a.root_rotation, b.root_rotation, weight),
        a.hips + weight[:, None] * (b.hips - a.hips),
        quaternion.nlerp(a.rotations, b.rotations, weight[:, None]),
    )
    return sampled, contacts[np.where(weight < 1.0, before, after)]
