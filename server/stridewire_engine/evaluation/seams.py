"""Seams: pairs as poses, and stitchers that hide their seams frame by frame, as the tick has them.

What was shown before the first seam stays as it is; each seam is handed over in the frame before.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.rmr import Guidance
from stridewire_engine.networks.rmr.pairs import Pairs
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.networks.rmr.takes import LOWER, Takes
from stridewire_engine.stitchers import (
    Guide,
    LegsAhead,
    Motion,
    Roots,
    Sample,
    Stitcher,
    StitchState,
)
from stridewire_engine.stitchers.legs import LegPose, Legs, leg_pose

_PLANTED = 0.5


@dataclass(frozen=True)
class Poses:
    """Poses `(N, T)` under roots that are given."""

    hips: Vectors
    """`(N, T, 3)` relative to the root."""
    rotations: Quaternions
    """`(N, T, J, 4)` local."""


@dataclass(frozen=True)
class Windows:
    """N windows of T frames around seams."""

    takes: Takes
    pairs: Pairs
    root: Vectors
    """`(N, T, 3)` that is shown."""
    yaw: Floats
    """`(N, T)`."""

    def __len__(self) -> int:
        return len(self.pairs)

    @cached_property
    def raw(self) -> Poses:
        """What is set together, seams and all."""
        return Poses(*posed(self.takes, self.pairs.rows, self.pairs.truth, self.pairs.help))

    @cached_property
    def legs(self) -> Legs:
        """Of the reference skeleton."""
        return Legs.of(REFERENCE)

    @cached_property
    def leg_pose(self) -> LegPose:
        """Legs of what is set together, `(N, T, 2, …)`."""
        n, t = self.yaw.shape
        flat = leg_pose(
            self.legs,
            self.raw.hips.reshape(n * t, 3),
            self.raw.rotations.reshape(n * t, len(REFERENCE), 4),
        )
        return LegPose(*(part.reshape(n, t, *part.shape[1:]) for part in flat))

    @cached_property
    def contacts(self) -> Flags:
        """`(N, T, 2)` whether what is set together has toes planted."""
        return self.takes.contacts[self.pairs.rows]

    def roots(self, rows: Indices, frame: int) -> Roots:
        """Return the roots of some windows in a frame."""
        return Roots(self.root[rows, frame], self.yaw[rows, frame])

    def toes(self, rows: Indices, frame: int) -> Vectors:
        """Return where toes of what is set together are in the world."""
        return self.roots(rows, frame).to_world(self.leg_pose.toe[rows, frame])


def posed(
    takes: Takes, rows: Indices, truth: Indices, share: Floats
) -> tuple[Vectors, Quaternions]:
    """Return hips and rotations of rows, so much of their upper bodies as in the truth."""
    rotations = takes.rotations[rows]
    upper = quaternion.slerp(
        rotations[..., len(LOWER) :, :],
        takes.rotations[truth][..., len(LOWER) :, :],
        share[..., None].astype(np.float32),
    )
    return takes.hips[rows], np.concatenate([rotations[..., : len(LOWER), :], upper], axis=-2)


def stitched(windows: Windows, stitcher: Stitcher, guidance: Guidance | None = None) -> Poses:
    """Let a stitcher hide the seams.

    Args:
        windows: N windows.
        stitcher: Any.
        guidance: For a stitcher that plants feet, where they are to go instead.
    """
    raw = windows.raw
    made = Poses(raw.hips.copy(), raw.rotations.copy())
    state = StitchState.fresh(len(windows), len(REFERENCE))
    state.stitch_time[...] = np.inf
    begun = np.zeros(len(windows), bool)
    for frame in range(1, windows.yaw.shape[1]):
        seams = np.flatnonzero(windows.pairs.starts[:, frame])
        if len(seams):
            _enter(windows, state, seams[~begun[seams]], frame)
            begun[seams] = True
            _begin(windows, stitcher, state, seams, frame, guidance)
        rows = np.flatnonzero(begun)
        if not len(rows):
            continue
        part = state.take(rows)
        dt = np.full(len(rows), 1.0 / FRAME_RATE, np.float32)
        part.stitch_time += dt
        sample = _sample(windows, stitcher, rows, frame, guidance)
        made.hips[rows, frame], made.rotations[rows, frame] = stitcher.apply(part, sample, dt)
        state.put(rows, part)
    return made


def _enter(windows: Windows, state: StitchState, rows: Indices, frame: int) -> None:
    """Note where the toes are, and how fast, before the first seam."""
    toes = windows.toes(rows, frame - 1)
    state.toe_shown[rows] = toes
    state.toe_speed[rows] = (toes - windows.toes(rows, frame - 2)) * FRAME_RATE
    state.legs_shown[rows] = windows.raw.rotations[rows, frame - 1][:, windows.legs.joints]


def _begin(
    windows: Windows,
    stitcher: Stitcher,
    state: StitchState,
    rows: Indices,
    frame: int,
    guidance: Guidance | None,
) -> None:
    part = state.take(rows)
    old = windows.pairs.rows[rows, frame - 1]
    new = windows.pairs.rows[rows, frame]
    source = _motion(windows, rows, frame, old, old + 1)
    target = _motion(windows, rows, frame, new - 1, new)
    if guidance is not None:
        led = turn_to_root(guidance.toe_offset[rows, frame - 1], windows.yaw[rows, frame - 1])
        target = target._replace(toes=target.toes + led)
    stitcher.begin(part, source, target, windows.roots(rows, frame - 1))
    part.stitch_time[...] = 0.0
    state.put(rows, part)


def _motion(windows: Windows, rows: Indices, frame: int, at: Indices, after: Indices) -> Motion:
    """Return poses of takes' rows in the frame before `frame`, and how they change until then."""
    pairs, takes, legs = windows.pairs, windows.takes, windows.legs
    hips, rotations = posed(takes, at, pairs.truth[rows, frame - 1], pairs.help[rows, frame - 1])
    then_hips, then = posed(takes, after, pairs.truth[rows, frame], pairs.help[rows, frame])
    rate = np.float32(FRAME_RATE)
    step = quaternion.multiply(then, quaternion.conjugate(rotations))
    toes = leg_pose(legs, hips, rotations).toe
    return Motion(
        hips,
        rotations,
        (then_hips - hips) * rate,
        quaternion.to_scaled_axis(step) * rate,
        toes,
        (leg_pose(legs, then_hips, then).toe - toes) * rate,
    )


def _sample(
    windows: Windows, stitcher: Stitcher, rows: Indices, frame: int, guidance: Guidance | None
) -> Sample:
    ahead = None
    if stitcher.looks_ahead:
        ahead = _ahead(windows, np.array(stitcher.looks_ahead), rows, frame, guidance)
    sample = Sample(
        windows.raw.hips[rows, frame],
        windows.raw.rotations[rows, frame],
        windows.contacts[rows, frame],
        windows.roots(rows, frame),
        np.zeros(len(rows), bool),
        windows.legs,
        ahead,
    )
    if guidance is None:
        return sample
    yaw = windows.yaw[rows, frame]
    guide = Guide(
        guidance.planted[rows, frame],
        turn_to_root(guidance.toe_offset[rows, frame], yaw),
        turn_to_root(guidance.foot_turn[rows, frame], yaw),
    )
    return sample._replace(contacts=guide.planted > _PLANTED, guide=guide)


def _ahead(
    windows: Windows, times: Floats, rows: Indices, frame: int, guidance: Guidance | None
) -> LegsAhead:
    """Return where legs will be; beyond a window's end they stay."""
    roots, pose = windows.roots(rows, frame), windows.leg_pose
    last = windows.yaw.shape[1] - 1
    tracks: list[list[Vectors]] = [[], [], []]
    contacts = []
    for then in np.minimum(frame + np.round(times * FRAME_RATE).astype(int), last):
        of_then = windows.roots(rows, int(then))
        offset = 0.0 if guidance is None else guidance.toe_offset[rows, then]
        for track, local, moved in zip(
            tracks, (pose.hip, pose.ankle, pose.toe), (0.0, offset, offset), strict=True
        ):
            track.append(roots.to_root(of_then.to_world(local[rows, then]) + moved))
        label = windows.contacts[rows, then]
        contacts.append(label if guidance is None else guidance.planted[rows, then] > _PLANTED)
    hips, ankles, toes = (np.stack(track, axis=1) for track in tracks)
    return LegsAhead(times, hips, ankles, toes, np.stack(contacts, axis=1))
