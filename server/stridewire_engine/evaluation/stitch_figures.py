"""Judging what hides seams: figures of pairs, against the take that they were made from.

Frames count from the first seam on. Figures are kept by take, so that intervals are over takes.
"""

from collections.abc import Callable, Iterator, Mapping

import numpy as np
from scipy.ndimage import gaussian_filter1d

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE
from stridewire_engine.evaluation import metrics
from stridewire_engine.evaluation.captured import KNEES, TOES
from stridewire_engine.evaluation.seam_methods import Method, truth
from stridewire_engine.evaluation.seams import Poses, Windows
from stridewire_engine.evaluation.tally import Mean
from stridewire_engine.networks.blend.features import to_six
from stridewire_engine.networks.rmr.pairs import PairMaker, Pairs
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.networks.rmr.takes import Takes

PATHS = ("source", "smoothed")
_SMOOTHING_FRAMES = 15.0
_AFTER_SEAM = 10
_STEP_PERCENT = 99.9
_AT_ONCE = 300
Figures = dict[str, Mean]


class Judge:
    """The same pairs of takes for every method."""

    def __init__(self, takes: Takes, stride: int, path: str = "source", seed: int = 0) -> None:
        """Make the pairs, none of the windows of mirrored copies.

        Args:
            takes: Of subjects that no network was trained on, with mirrored copies.
            stride: Frames from one window to the next.
            path: The take's own root path, or a `smoothed` one that says little of its steps.
            seed: Of the pairs.
        """
        self.takes = takes
        first = takes.windows(stride)
        first = first[takes.clip[first] < takes.originals]
        self.pairs = PairMaker(takes).make(first, np.random.default_rng(seed))
        self.clips, self._unit = np.unique(takes.clip[self.pairs.truth[:, 0]], return_inverse=True)
        self._path = takes.root, takes.yaw
        if path == "smoothed":
            self._path = _smoothed(takes)
        planted = takes.contacts[self.pairs.truth]
        toes = np.concatenate([self._world(w, truth(w))[:, :, _TOES, 1] for w in self.windows()])
        self._floor = float(np.percentile(toes[planted], 5.0))
        self._steps = self._step_limits()

    def windows(self) -> Iterator[Windows]:
        """Yield the pairs, some at a time."""
        for at in range(0, len(self.pairs), _AT_ONCE):
            some = self.pairs[at : at + _AT_ONCE]
            yield Windows(self.takes, some, *self._roots(some))

    def measure(self, method: Method, done: Callable[[int], None] = lambda n: None) -> Figures:
        """Return a method's figures.

        Args:
            method: To measure.
            done: Told of the pairs that are done.
        """
        parts: list[Mapping[str, tuple[Floats, Floats]]] = []
        for windows in self.windows():
            parts.append(self._measure(windows, method(windows)))
            done(len(windows))
        return {name: self._pool([part[name] for part in parts]) for name in parts[0]}

    def _measure(self, windows: Windows, made: Poses) -> Mapping[str, tuple[Floats, Floats]]:
        pairs = windows.pairs
        true = truth(windows)
        there, here = self._true_world(windows, true), self._world(windows, made)
        after = np.cumsum(pairs.starts, axis=1) > 0
        planted = np.moveaxis(self.takes.contacts[pairs.truth], 1, 0)
        in_time = np.moveaxis(here, 1, 0)
        toes = in_time[..., _TOES, :]
        speed = metrics.planar_speed(toes, FRAME_RATE)
        slid = metrics.sliding_c(speed, planted)
        height = toes[..., 1] - self._floor
        near = metrics.sliding_a(speed, height)
        away = np.linalg.norm(here - there, axis=-1)
        jerk = metrics.jerk(in_time, FRAME_RATE)
        since = np.arange(after.shape[1]) - pairs.seam
        soon = after & (since < _AFTER_SEAM)
        jumps = metrics.velocity_step(in_time, FRAME_RATE) > self._steps
        error = (written(made) - written(true)) ** 2
        return {
            "sliding_a_cm_s": _sum(100.0 * _back(near), after),
            "sliding_c_cm_s": _sum(100.0 * _back(slid), after),
            "float_cm": _sum(100.0 * _back(metrics.floating(height, planted)), after),
            "penetration_cm": _sum(100.0 * _back(metrics.penetration(height, planted)), after),
            "position_error_cm": _sum(100.0 * away, after),
            "foot_error_cm": _sum(100.0 * away[..., _FEET], after),
            "mse": _sum(error, after),
            "npss": _npss(made.rotations, true.rotations),
            "jump_pct": _sum(100.0 * _back(jumps), soon),
            "jerk": _sum(_back(jerk), after),
            "toe_jerk": _sum(_back(jerk)[..., _TOES], after),
            "knee_jerk": _sum(_back(jerk)[..., _KNEES], after),
        }

    def _pool(self, parts: list[tuple[Floats, Floats]]) -> Mean:
        total, weight = (np.concatenate([part[i] for part in parts]) for i in range(2))
        size = len(self.clips)
        sums = (np.bincount(self._unit, part, size) for part in (total, weight))
        return Mean(*(part.astype(np.float64) for part in sums))

    def _roots(self, pairs: Pairs) -> tuple[Vectors, Floats]:
        """Return the path that is shown, seen from the take's first root."""
        root, yaw = (part[pairs.truth] for part in self._path)
        first = pairs.truth[:, 0]
        origin, heading = self.takes.root[first], self.takes.yaw[first]
        back = quaternion.from_yaw(-heading)[:, None]
        moved = quaternion.rotate(
            np.broadcast_to(back, (*root.shape[:-1], 4)), root - origin[:, None]
        )
        return moved, yaw - heading[:, None]

    def _world(self, windows: Windows, made: Poses) -> Vectors:
        return _joints(windows.root, windows.yaw, made)

    def _true_world(self, windows: Windows, made: Poses) -> Vectors:
        return _joints(*self.takes.root_path(windows.pairs.truth), made)

    def _step_limits(self) -> Floats:
        steps = [
            metrics.velocity_step(
                np.moveaxis(self._true_world(windows, truth(windows)), 1, 0), FRAME_RATE
            )
            for windows in self.windows()
        ]
        return np.asarray(np.nanpercentile(np.concatenate(steps, axis=1), _STEP_PERCENT, (0, 1)))


_TOES = REFERENCE.indices(TOES)
_KNEES = REFERENCE.indices(KNEES)
_FEET = REFERENCE.indices(CONTACT_JOINTS)


def _joints(root: Vectors, yaw: Floats, poses: Poses) -> Vectors:
    pose = Pose(root, quaternion.from_yaw(yaw), poses.hips, poses.rotations)
    return kinematics.forward_world(REFERENCE, pose.astype(np.float64))[0]


def _back(values: Floats | Flags) -> Floats:
    """Put the windows first again."""
    return np.moveaxis(values.astype(np.float64), 0, 1)


def _sum(values: Floats, counted: Flags) -> tuple[Floats, Floats]:
    """Return sums and counts `(N,)` over frames that count; NaN does not."""
    shape = (*counted.shape, *(1,) * (values.ndim - 2))
    good = counted.reshape(shape) & ~np.isnan(values)
    axes = tuple(range(1, values.ndim))
    return np.where(good, values, 0.0).sum(axis=axes), good.sum(axis=axes).astype(np.float64)


def written(poses: Poses) -> Floats:
    """Return hips and two axes of each rotation `(N, T, 135)`."""
    six = to_six(poses.rotations)
    return np.concatenate([poses.hips, six.reshape(*six.shape[:2], -1)], axis=-1)


def _npss(made: Quaternions, true: Quaternions) -> tuple[Floats, Floats]:
    """Return sums and weights `(N,)` of the power spectrum's distance (Gopalakrishnan 2019)."""
    n = len(made)
    ours, theirs = (
        np.abs(np.fft.fft(q.reshape(n, q.shape[1], -1).astype(np.float64), axis=1)) ** 2
        for q in (_alike(made, true), true)
    )
    power = theirs.sum(axis=1)
    spread = [
        np.cumsum(p / np.maximum(p.sum(axis=1, keepdims=True), 1e-12), axis=1)
        for p in (ours, theirs)
    ]
    distance = np.abs(spread[0] - spread[1]).sum(axis=1)
    return (distance * power).sum(axis=1), power.sum(axis=1)


def _alike(made: Quaternions, true: Quaternions) -> Quaternions:
    """Choose signs as in the truth."""
    return np.where(np.sum(made * true, axis=-1, keepdims=True) < 0.0, -made, made)


def _smoothed(takes: Takes) -> tuple[Vectors, Floats]:
    root, yaw = takes.root.copy(), takes.yaw.copy()
    for start, length in zip(takes.starts, takes.lengths, strict=True):
        part = slice(start, start + length)
        root[part] = gaussian_filter1d(root[part], _SMOOTHING_FRAMES, axis=0, mode="nearest")
        yaw[part] = gaussian_filter1d(yaw[part], _SMOOTHING_FRAMES, mode="nearest")
    return root, yaw
