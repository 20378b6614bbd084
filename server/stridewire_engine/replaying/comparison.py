"""Comparing what two replays of one session made: transitions, places, poses."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from stridewire._messages import Frame, Transition
from stridewire.motion.array_types import Floats

POSE_TOLERANCE = 1e-5
"""Metres and quaternion components that the same session may differ by."""

Jump = tuple[int, int, str, float]
"""Frame, character, clip and time within it."""


@dataclass(frozen=True)
class Track:
    """What one replay made, as far as it is compared."""

    frames: dict[int, Frame]
    """By their number."""
    jumps: tuple[Jump, ...]
    """In order; the begin of a character is one, too."""

    @classmethod
    def of(cls, frames: Iterable[Frame]) -> "Track":
        """Collect frames."""
        kept: dict[int, Frame] = {}
        jumps: list[Jump] = []
        for frame in frames:
            kept[frame.frame] = frame
            jumps += [
                (event.frame, event.character, event.to_clip, event.to_time_s)
                for event in frame.events
                if isinstance(event, Transition)
            ]
        return cls(kept, tuple(jumps))


@dataclass(frozen=True)
class Difference:
    """How far one replay is from another."""

    frames: int
    """Frames that both have."""
    transitions: int
    """Of the one compared, begins included."""
    transitions_before: int
    """Of the one that it is compared with."""
    shared_transitions: int
    """Jumps of the same character at the same frame to the same clip and time."""
    first_difference_s: float | None
    """Session time of the first frame whose jumps or poses differ; None where none does."""
    root_apart_mean_m: float
    root_apart_max_m: float
    pose_apart_deg: float
    """Mean angle between local rotations; NaN where skeletons differ."""
    same: bool
    """The same clips and times, poses within `POSE_TOLERANCE`."""


def compare(track: Track, before: Track) -> Difference:
    """Compare a replay with another one, frame by frame.

    Raises:
        ValueError: If they have no frame in common.
    """
    shared = sorted(set(track.frames) & set(before.frames))
    if not shared:
        raise ValueError("the sessions have no frame in common; nothing can be compared")
    pairs = [(track.frames[number], before.frames[number]) for number in shared]
    jumped = set(track.jumps) ^ set(before.jumps)
    apart = {number for number, (a, b) in zip(shared, pairs, strict=True) if not _alike(a, b)}
    apart |= {jump[0] for jump in jumped} & set(shared)
    roots = np.concatenate([_roots_apart(a, b) for a, b in pairs])
    return Difference(
        frames=len(shared),
        transitions=len(track.jumps),
        transitions_before=len(before.jumps),
        shared_transitions=len(set(track.jumps) & set(before.jumps)),
        first_difference_s=before.frames[min(apart)].time_s if apart else None,
        root_apart_mean_m=float(roots.mean()) if len(roots) else 0.0,
        root_apart_max_m=float(roots.max(initial=0.0)),
        pose_apart_deg=float(np.mean([_angles_apart(a, b) for a, b in pairs])),
        same=not apart and not jumped,
    )


def _alike(a: Frame, b: Frame) -> bool:
    if a.rotations.shape != b.rotations.shape or a.characters.tolist() != b.characters.tolist():
        return False
    return all(
        np.allclose(getattr(a, name), getattr(b, name), rtol=0.0, atol=POSE_TOLERANCE)
        for name in ("root", "hips", "rotations")
    )


def _roots_apart(a: Frame, b: Frame) -> Floats:
    here, there = _shared_rows(a, b)
    return np.asarray(np.linalg.norm(a.root[here, :3] - b.root[there, :3], axis=-1))


def _angles_apart(a: Frame, b: Frame) -> float:
    """Return the mean angle between local rotations; degrees."""
    here, there = _shared_rows(a, b)
    if a.rotations.shape[1:] != b.rotations.shape[1:] or not len(here):
        return float("nan")
    one, other = a.rotations[here], b.rotations[there]
    other = other * np.where(np.sum(one * other, axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    # unlike the arc cosine of their product this is exact where both are the same
    apart, together = (np.linalg.norm(v, axis=-1) for v in (one - other, one + other))
    return float(np.rad2deg(4.0 * np.arctan2(apart, together)).mean())


def _shared_rows(a: Frame, b: Frame) -> tuple[np.ndarray, np.ndarray]:
    _, here, there = np.intersect1d(
        a.characters, b.characters, assume_unique=True, return_indices=True
    )
    return here, there
