"""Figures of a stream, by the names that every table of the project uses."""

from dataclasses import dataclass, fields

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.evaluation import metrics
from stridewire_engine.evaluation.captured import TOES, Captured, Measured, measure
from stridewire_engine.evaluation.streaming import RATE, Stream, under_root
from stridewire_engine.evaluation.tally import Mean, Percentile, Tally

BLOCK_FRAMES = 10
_AFTER_SEAM = 10
_TRUTH_FRAMES = 10
_REFINED_FRAMES = 8
"""A transition is refined if a network guided so many frames of it."""

Figures = dict[str, Tally]


def of_motion(frames: Measured) -> Figures:
    """Return what can be said of any motion, captured or streamed: frames `(T, S, …)`."""
    speed, height, planted = frames.toe_speed, frames.toe_height, frames.planted
    contact = metrics.sliding_c(speed, planted)
    skates = np.where(np.isnan(contact), np.nan, contact > metrics.SKATING_SPEED)
    return {
        "sliding_a_cm_s": Mean.of(metrics.sliding_a(speed, height), 100.0),
        "sliding_b_cm_s": Mean.of(metrics.sliding_b(speed, height), 100.0),
        "sliding_c_cm_s": Mean.of(contact, 100.0),
        "skating_pct": Mean.of(skates, 100.0),
        "float_cm": Mean.of(metrics.floating(height, planted), 100.0),
        "penetration_cm": Mean.of(metrics.penetration(height, planted), 100.0),
        "knee_extension_p99": Percentile.of(frames.extension, 99.0, 0.8, 1.0),
    }


class Judged:
    """A stream measured once, frame by frame; figures are read off it for any of its frames."""

    def __init__(self, stream: Stream, captured: Captured) -> None:
        """Measure all frames."""
        library = captured.library
        planted = library.contacts[stream.rows][..., 1::2]
        toes = stream.positions[..., library.skeleton.indices(TOES), :]
        self._stream, self._captured = stream, captured
        self._shown = measure(library.skeleton, stream.positions, planted, captured.floor, RATE)
        self._played = captured.frames[stream.rows]
        self._offset = metrics.lock_offset(toes, stream.foot_targets)
        self._locked = metrics.locked_share(stream.foot_targets, planted)
        self._lag = _lag(stream, captured, toes)
        self._truth = _truth_error(stream, captured)
        position = stream.pose.root_position[..., [0, 2]]
        self._away = metrics.following_error(position, stream.wanted.velocity, RATE)
        self._refined = _refined(stream)
        self._seams = np.zeros(stream.since.shape)
        self._seams[stream.seams.frame, stream.seams.character] = 1.0

    def captured(self, mask: Flags) -> Figures:
        """Return the figures of the captured frames that the stream played."""
        frames = masked(self._played, mask)
        one = Mean.of(frames.jerk)
        return {
            **of_motion(frames),
            "jump_pct": Mean.of(self._beyond(frames.step, mask), 100.0),
            "jerk_ratio": one.relative_to(one),
            "toe_jerk": Mean.of(frames.toe_jerk),
            "knee_jerk": Mean.of(frames.knee_jerk),
            "frames": _count(mask),
        }

    def streamed(self, mask: Flags) -> Figures:
        """Return the figures of the stream, where `mask` `(T, S)` says so."""
        frames, played = masked(self._shown, mask), np.where(mask, self._played.jerk, np.nan)
        feet = mask[..., None]
        return {
            **of_motion(frames),
            "jerk_ratio": Mean.of(frames.jerk).relative_to(Mean.of(played)),
            "toe_jerk": Mean.of(frames.toe_jerk),
            "knee_jerk": Mean.of(frames.knee_jerk),
            "jump_pct": Mean.of(self._beyond(frames.step, mask), 100.0),
            "lock_offset_cm": Percentile.of(
                100.0 * np.where(feet, self._offset, np.nan), 95.0, 0.0, 40.0
            ),
            "locked_pct": Mean.of(np.where(feet, self._locked, np.nan), 100.0),
            "clip_lag_cm": Mean.of(np.where(feet, self._lag, np.nan), 100.0),
            "truth_error_cm": Mean.of(np.where(mask, self._truth, np.nan), 100.0),
            "following_error_m": Mean.of(np.where(mask, self._away, np.nan)),
            "transitions_per_s": Mean.of(np.where(mask, self._seams, np.nan), RATE),
            "refined_pct": Mean.of(np.where(mask, self._refined, np.nan), 100.0),
            "frames": _count(mask),
        }

    def _beyond(self, step: Floats, mask: Flags) -> Floats:
        """Return where joints changed their velocity by more than captured ones do, near seams."""
        near = mask & (self._stream.since < _AFTER_SEAM)
        jumps = (step > self._captured.step_limits).astype(np.float64)
        return np.where(near[..., None] & ~np.isnan(step), jumps, np.nan)


@dataclass(frozen=True)
class Blocks:
    """Masks of the frames of a stream by how long ago the last transition was."""

    stream: Stream

    def mask(self, block: str) -> Flags:
        """Return `(T, S)`: `all`, or the first, second, third ten frames after one, or later."""
        since = self.stream.since
        if block == "all":
            return np.ones(since.shape, np.bool_)
        return np.asarray(np.minimum(since // BLOCK_FRAMES, 3) == int(block))


def masked(frames: Measured, mask: Flags) -> Measured:
    """Leave out frames: their values become NaN, their contacts none."""
    out = []
    for field in fields(frames):
        array = getattr(frames, field.name)
        keep = mask.reshape(mask.shape + (1,) * (array.ndim - 2))
        out.append(array & keep if array.dtype == np.bool_ else np.where(keep, array, np.nan))
    return Measured(*out)


def _count(mask: Flags) -> Mean:
    """Return the number of frames, as a sum over units."""
    total = mask.sum(axis=0).astype(np.float64)
    return Mean(total, np.full(len(total), 1.0 / len(total)))


def _lag(stream: Stream, captured: Captured, toes: Floats) -> Floats:
    """Return the distance `(T, S, 2)` of the sent toes from the clip's under the sent root."""
    local = captured.toes_under_root
    weight = stream.moments.weight[..., None, None]
    first, second = local[stream.moments.rows], local[stream.moments.rows + 1]
    return metrics.distance(toes, under_root(stream, first + weight * (second - first)))


def _refined(stream: Stream) -> Floats:
    """Return where transitions come `(T, S)` whether a network refined them, NaN elsewhere.

    Those that are cut off by the stream's end do not count; those cut off by the next are not.
    """
    out = np.full(stream.since.shape, np.nan)
    ahead = np.arange(_REFINED_FRAMES)
    whole = stream.seams.frame + _REFINED_FRAMES <= len(out)
    frame, who = stream.seams.frame[whole], stream.seams.character[whole]
    frames = frame[:, None] + ahead
    led = stream.refined[frames, who[:, None]] & (stream.since[frames, who[:, None]] == ahead)
    out[frame, who] = led.all(axis=1)
    return out


def _truth_error(stream: Stream, captured: Captured) -> Floats:
    """Return how far joints are from where the take really went on, `(T, S)`, NaN elsewhere.

    In the ten frames after a transition; the take's frame before it lies under the root that was
    sent in that frame.
    """
    library, seams = captured.library, stream.seams
    out = np.full(stream.since.shape, np.nan)
    ahead = np.arange(1, _TRUTH_FRAMES + 1)
    frames = seams.frame[:, None] - 1 + ahead
    rows = seams.from_row[:, None] + ahead
    inside = np.minimum(frames, len(out) - 1)
    last = (library.clip_starts + library.clip_frames)[library.clip_of[seams.from_row]]
    good = (frames < len(out)) & (rows < last[:, None]) & (seams.frame > 0)[:, None]
    good &= stream.since[inside, seams.character[:, None]] == ahead - 1
    k, i = np.nonzero(good)
    if not len(k):
        return out
    before, who, row = seams.frame[k] - 1, seams.character[k], seams.from_row[k]
    turn = quaternion.multiply(
        stream.pose.root_rotation[before, who],
        quaternion.conjugate(quaternion.from_yaw(library.root_yaw[row].astype(np.float64))),
    )
    world = captured.positions[rows[k, i]] - library.root_position[row][:, None]
    truth = (
        quaternion.rotate(turn[:, None], world.astype(np.float64))
        + stream.pose.root_position[before, who][:, None]
    )
    sent = stream.positions[frames[k, i], who]
    out[frames[k, i], who] = metrics.distance(sent, truth).mean(axis=-1)
    return out
