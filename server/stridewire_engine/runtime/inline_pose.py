"""A pose that a caller gives by its numbers: what is known of it, and what a search makes of it."""

from collections.abc import Iterator

import numpy as np

from stridewire._errors import Violation
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.matching.features import clip_features
from stridewire_engine.matching.schema import ChannelKind, Schema
from stridewire_engine.matching.search import Matcher

NOTHING_TO_COMPARE = (
    "only channels have weight that a pose without motion does not tell; give weight to one of "
    "another kind, or refer to a moment of a clip"
)

_NORM_TOLERANCE = 0.05
_MAX_COORDINATE = 1e6


def check(path: str, pose: Pose, skeleton: Skeleton) -> Iterator[Violation]:
    """Yield what is wrong with one pose on a library's skeleton."""
    joints, expected = len(pose.rotations), len(skeleton)
    if joints != expected:
        yield Violation(
            f"{path}.rotations", f"{joints} joints; the library's skeleton has {expected}"
        )
    for name, values in (("root", pose.root_position), ("hips", pose.hips)):
        if not np.all(np.abs(values) <= _MAX_COORDINATE):
            yield Violation(f"{path}.{name}", "a value is not finite or above 1e6 metres")
    for name, values in (("root", pose.root_rotation), ("rotations", pose.rotations)):
        norms = np.linalg.norm(values, axis=-1)
        if not np.all(np.abs(norms - 1.0) <= _NORM_TOLERANCE):
            yield Violation(f"{path}.{name}", "a quaternion is not of unit length, w x y z")


def features(matcher: Matcher, pose: Pose) -> Floats:
    """Return normalised features `(1, D)` of a pose that stands still, float64."""
    clip = Clip(
        "inline", matcher.library.skeleton, 60.0, pose[np.newaxis], np.zeros((1, 4), np.bool_)
    )
    channels = matcher.schema.channels
    unknown = {
        channel.name: lambda _, size=channel.size: np.zeros((1, size))
        for channel in channels
        if channel.kind is ChannelKind.CUSTOM
    }
    raw = clip_features(matcher.schema, clip, unknown)
    return matcher.normalisation.apply(raw).astype(np.float64)


def known(schema: Schema, has_intent: bool) -> Floats:
    """Return `(C,)`: 1 for channels that a pose and its intent tell, 0 for the others."""
    told = [
        has_intent and min(channel.times) > 0.0
        if channel.is_trajectory
        else channel.kind not in (ChannelKind.VELOCITY, ChannelKind.CUSTOM)
        for channel in schema.channels
    ]
    return np.array(told, np.float64)
