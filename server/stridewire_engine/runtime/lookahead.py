"""Look-ahead: where the legs of the clips that play will be, for stitchers that plan steps."""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.root_frame import turn_to_world
from stridewire_engine.library import Library
from stridewire_engine.runtime import sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.stitchers import LegsAhead
from stridewire_engine.stitchers.legs import Legs, leg_pose

_CHUNK = 50_000
_LN2 = float(np.log(2.0))


class LegTracks(NamedTuple):
    """Joints of the legs in every frame of a library, in the root's frame; float32."""

    hips: Vectors
    """`(F, 2, 3)` hip joints."""
    ankles: Vectors
    """`(F, 2, 3)`."""
    toes: Vectors
    """`(F, 2, 3)`."""

    @classmethod
    def of(cls, library: Library, legs: Legs) -> "LegTracks":
        """Work them out, a part of the library at a time."""
        tracks = [np.empty((len(library.hips), 2, 3), np.float32) for _ in range(3)]
        for start in range(0, len(library.hips), _CHUNK):
            rows = slice(start, start + _CHUNK)
            pose = leg_pose(legs, library.hips[rows], library.rotations[rows])
            for track, part in zip(tracks, (pose.hip, pose.ankle, pose.toe), strict=True):
                track[rows] = part
        return cls(*tracks)


def legs_ahead(
    state: Characters,
    library: Library,
    tracks: LegTracks,
    times: Floats,
    pull: Floats,
    root_halflife: float,
) -> LegsAhead:
    """Return the legs at K times ahead, in the frames of the roots as they are now.

    Args:
        state: N rows, clip times already advanced.
        library: That they play.
        tracks: Of the library.
        times: `(K,)` seconds.
        pull: `(N, 3)` x, z, yaw a second that the root goes beyond its clip.
        root_halflife: Of the damper of the root's velocity difference.
    """
    count = len(times)
    clip = np.repeat(state.clip, count)
    now = sampling.moments(library, state.clip, state.clip_time).repeated(count)
    then = sampling.moments(
        library, clip, (state.clip_time[:, None] + state.pace[:, None] * times).ravel()
    )
    motion = sampling.root_delta(library, now, then).reshape(-1, count, 3)
    faded = fading(times, root_halflife)
    motion += state.root_offset[:, None] * faded[:, None] + pull[:, None] * times[:, None]
    # a few metres and radians at most: float32 is exact enough, and half the work
    motion = motion.astype(np.float32)
    hips, ankles, toes = (_move(_between(track, then), motion) for track in tracks)
    contacts = library.contacts[then.nearest][:, 1::2].reshape(-1, count, 2)
    return LegsAhead(times, hips, ankles, toes, contacts)


def fading(times: Floats, root_halflife: float) -> Floats:
    """Return the seconds `(K,)` for which a velocity difference that fades counts until then."""
    return np.asarray(-np.expm1(-_LN2 * times / root_halflife) * (root_halflife / _LN2))


def _between(track: Vectors, at: sampling.Moments) -> Vectors:
    a, b = track[at.rows], track[at.rows + 1]
    return np.asarray(a + at.weight[:, None, None] * (b - a))


def _move(local: Vectors, motion: Floats) -> Vectors:
    """Take points `(N K, 2, 3)` under moved roots into the frame before the move."""
    out = turn_to_world(local, motion[..., 2].reshape(-1)).reshape(*motion.shape[:2], 2, 3)
    out[..., [0, 2]] += motion[..., None, :2]
    return out
