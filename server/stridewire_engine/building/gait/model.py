"""The gait model: how bodies move at each phase, at any speed, turning and acceleration.

`x(phase, v, c, a) = sum over r in (1, u, u^2, c, a) and k in 0 ... 4 of r (p_rk cos 2 pi k phase +
q_rk sin 2 pi k phase)`, u the speed off the centre, c the sideways acceleration of a turn, a that
ahead; one set of coefficients for walking and one for running, fitted on captured steps. The
channels x are rotation vectors of all joints relative to a mean pose, and the positions of hips,
ankles and toes relative to the path of travel: these average well, and legs bent to averaged feet
keep the knees of people. Persons and moments are drawn from the principal components of what the
regression leaves over.
"""

import io
import zipfile
from dataclasses import dataclass
from importlib.resources import files
from typing import IO

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE

ENDS = ("Hips", "LeftFoot", "LeftToe", "RightFoot", "RightToe")
"""Joints whose positions are channels."""

JOINTS = len(REFERENCE)
CHANNELS = 3 * JOINTS + 3 * len(ENDS)
HARMONICS = 4
PERSON_HARMONICS = 2
GAITS = ("walk", "run")
_SHARPEST = 1.0


class GaitModelError(ValueError):
    """The coefficients are not of this model; the message says what is wrong."""


@dataclass(frozen=True)
class Gait:
    """Coefficients of walking or of running."""

    centre: float
    """Speed about which it was fitted; m/s."""
    slowest: float
    """Lower end of the speeds it was fitted on; m/s."""
    fastest: float
    """Upper end; m/s."""
    coefficients: Floats
    """`(5 * 9, C)` regressor-major: see `design`."""
    cadence: Floats
    """`(4,)` cycles per second: constant, u, u^2, w^2."""
    persons: Floats
    """`(P, 5, C)` deviations of a person, one deviation in size, over harmonics 0 to 2."""
    moments: Floats
    """`(M, C)` deviations of a moment, one deviation in size."""

    def cadence_at(self, speed: Floats, turn: Floats) -> Floats:
        """Return cycles a second `(T,)` at speeds `(T,)` m/s and turning rates `(T,)` rad/s."""
        u = np.clip(speed, self.slowest, self.fastest) - self.centre
        turn = np.minimum(np.abs(turn), _SHARPEST)
        return np.asarray(self.cadence @ np.stack([np.ones_like(u), u, u * u, turn * turn]))


@dataclass(frozen=True)
class GaitModel:
    """Coefficients of both gaits."""

    base: Quaternions
    """`(22, 4)` mean local rotations, which the rotation channels are relative to."""
    walk: Gait
    run: Gait
    standing: Floats
    """`(C,)` channels of standing still."""

    def save(self, file: IO[bytes]) -> None:
        """Write the coefficients as a compressed npz in half precision."""
        arrays = {"base": self.base.astype(np.float32), "standing": _half(self.standing)}
        for name in GAITS:
            gait: Gait = getattr(self, name)
            arrays |= {
                f"{name}_speeds": np.array([gait.centre, gait.slowest, gait.fastest], np.float32),
                f"{name}_coefficients": _half(gait.coefficients),
                f"{name}_cadence": gait.cadence.astype(np.float32),
                f"{name}_persons": _half(gait.persons),
                f"{name}_moments": _half(gait.moments),
            }
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, array in arrays.items():
                # a fixed date, so that equal coefficients are equal bytes
                with archive.open(zipfile.ZipInfo(f"{name}.npy"), "w") as entry:
                    np.lib.format.write_array(entry, array, allow_pickle=False)

    @staticmethod
    def shipped() -> "GaitModel":
        """Read the coefficients that come with the package."""
        return GaitModel.load(io.BytesIO(gait_coefficients()))

    @staticmethod
    def load(file: IO[bytes]) -> "GaitModel":
        """Read what `save` wrote.

        Raises:
            GaitModelError: If an array is missing or has another shape.
        """
        with np.load(file, allow_pickle=False) as data:
            arrays = {name: data[name].astype(np.float64) for name in data.files}
        try:
            return GaitModel(
                base=_shaped(arrays, "base", JOINTS, 4),
                walk=_gait(arrays, "walk"),
                run=_gait(arrays, "run"),
                standing=_shaped(arrays, "standing", CHANNELS),
            )
        except KeyError as missing:
            raise GaitModelError(
                f"the gait model lacks the array {missing}; fit it again: `stridewire train gait`"
            ) from None


def gait_coefficients() -> bytes:
    """Return the file of coefficients that comes with the package."""
    return (files("stridewire_models.weights") / "gait.npz").read_bytes()


def encode(rotations: Quaternions, positions: Vectors, base: Quaternions) -> Floats:
    """Return the channels `(T, C)` of poses.

    Args:
        rotations: `(T, 22, 4)` local, the hips' relative to the heading of travel.
        positions: `(T, 5, 3)` of `ENDS`, relative to the path of travel.
        base: `(22, 4)`.
    """
    vectors = quaternion.to_scaled_axis(quaternion.multiply(quaternion.conjugate(base), rotations))
    return np.concatenate(
        [vectors.reshape(len(vectors), -1), positions.reshape(len(vectors), -1)], axis=1
    )


def decode(channels: Floats, base: Quaternions) -> tuple[Quaternions, Vectors]:
    """Return rotations `(T, 22, 4)` and positions `(T, 5, 3)`: `encode` undone."""
    vectors = channels[:, : 3 * JOINTS].reshape(-1, JOINTS, 3)
    rotations = quaternion.multiply(base, quaternion.from_scaled_axis(vectors))
    return rotations, channels[:, 3 * JOINTS :].reshape(-1, len(ENDS), 3)


def harmonics(phase: Floats, count: int) -> Floats:
    """Return `(T, 1 + 2 count)`: 1, then cosine and sine of each multiple of the phase."""
    angles = 2.0 * np.pi * phase[:, None] * np.arange(1, count + 1)
    waves = np.stack([np.cos(angles), np.sin(angles)], axis=-1).reshape(len(phase), -1)
    return np.concatenate([np.ones((len(phase), 1)), waves], axis=1)


def design(phase: Floats, speed: Floats, sideways: Floats, acceleration: Floats) -> Floats:
    """Return the regression's rows `(T, 45)`: regressors 1, u, u^2, c, a times harmonics.

    Args:
        phase: `(T,)`.
        speed: `(T,)` off the gait's centre, m/s.
        sideways: `(T,)` to the left, speed times turning rate, m/s^2.
        acceleration: `(T,)` forward, m/s^2.
    """
    regressors = np.stack([np.ones_like(speed), speed, speed**2, sideways, acceleration], axis=-1)
    waves = harmonics(phase, HARMONICS)
    return np.asarray((regressors[:, :, None] * waves[:, None, :]).reshape(len(phase), -1))


def _half(values: Floats) -> Floats:
    return values.astype(np.float16)


def _gait(arrays: dict[str, Floats], name: str) -> Gait:
    centre, slowest, fastest = _shaped(arrays, f"{name}_speeds", 3)
    return Gait(
        centre=float(centre),
        slowest=float(slowest),
        fastest=float(fastest),
        coefficients=_shaped(arrays, f"{name}_coefficients", 5 * (1 + 2 * HARMONICS), CHANNELS),
        cadence=_shaped(arrays, f"{name}_cadence", 4),
        persons=_shaped(arrays, f"{name}_persons", -1, 1 + 2 * PERSON_HARMONICS, CHANNELS),
        moments=_shaped(arrays, f"{name}_moments", -1, CHANNELS),
    )


def _shaped(arrays: dict[str, Floats], name: str, *shape: int) -> Floats:
    """Return an array after a look at its shape; -1 fits any length."""
    array = arrays[name]
    fits = array.ndim == len(shape) and all(
        s in (-1, n) for s, n in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise GaitModelError(
            f"the gait model's {name} has shape {array.shape}; expected {shape}: fit it again with "
            "`stridewire train gait`"
        )
    return array
