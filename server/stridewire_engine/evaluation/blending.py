"""Judging posture blends: against what was captured between two moments, and against linear.

Figures are kept by clip and by weight, so that they pool over both and have intervals over clips.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Flags, Floats
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE
from stridewire_engine.evaluation.body_boxes import collisions
from stridewire_engine.evaluation.metrics import planar_speed, sliding_c
from stridewire_engine.networks.blend.correction import linear
from stridewire_engine.networks.blend.features import write_postures
from stridewire_engine.networks.blend.network import joint_weights
from stridewire_engine.networks.blend.pairs import Frames, Pairs
from stridewire_engine.networks.blend.postures import Postures

Method = Callable[[Pairs], Postures]
"""Returns postures `(N, W)` at the weights of pairs."""

DURATIONS = tuple(round(0.1 * k, 1) for k in range(1, 11))
"""Seconds."""
BINS = 11
"""Weights are counted at the nearest tenth."""
LINEAR = "linear"
ENDS = ("LeftFoot", "RightFoot", "LeftHand", "RightHand")
FIGURES = ("mse", "position_error_cm", "end_effector_cm", "sliding_c_cm_s", "collisions")
_PAIRS_AT_ONCE = 256
_STILL = 1e-2


@dataclass(frozen=True)
class Sums:
    """A figure summed by clip and weight."""

    total: Floats
    """`(S, BINS)`."""
    weight: Floats
    """`(S, BINS)` how many frames were counted."""

    @staticmethod
    def of(values: Floats, pairs: Pairs, clips: int) -> "Sums":
        """Sum `(N, W)` values strictly between the ends; NaN is not counted."""
        inside = (pairs.weights > 0.0) & (pairs.weights < 1.0) & ~np.isnan(values)
        place = pairs.clip[:, None] * BINS + np.round(10.0 * pairs.weights).astype(np.intp)
        size = clips * BINS
        total = np.bincount(place[inside], values[inside], size).astype(np.float64)
        weight = np.bincount(place[inside], None, size).astype(np.float64)
        return Sums(total.reshape(clips, BINS), weight.reshape(clips, BINS))

    @staticmethod
    def pool(parts: Iterable["Sums"]) -> "Sums":
        """Add sums over the same clips."""
        all_parts = list(parts)
        return Sums(
            np.sum([part.total for part in all_parts], axis=0),
            np.sum([part.weight for part in all_parts], axis=0),
        )


Measured = Mapping[tuple[float, str], Mapping[str, Sums]]
"""Figures by duration and method."""


def measure(
    frames: Frames,
    methods: Mapping[str, Method],
    deviation: Floats,
    durations: Iterable[float] = DURATIONS,
    step: float = 0.25,
    done: Callable[[int], None] = lambda count: None,
) -> Measured:
    """Measure methods, and linear blending, on pairs all along the clips.

    Args:
        frames: Captured, of subjects that no method was trained on.
        methods: By name.
        deviation: `(135,)` of postures as the paper writes them, in training.
        durations: Between the ends of pairs, seconds.
        step: Seconds from one pair to the next.
        done: Told of each duration.
    """
    ways: dict[str, Method] = {LINEAR: blend_linearly, **methods}
    # joints that hardly moved in training say nothing
    deviation = np.where(deviation < _STILL, np.inf, deviation)
    out: dict[tuple[float, str], dict[str, Sums]] = {}
    for duration in durations:
        span = round(duration * frames.frame_rate)
        pairs = frames.every(duration, step, np.arange(span + 1) / span)
        parts = [
            _measure(frames, pairs[i : i + _PAIRS_AT_ONCE], ways, deviation)
            for i in range(0, len(pairs), _PAIRS_AT_ONCE)
        ]
        for name in ways:
            out[duration, name] = {
                figure: Sums.pool(part[name][figure] for part in parts) for figure in FIGURES
            }
        done(1)
    return out


def blend_linearly(pairs: Pairs) -> Postures:
    """Blend hips and rotations linearly: what every method is measured beside."""
    return linear(pairs.start[:, None], pairs.end[:, None], joint_weights(pairs.weights))


def _measure(
    frames: Frames, pairs: Pairs, ways: Mapping[str, Method], deviation: Floats
) -> dict[str, dict[str, Sums]]:
    clips = len(frames.lengths)
    true_joints = pairs.truth.joints()
    written = write_postures(pairs.truth)
    collides = np.asarray(_colliding(pairs.truth).any(axis=1))
    planted = np.moveaxis(frames.contacts[pairs.rows], 1, 0)
    out = {}
    for name, blend in ways.items():
        postures = blend(pairs)
        joints = postures.joints()
        away = np.linalg.norm(joints - true_joints, axis=-1)
        ends = away[..., REFERENCE.indices(ENDS)].sum(axis=-1)
        values = {
            "mse": np.mean(((write_postures(postures) - written) / deviation) ** 2, axis=-1),
            "position_error_cm": 100.0 * away.mean(axis=-1),
            "end_effector_cm": 100.0 * ends,
            "sliding_c_cm_s": 100.0 * _sliding(joints, planted, frames.frame_rate),
            "collisions": np.where(collides[:, None], np.nan, _colliding(postures)),
        }
        out[name] = {figure: Sums.of(value, pairs, clips) for figure, value in values.items()}
    return out


def _sliding(joints: Floats, planted: Flags, rate: float) -> Floats:
    """Return the speed `(N, W)` of toes that the capture has planted, NaN where none is; m/s."""
    toes = REFERENCE.indices(CONTACT_JOINTS)[[1, 3]]
    speed = planar_speed(np.moveaxis(joints[:, :, toes], 1, 0), rate)
    slid = np.moveaxis(sliding_c(speed, planted[..., [1, 3]]), 0, 1)
    counted = ~np.isnan(slid)
    total = np.where(counted, slid, 0.0).sum(axis=-1)
    return np.where(counted.any(axis=-1), total / np.maximum(counted.sum(axis=-1), 1), np.nan)


def _colliding(postures: Postures) -> Flags:
    shape = postures.hips.shape[:-1]
    flat = Postures(postures.hips.reshape(-1, 3), postures.rotations.reshape(-1, len(REFERENCE), 4))
    return np.asarray(collisions(flat).any(axis=-1).reshape(shape))
