"""The critic: a classifier that tries to tell seams from captured motion.

Windows of half a second, root-local positions, velocities and accelerations of the joints; trained
on other people than it is quoted on. An AUC of 0.5 means that it cannot tell.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Indices, Quaternions, Vectors
from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.streaming import RATE, Stream

WINDOW = 30
_STRIDE = 3
"""Every third frame of a window is a feature."""
_MOST_WINDOWS = 3000
_COMPONENTS, _TREES = 60, 80
_QUIET_FRAMES = 60


class Windows(NamedTuple):
    """Where windows begin."""

    frame: Indices
    character: Indices


@dataclass(frozen=True)
class Verdict:
    """How well the critic tells a way of making motion from captured motion."""

    auc: float
    low: float
    high: float
    surest: Windows
    """The windows that it is surest about, the surest first."""


def seam_windows(stream: Stream) -> Windows:
    """Return the windows with a transition in their middle."""
    begin = stream.seams.frame - WINDOW // 2
    inside = (begin >= 0) & (begin + WINDOW <= len(stream.rows))
    return Windows(begin[inside], stream.seams.character[inside])


def quiet_windows(stream: Stream) -> Windows:
    """Return windows whose whole length lies a second or more behind a transition."""
    quiet = stream.since >= _QUIET_FRAMES
    length = len(quiet) - WINDOW
    whole = quiet[:length] & quiet[WINDOW - 1 : WINDOW - 1 + length]
    frame, character = np.nonzero(whole[::WINDOW])
    return Windows(frame * WINDOW, character)


def stream_features(stream: Stream, windows: Windows) -> Floats:
    """Return features `(W, D)` of windows of a stream."""
    frames = windows.frame[:, None] + np.arange(WINDOW)
    who = windows.character[:, None]
    return _features(
        stream.positions[frames, who],
        stream.pose.root_position[frames, who],
        stream.pose.root_rotation[frames, who],
    )


def captured_features(captured: Captured, rows: Indices) -> Floats:
    """Return features `(W, D)` of the captured windows that begin at rows, clip by clip."""
    library = captured.library
    last = (library.clip_starts + library.clip_frames)[library.clip_of[rows]]
    rows = rows[rows + WINDOW <= last]
    frames = rows[:, None] + np.arange(WINDOW)
    return _features(
        captured.positions[frames].astype(np.float64),
        library.root_position[frames].astype(np.float64),
        quaternion.from_yaw(library.root_yaw[frames].astype(np.float64)),
    )


def judge(
    seams_train: Floats,
    captured_train: Floats,
    seams: Floats,
    captured: Floats,
    windows: Windows,
    seed: int = 0,
) -> Verdict:
    """Train on one pair of sets and quote on another.

    Args:
        seams_train: `(W, D)` windows around transitions, of training subjects.
        captured_train: `(W, D)` captured windows of training subjects.
        seams: `(W, D)` of test subjects.
        captured: `(W, D)` of test subjects.
        windows: Of `seams`.
        seed: Of the classifier and the bootstrap.

    Raises:
        ModuleNotFoundError: If scikit-learn is missing; it is in the extra `evaluate`.
    """
    from sklearn.decomposition import PCA
    from sklearn.ensemble import HistGradientBoostingClassifier
    from sklearn.metrics import roc_auc_score
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    rng = np.random.default_rng(seed)
    parts = [_thinned(part, rng) for part in (seams_train, captured_train)]
    labels = np.repeat([1, 0], [len(part) for part in parts])
    model = make_pipeline(
        StandardScaler(),
        PCA(_COMPONENTS, random_state=seed),
        HistGradientBoostingClassifier(
            max_iter=_TREES, l2_regularization=1.0, class_weight="balanced", random_state=seed
        ),
    )
    model.fit(np.concatenate(parts), labels)
    positive, negative = (model.predict_proba(part)[:, 1] for part in (seams, captured))
    drawn = []
    for _ in range(200):
        a, b = rng.choice(positive, len(positive)), rng.choice(negative, len(negative))
        drawn.append(_auc(roc_auc_score, a, b))
    order = np.argsort(-positive)
    low, high = np.percentile(drawn, (2.5, 97.5))
    return Verdict(
        _auc(roc_auc_score, positive, negative),
        float(low),
        float(high),
        Windows(windows.frame[order], windows.character[order]),
    )


def _auc(score: object, positive: Floats, negative: Floats) -> float:
    assert callable(score)
    labels = np.repeat([1, 0], [len(positive), len(negative)])
    return float(score(labels, np.concatenate([positive, negative])))


def _features(positions: Vectors, root: Vectors, turn: Quaternions) -> Floats:
    """Return root-local positions, velocities and accelerations, `(W, D)` float32."""
    back = quaternion.conjugate(turn)[:, :, None]
    local = quaternion.rotate(back, positions - root[:, :, None])
    velocity = np.gradient(local, axis=1) * RATE
    acceleration = np.gradient(velocity, axis=1) * RATE
    parts = [part[:, ::_STRIDE] for part in (local, velocity, acceleration)]
    flat = np.concatenate(parts, axis=-1).astype(np.float32)
    return flat.reshape(len(local), int(np.prod(flat.shape[1:])))


def _thinned(features: Floats, rng: np.random.Generator) -> Floats:
    if len(features) <= _MOST_WINDOWS:
        return features
    return features[np.sort(rng.choice(len(features), _MOST_WINDOWS, replace=False))]


def joined(parts: Sequence[Floats]) -> Floats:
    """Join features of several streams."""
    return np.concatenate(list(parts))
