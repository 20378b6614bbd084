"""Fitting: from captured steps to the coefficients of the gait model."""

from collections.abc import Sequence

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions
from stridewire_engine.building.gait.model import (
    HARMONICS,
    PERSON_HARMONICS,
    Gait,
    GaitModel,
    design,
    encode,
    harmonics,
)
from stridewire_models.gait.measuring import Standing, Steps

_CENTRES = {"walk": 1.2, "run": 3.2}
_SPEEDS = {"walk": (0.4, 2.0), "run": (2.0, 4.5)}
_RIDGE = 2e-3
_SUBJECT_RIDGE = 1e-2
_PERSONS = 8
_MOMENTS = 10


def fit(steps: Sequence[Steps], standing: Sequence[Standing]) -> GaitModel:
    """Fit the model.

    Args:
        steps: Of all training clips and their mirrored copies, so that the model is symmetric.
        standing: Clips that stand still, mirrored ones too.
    """
    base = mean_rotations(np.concatenate([s.rotations for s in steps]))
    walk, run = (_fit_gait(_select(steps, name == "run"), name, base) for name in ("walk", "run"))
    return GaitModel(base, walk, run, _standing(standing, base))


def mean_rotations(rotations: Quaternions) -> Quaternions:
    """Return the mean `(J, 4)` of rotations `(N, J, 4)`: the chief axis of their outer products."""
    outer = np.einsum("nja,njb->jab", rotations, rotations)
    _, axes = np.linalg.eigh(outer)
    return quaternion.absolute(axes[..., -1])


def gait_design(gait_name: str, steps: Steps) -> Floats:
    """Return the regression's rows `(N, 45)` of a clip's steps."""
    return design(
        steps.phase,
        steps.speed - _CENTRES[gait_name],
        steps.speed * steps.turn,
        steps.acceleration,
    )


def _select(steps: Sequence[Steps], run: bool) -> list[Steps]:
    chosen = (_where(s, s.run == run) for s in steps)
    return [s for s in chosen if len(s.frames)]


def _where(steps: Steps, flags: Flags) -> Steps:
    return Steps(
        steps.subject,
        steps.take,
        *(
            getattr(steps, field)[flags]
            for field in (
                "frames", "phase", "speed", "turn", "acceleration", "run", "step",
                "rotations", "positions",
            )
        ),
    )  # fmt: skip


def _fit_gait(steps: list[Steps], name: str, base: Quaternions) -> Gait:
    subjects = sorted({s.subject for s in steps})
    owner = np.concatenate([np.full(len(s.frames), subjects.index(s.subject)) for s in steps])
    weight = 1.0 / np.sqrt(np.bincount(owner))[owner]
    rows = np.concatenate([gait_design(name, s) for s in steps])
    own = np.concatenate([harmonics(s.phase, PERSON_HARMONICS) for s in steps])
    channels = np.concatenate([encode(s.rotations, s.positions, base) for s in steps])
    offsets = own[:, None, :] * (owner[:, None] == np.arange(len(subjects)))[:, :, None]
    both = np.concatenate([rows, offsets.reshape(len(rows), -1)], axis=1)
    order = np.concatenate([[0], np.repeat(np.arange(1, HARMONICS + 1), 2)])
    ridge = np.concatenate(
        [np.tile(_RIDGE * order**2.0, 5) + 1e-5, np.full(offsets[0].size, _SUBJECT_RIDGE)]
    )
    solution = _ridge(both, channels, weight, ridge)
    coefficients = solution[: rows.shape[1]]
    left = channels - rows @ coefficients
    persons, moments = _deviations(steps, own, left)
    slowest, fastest = _SPEEDS[name]
    cadence = _fit_cadence(steps, name)
    return Gait(_CENTRES[name], slowest, fastest, coefficients, cadence, persons, moments)


def _ridge(rows: Floats, values: Floats, weight: Floats, ridge: Floats) -> Floats:
    """Solve weighted least squares; `ridge` is in parts of the sum of the weights."""
    weighted = rows * weight[:, None]
    return np.linalg.solve(rows.T @ weighted + np.diag(ridge * weight.sum()), weighted.T @ values)


def _deviations(steps: list[Steps], own: Floats, left: Floats) -> tuple[Floats, Floats]:
    """Split what is left over into persons `(P, 5, C)` and moments `(M, C)`."""
    takes, rest, start = [], left.copy(), 0
    for s in steps:
        span = slice(start, start := start + len(s.frames))
        ridge = np.full(own.shape[1], 0.02)
        curve = _ridge(own[span], left[span], np.ones(len(s.frames)), ridge)
        rest[span] -= own[span] @ curve
        takes.append(curve.ravel())
    persons = _principal(np.array(takes), _PERSONS)
    return persons.reshape(len(persons), own.shape[1], -1), _principal(rest, _MOMENTS)


def _principal(rows: Floats, count: int) -> Floats:
    """Return principal components `(count, C)` of rows `(N, C)`, each one deviation long."""
    _, sizes, axes = np.linalg.svd(rows - rows.mean(axis=0), full_matrices=False)
    return np.asarray(axes[:count] * sizes[:count, None] / np.sqrt(len(rows)))


def _fit_cadence(steps: list[Steps], name: str) -> Floats:
    """Fit cycles per second on 1, u, u^2, w^2, with an offset for each subject."""
    rows, values, owner = [], [], []
    subjects = sorted({s.subject for s in steps})
    for s in steps:
        for number in np.unique(s.step):
            inside = s.step == number
            u, w = s.speed[inside].mean() - _CENTRES[name], s.turn[inside].mean()
            rows.append([1.0, u, u * u, w * w])
            values.append(0.5 * 60.0 / inside.sum())
            owner.append(subjects.index(s.subject))
    own = np.array(owner)[:, None] == np.arange(len(subjects))
    weight = 1.0 / np.sqrt(np.bincount(owner))[owner]
    ridge = np.concatenate([[1e-6, 1e-4, 0.2, 1e-3], np.full(len(subjects), 0.02)])
    solution = _ridge(np.column_stack([rows, own]), np.array(values)[:, None], weight, ridge)
    return np.asarray(solution[:4, 0])


def _standing(standing: Sequence[Standing], base: Quaternions) -> Floats:
    """Average standing poses over the subjects, each counting once."""
    channels = [encode(s.rotations, s.positions, base).mean(axis=0) for s in standing]
    subjects = [s.subject for s in standing]
    means = [
        np.mean(
            [c for c, owner in zip(channels, subjects, strict=True) if owner == subject], axis=0
        )
        for subject in sorted(set(subjects))
    ]
    return np.asarray(np.mean(means, axis=0))
