"""Tags: named spans of a clip, from how it moves and from the words of its file's name.

Every frame gets one of `idle`, `walk`, `jog`, `run`, `backward`, `sidestep` (with `sidestep-left`
or `-right`); `turn` (`turn-left`, `turn-right`), `start` and `stop` lie over them. Frames that
crawl, sit, lie or stand deep get `low` instead, such that climb or leap `aloft`, and such whose
hands are busy `gesture`: they are no plain locomotion, whatever their speed.
Words of the file's name that no speed tells, such as `dance`, hold for the whole clip.
"""

import re
from collections.abc import Collection, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.clip import Clip, Pose, TagSpan, differences
from stridewire.motion.root import savitzky_golay
from stridewire_engine.building.posture import posture

IDLE_SPEED = 0.25
"""Below this a character stands; metres per second."""
JOG_SPEED = 2.0
"""Between walking and jogging; people change gait at about 2 m/s."""
RUN_SPEED = 3.2
"""Between jogging and running; metres per second."""
TURN_RATE = np.deg2rad(45.0)
"""From this on a frame turns; radians per second."""

FILE_WORDS = {
    "aiming": ("aim",),
    "climb": ("climb", "ladder"),
    "crouch": ("crouch", "duck"),
    "dance": ("danc", "salsa", "ballet", "pirouette"),
    "fall": ("fall", "stumble", "trip"),
    "fight": ("fight", "punch", "kick", "box", "karate", "sword"),
    "jump": ("jump", "hop", "leap"),
    "obstacles": ("obstacle",),
    "push": ("push",),
    "sit": ("sit", "chair"),
    "sneak": ("sneak", "creep"),
    "sport": ("sport", "basketball", "soccer", "football", "swing", "throw"),
}
"""Tags of the whole clip by how words of file names and descriptions begin."""

_MOST = 0.8
_PIECE_S = 2.0
_SMOOTHING_S = 0.5
_SHORTEST_S = 0.25
_AROUND_S = 0.7
_UNDER_WAY = 0.8
_ASIDE_SPEED = 0.4
_TO_SIDE = np.deg2rad(50.0)
_TO_BACK = np.deg2rad(130.0)


def tag(clip: Clip, words: str) -> Clip:
    """Return the clip with tags.

    Args:
        clip: On the reference skeleton.
        words: Name of the file, or a description that came with it.
    """
    return replace(clip, tags=(*file_tags(words, len(clip)), *measured_tags(clip)))


def file_tags(words: str, frames: int) -> tuple[TagSpan, ...]:
    """Return tags of the whole clip for known words in a name such as `fallAndGetUp1_subject2`."""
    spaced = re.sub(r"([a-z])([A-Z])", r"\1 \2", words)
    found = re.findall(r"[a-z]+", spaced.lower())
    return tuple(
        TagSpan(name, 0, frames)
        for name, stems in FILE_WORDS.items()
        if any(word.startswith(stems) for word in found)
    )


def measured_tags(clip: Clip) -> tuple[TagSpan, ...]:
    """Return the tags that speed, direction, turning and posture show, in order of time."""
    frame_rate = clip.frame_rate
    velocity = local_velocity(clip.pose, frame_rate)
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    turning = yaw_rate(clip.pose, frame_rate)
    shortest = round(_SHORTEST_S * frame_rate)
    body = posture(clip, speed)
    plain = ~(body.low | body.aloft | body.gesture)
    moving = _settle(speed >= IDLE_SPEED, shortest) & plain
    gait = _settle_labels(_gaits(speed, np.arctan2(velocity[:, 0], velocity[:, 1])), shortest)
    masks = {str(name): moving & (gait == name) for name in np.unique(gait)}
    side = masks.get("sidestep", np.zeros(len(clip), bool))
    masks |= {
        "idle": plain & ~moving,
        "low": body.low,
        "aloft": body.aloft,
        "gesture": body.gesture,
        "sidestep-left": side & (velocity[:, 0] > 0.0),
        "sidestep-right": side & (velocity[:, 0] <= 0.0),
        "turn": plain & _settle(np.abs(turning) >= TURN_RATE, shortest),
    }
    masks["turn-left"] = masks["turn"] & (turning > 0.0)
    masks["turn-right"] = masks["turn"] & (turning <= 0.0)
    changes = _changes(speed, masks["idle"], round(_AROUND_S * frame_rate))
    masks |= {name: mask & plain for name, mask in changes.items()}
    spans = [span for name, mask in masks.items() for span in _spans(name, mask, shortest)]
    return tuple(sorted(spans, key=lambda span: (span.start, span.name)))


def only_tagged(clip: Clip, names: Collection[str]) -> bool:
    """Return whether a clip is of some kinds of motion: most frames are, and no words say others.

    Args:
        clip: With its tags.
        names: Tags, of which at least one holds in four of five frames; words of file names and
            descriptions that are not among them leave the clip out.
    """
    covered = np.zeros(len(clip), bool)
    for span in clip.tags:
        if span.name in FILE_WORDS and span.name not in names:
            return False
        if span.name in names:
            covered[span.start : span.end] = True
    return bool(covered.mean() >= _MOST)


def without(clip: Clip, names: Collection[str]) -> list[Clip]:
    """Return what is left of a clip where tags are cut out, in pieces of two seconds or more.

    Args:
        clip: With its tags.
        names: Tags that are cut out. Where none of them holds the clip stays whole.
    """
    kept = np.ones(len(clip), bool)
    for span in clip.tags:
        if span.name in names:
            kept[span.start : span.end] = False
    if kept.all():
        return [clip]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], kept, [False]])))
    runs = edges.reshape(-1, 2)[np.diff(edges.reshape(-1, 2)).ravel() >= _PIECE_S * clip.frame_rate]
    return [clip.cut(a, b, f"{clip.name}-{i}") for i, (a, b) in enumerate(runs.tolist(), 1)]


def local_velocity(pose: Pose, frame_rate: float) -> Floats:
    """Return `(T, 2)` smoothed velocity of the root to its left and forward; m/s."""
    velocity = differences(pose.root_position.astype(np.float64), 1.0 / frame_rate)
    facing = pose.root_rotation.astype(np.float64)
    local = quaternion.rotate(quaternion.conjugate(facing), velocity)[:, [0, 2]]
    return savitzky_golay(local, _window(frame_rate), order=1)


def yaw_rate(pose: Pose, frame_rate: float) -> Floats:
    """Return `(T,)` smoothed turning rate of the root; rad/s, positive to the left."""
    yaw = np.unwrap(quaternion.to_yaw(pose.root_rotation.astype(np.float64)))
    rate = differences(yaw, 1.0 / frame_rate)
    return savitzky_golay(rate[:, None], _window(frame_rate), order=1)[:, 0]


def _window(frame_rate: float) -> int:
    return 2 * round(0.5 * _SMOOTHING_S * frame_rate) + 1


def _gaits(speed: Floats, angle: Floats) -> np.ndarray:
    """Name the gait of each frame as though it moved."""
    names = np.select([speed >= RUN_SPEED, speed >= JOG_SPEED], ["run", "jog"], "walk")
    # slower than this a turn on the spot drifts in any direction
    away = np.where(speed < _ASIDE_SPEED, 0.0, np.abs(angle))
    return np.select([away > _TO_BACK, away > _TO_SIDE], ["backward", "sidestep"], names)


def _changes(speed: Floats, idle: Flags, around: int) -> dict[str, Flags]:
    """Mark `around` frames on both sides of where a character sets off and comes to rest."""
    masks = {"start": np.zeros(len(idle), bool), "stop": np.zeros(len(idle), bool)}
    for begin, end in _runs(idle):
        # a single step aside is neither a start nor a stop
        if begin > 0 and speed[max(begin - 2 * around, 0) : begin].max() > _UNDER_WAY:
            masks["stop"][max(begin - around, 0) : begin + around] = True
        if end < len(idle) and speed[end : end + 2 * around].max() > _UNDER_WAY:
            masks["start"][max(end - around, 0) : end + around] = True
    return masks


def _settle(flags: Flags, shortest: int) -> Flags:
    """Flip runs of fewer than `shortest` frames: first the gaps, then the islands."""
    out = flags.copy()
    for value in (False, True):
        for start, end in _runs(out == value):
            if end - start < shortest and start > 0 and end < len(out):
                out[start:end] = not value
    return out


def _settle_labels(labels: np.ndarray, shortest: int) -> np.ndarray:
    """Give runs of fewer than `shortest` frames the label before them."""
    out = labels.copy()
    edges = np.flatnonzero(np.concatenate([[True], out[1:] != out[:-1], [True]]))
    for start, end in pairwise(edges):
        if end - start < shortest and start > 0:
            out[start:end] = out[start - 1]
    return out


def _spans(name: str, mask: Flags, shortest: int) -> Iterator[TagSpan]:
    for start, end in _runs(mask):
        if end - start >= shortest or end - start == len(mask):
            yield TagSpan(name, start, end)


def _runs(mask: Flags) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
