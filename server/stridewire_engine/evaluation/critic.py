"""The critic: a classifier that tries to tell seams from captured motion.

Windows of half a second, root-local positions, velocities and accelerations of the joints; trained
on other people than it is quoted on. An AUC of 0.5 means that it cannot tell. Intervals draw whole
takes, since windows of one take are much alike.
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
_MOST_WINDOWS = 2000
_COMPONENTS, _TREES = 60, 80
_QUIET_FRAMES = 10
_DRAWS = 500
_KINDS = 9
"""Features of a joint at a time: position, velocity, acceleration."""
LEAST_WINDOWS = 100
"""Fewer of a kind are not judged."""
LEGS = ("UpLeg", "Leg", "Foot", "Toe")
"""Endings of the names of the joints of the legs, for a critic that sees no others."""


class Windows(NamedTuple):
    """Where windows begin."""

    frame: Indices
    character: Indices


class Sample(NamedTuple):
    """W windows of one kind of motion."""

    features: Floats
    """`(W, D)`."""
    takes: Indices
    """`(W,)` number of the take that each is of."""


@dataclass(frozen=True)
class Verdict:
    """How well the critic tells a way of making motion from captured motion."""

    auc: float
    low: float
    high: float
    surest: Indices
    """The windows to be told, by how sure it is of them, the surest first."""


def seam_windows(stream: Stream) -> Windows:
    """Return the windows with a transition in their middle."""
    begin = stream.seams.frame - WINDOW // 2
    inside = (begin >= 0) & (begin + WINDOW <= len(stream.rows))
    return Windows(begin[inside], stream.seams.character[inside])


def quiet_windows(stream: Stream) -> Windows:
    """Return windows without a transition, the last one at least ten frames before them."""
    # so long before the last frame of a window no transition has come
    whole = stream.since[WINDOW - 1 :: WINDOW] >= WINDOW - 1 + _QUIET_FRAMES
    frame, character = np.nonzero(whole)
    return Windows(frame * WINDOW, character)


def stream_sample(stream: Stream, captured: Captured, windows: Windows) -> Sample:
    """Return windows of a stream; their take is that of the clip in their middle."""
    frames = windows.frame[:, None] + np.arange(WINDOW)
    who = windows.character[:, None]
    features = _features(
        stream.positions[frames, who],
        stream.pose.root_position[frames, who],
        stream.pose.root_rotation[frames, who],
    )
    middle = stream.rows[windows.frame + WINDOW // 2, windows.character]
    return Sample(features, takes_of(captured, middle))


def captured_sample(captured: Captured, rows: Indices) -> Sample:
    """Return the captured windows that begin at rows, clip by clip."""
    library = captured.library
    last = (library.clip_starts + library.clip_frames)[library.clip_of[rows]]
    rows = rows[rows + WINDOW <= last]
    frames = rows[:, None] + np.arange(WINDOW)
    features = _features(
        captured.positions[frames].astype(np.float64),
        library.root_position[frames].astype(np.float64),
        quaternion.from_yaw(library.root_yaw[frames].astype(np.float64)),
    )
    return Sample(features, takes_of(captured, rows))


def takes_of(captured: Captured, rows: Indices) -> Indices:
    """Return the take of rows: clips of one source, mirrored copies among them, are one take."""
    names = [clip.source for clip in captured.library.clips]
    _, numbers = np.unique(names, return_inverse=True)
    return np.asarray(numbers[captured.library.clip_of[rows]])


def columns_of(captured: Captured, parts: Sequence[str]) -> Indices:
    """Return the features of the joints whose names end in one of some words."""
    joints = captured.library.skeleton.names
    chosen = np.flatnonzero([name.endswith(tuple(parts)) for name in joints])
    every = np.arange(dimensions(captured)).reshape(-1, len(joints), _KINDS)
    return np.asarray(every[:, chosen].reshape(-1))


def dimensions(captured: Captured) -> int:
    """Return the number of features of a window."""
    return len(range(0, WINDOW, _STRIDE)) * len(captured.library.skeleton) * _KINDS


def judge(
    positive_train: Sample,
    negative_train: Sample,
    positive: Sample,
    negative: Sample,
    *,
    seed: int = 0,
) -> Verdict:
    """Train on one pair of samples and quote on another.

    Args:
        positive_train: Windows to be told, of training people.
        negative_train: Captured windows of training people.
        positive: Windows to be told, of test people.
        negative: Captured windows of test people.
        seed: Of the classifier and the bootstrap.

    Raises:
        ModuleNotFoundError: If scikit-learn is missing; it is in the extra `evaluate`.
    """
    from sklearn.decomposition import PCA
    from sklearn.ensemble import HistGradientBoostingClassifier
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from threadpoolctl import threadpool_limits

    rng = np.random.default_rng(seed)
    parts = [thinned(part, rng).features for part in (positive_train, negative_train)]
    labels = np.repeat([1, 0], [len(part) for part in parts])
    components = min(_COMPONENTS, *np.concatenate(parts).shape)
    model = make_pipeline(
        StandardScaler(),
        PCA(components, svd_solver="randomized", random_state=seed),
        HistGradientBoostingClassifier(
            max_iter=_TREES, l2_regularization=1.0, class_weight="balanced", random_state=seed
        ),
    )
    # a second thread waits for the first by spinning, which on a busy machine costs minutes
    with threadpool_limits(1):
        model.fit(np.concatenate(parts), labels)
        scores = [model.predict_proba(part.features)[:, 1] for part in (positive, negative)]
    low, high = _interval(scores, (positive.takes, negative.takes), rng)
    return Verdict(_auc(*scores), low, high, np.argsort(-scores[0]))


def _interval(
    scores: Sequence[Floats], takes: Sequence[Indices], rng: np.random.Generator
) -> tuple[float, float]:
    """Return the 95 % bootstrap interval of an AUC; takes are drawn, not windows."""
    drawn = []
    for _ in range(_DRAWS):
        parts = []
        for score, take in zip(scores, takes, strict=True):
            names, number = np.unique(take, return_inverse=True)
            times = rng.multinomial(len(names), np.full(len(names), 1.0 / len(names)))
            parts.append(np.repeat(score, times[number]))
        drawn.append(_auc(*parts))
    low, high = np.percentile(drawn, (2.5, 97.5))
    return float(low), float(high)


def _auc(positive: Floats, negative: Floats) -> float:
    """Return how often a positive one scores above a negative one, ties as halves."""
    ordered = np.sort(negative)
    below = np.searchsorted(ordered, positive, "left")
    not_above = np.searchsorted(ordered, positive, "right")
    return float((below + not_above).mean() / (2.0 * len(negative)))


def _features(positions: Vectors, root: Vectors, turn: Quaternions) -> Floats:
    """Return root-local positions, velocities and accelerations, `(W, D)` float32."""
    back = quaternion.conjugate(turn)[:, :, None]
    local = quaternion.rotate(back, positions - root[:, :, None])
    velocity = np.gradient(local, axis=1) * RATE
    acceleration = np.gradient(velocity, axis=1) * RATE
    parts = [part[:, ::_STRIDE] for part in (local, velocity, acceleration)]
    flat = np.concatenate(parts, axis=-1).astype(np.float32)
    return flat.reshape(len(local), int(np.prod(flat.shape[1:])))


def thinned(sample: Sample, rng: np.random.Generator) -> Sample:
    """Return at most so many windows that a classifier is trained within seconds."""
    count = len(sample.takes)
    if count <= _MOST_WINDOWS:
        return sample
    kept = np.sort(rng.choice(count, _MOST_WINDOWS, replace=False))
    return Sample(sample.features[kept], sample.takes[kept])


def joined(parts: Sequence[Sample]) -> Sample:
    """Join windows of several streams."""
    return Sample(*(np.concatenate(part) for part in zip(*parts, strict=True)))
