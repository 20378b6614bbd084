"""Asking: what characters search for, in one compiled pass; see `query` for the same by numpy."""

from functools import lru_cache

import numpy as np

from stridewire.motion.array_types import Indices
from stridewire_engine.compiled import asking
from stridewire_engine.compiled.asking import Asked, Numbers, Searches, Stored
from stridewire_engine.matching.schema import Channel, ChannelKind
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime.characters import RECENT_CHOICES, SHOWN_JOINTS, Characters
from stridewire_engine.runtime.intent import Prediction
from stridewire_engine.runtime.passes import clips_of, columns
from stridewire_engine.runtime.response import QUALITY, RESPONSE
from stridewire_engine.stitchers import STITCHERS

_SHOWN = {ChannelKind.POSITION: asking.LOCAL, ChannelKind.VELOCITY: asking.VELOCITY}
_AHEAD = {
    ChannelKind.TRAJECTORY_POSITION: (asking.WAY_X, asking.WAY_Z),
    ChannelKind.TRAJECTORY_DIRECTION: (asking.SINE, asking.COSINE),
}


def needs_pose(channel: Channel) -> bool:
    """Tell whether a character that begins has nothing for a channel: it has velocities alone."""
    return not channel.is_trajectory and channel.kind is not ChannelKind.VELOCITY


class Asking:
    """What does not change from search to search over one library."""

    def __init__(self, matcher: Matcher) -> None:
        library, schema = matcher.library, matcher.schema
        self._clips = clips_of(library)
        self._stored = Stored(library.features, library.clip_of, library.twins)
        sources = [number for c in schema.channels for number in _sources(c, matcher)]
        self._numbers = Numbers(
            np.array([source for source, _, _ in sources]),
            np.array([at for _, *at in sources]),
            matcher.normalisation.mean,
            matcher.normalisation.deviation,
            schema.channel_of,
            np.array([channel.is_trajectory for channel in schema.channels]),
            np.array([needs_pose(channel) for channel in schema.channels]),
        )
        self._settled = np.array([stitcher.settled_s for stitcher in STITCHERS])
        self._ends = (float(QUALITY.trajectory), float(RESPONSE.trajectory))

    def ask(
        self, state: Characters, searching: Indices, prediction: Prediction, history: float
    ) -> Asked:
        """Return what characters ask; see `query.ask`."""
        count, channels = len(searching), len(self._numbers.is_pose)
        asked = Asked(
            np.empty(count, np.int64),
            np.empty((count, len(self._numbers.source))),
            np.empty((count, channels)),
            np.empty((count, 2 + RECENT_CHOICES), np.int64),
            np.empty((count, channels)),
        )
        asking.ask(
            columns(Searches, state), self._clips, self._stored, self._numbers, searching,
            *prediction, self._settled, self._ends, history, asked,
        )  # fmt: skip
        return asked


@lru_cache(maxsize=16)
def asking_of(matcher: Matcher) -> Asking:
    """Return what searches of a matcher's library need, made once."""
    return Asking(matcher)


def _sources(channel: Channel, matcher: Matcher) -> list[tuple[int, int, int]]:
    """Return where each number of a channel comes from, and from which joint or time."""
    if channel.is_trajectory:
        times = matcher.schema.trajectory_times
        return [
            (source if time > 0.0 else asking.STORED, max(_place(times, time), 0), 0)
            for time in channel.times
            for source in _AHEAD[channel.kind]
        ]
    known = channel.joints and set(channel.joints) <= set(SHOWN_JOINTS)
    if known and channel.kind in _SHOWN:
        joints = [SHOWN_JOINTS.index(joint) for joint in channel.joints]
        return [(_SHOWN[channel.kind], joint, axis) for joint in joints for axis in range(3)]
    return [(asking.STORED, 0, 0)] * channel.dimensions


def _place(times: tuple[float, ...], time: float) -> int:
    return times.index(time) if time in times else -1
