"""Arbitrary motions and empty states for the stitchers' tests."""

from dataclasses import fields

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.stitchers import Motion, Roots, Sample, StitchState
from stridewire_engine.stitchers.legs import Legs

N, J = 5, len(REFERENCE)
ROOTS = Roots(np.zeros((N, 3)), np.zeros(N))


def empty(dtype: type = np.float64) -> StitchState:
    """Return a state without offsets, in float64 by default so that rates can be measured."""
    rows = Characters.allocate(N, J, 1)
    arrays = {f.name: getattr(rows, f.name) for f in fields(StitchState)}
    keep = {name for name, array in arrays.items() if array.dtype == np.float64}
    return StitchState(**{n: a if n in keep else a.astype(dtype) for n, a in arrays.items()})


def random_motion(
    rng: np.random.Generator, spread: float = 0.5, dtype: type = np.float64
) -> Motion:
    """Return arbitrary poses and rates."""
    arrays = (
        rng.normal(size=(N, 3)),
        quaternion.from_scaled_axis(rng.normal(scale=spread, size=(N, J, 3))),
        rng.normal(size=(N, 3)),
        rng.normal(size=(N, J, 3)),
        rng.normal(size=(N, 2, 3)),
        rng.normal(size=(N, 2, 3)),
    )
    return Motion(*(array.astype(dtype) for array in arrays))


def sample_of(motion: Motion) -> Sample:
    """Return the motion's pose under roots at the origin, feet in the air."""
    return Sample(
        motion.hips,
        motion.rotations,
        np.zeros((N, 2), bool),
        ROOTS,
        np.zeros(N, bool),
        Legs.of(REFERENCE),
        None,
    )


def advance(motion: Motion, dt: float) -> Motion:
    """Go on along the motion's rates."""
    turned = quaternion.multiply(
        quaternion.from_scaled_axis(motion.angular_velocity * dt), motion.rotations
    )
    return motion._replace(hips=motion.hips + motion.hips_velocity * dt, rotations=turned)


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the rotation vectors from b to a."""
    return quaternion.to_scaled_axis(quaternion.multiply(a, quaternion.conjugate(b)))
