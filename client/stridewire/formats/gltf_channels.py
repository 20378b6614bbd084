"""Animation channels of glTF: keys of translations and rotations, sampled evenly."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.formats.gltf_arrays import ArrayReader
from stridewire.formats.source_motion import FormatError
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats

_WIDTHS = {"translation": 3, "rotation": 4}
_INTERPOLATIONS = ("LINEAR", "STEP", "CUBICSPLINE")
_SCALAR_FIRST = [3, 0, 1, 2]
_MOST_FRAMES = 500_000
_SLOWEST, _FASTEST = 1.0, 1000.0
_FALLBACK_RATE = 30.0
"""Where one key, or keys seconds apart, tell no rate."""


@dataclass(frozen=True)
class _Keys:
    times: Floats
    """`(K,)` seconds, rising."""
    values: Floats
    """`(K, width)`, for cubic splines `(K, 3, width)`: in-tangent, value, out-tangent."""
    interpolation: str


@dataclass(frozen=True)
class Channels:
    """The translations and rotations that an animation gives to nodes."""

    keys: dict[tuple[int, str], _Keys]
    times: Floats
    """`(T,)` even moments from the first to the last key; seconds."""
    frame_rate: float

    @classmethod
    def read(cls, path: Path, animation: Any, arrays: ArrayReader) -> "Channels":
        """Read an animation; scales and morph weights are left out.

        Raises:
            FormatError: If keys do not fit together or there are none.
        """
        keys = {}
        for channel in animation.channels:
            width = _WIDTHS.get(channel.target.path)
            if width is not None and channel.target.node is not None:
                sampler = animation.samplers[channel.sampler]
                keys[channel.target.node, channel.target.path] = _keys(path, sampler, width, arrays)
        if not keys:
            raise FormatError(path, "its animation moves nothing")
        start = min(float(k.times[0]) for k in keys.values())
        end = max(float(k.times[-1]) for k in keys.values())
        rate = _rate([k.times for k in keys.values()])
        frames = round((end - start) * rate) + 1
        if frames > _MOST_FRAMES:
            raise FormatError(path, f"{frames} frames; at most {_MOST_FRAMES} are read")
        return cls(keys, start + np.arange(frames) / rate, rate)

    @property
    def nodes(self) -> set[int]:
        """Indices of the nodes that move."""
        return {node for node, _ in self.keys}

    def sample(self, node: int, path: str, rest: Floats) -> Floats:
        """Return `(T, width)` what a node does, quaternions w, x, y, z; at rest without keys."""
        keys = self.keys.get((node, path))
        if keys is None:
            return np.tile(rest, (len(self.times), 1))
        values = _sample(keys, self.times)
        return quaternion.normalize(values) if path == "rotation" else values


def _keys(path: Path, sampler: Any, width: int, arrays: ArrayReader) -> _Keys:
    interpolation = sampler.interpolation or "LINEAR"
    if interpolation not in _INTERPOLATIONS:
        raise FormatError(path, f"interpolation {interpolation!r} of an animation's sampler")
    times = arrays.read(sampler.input, 1)[:, 0]
    values = arrays.read(sampler.output, width)
    parts = 3 if interpolation == "CUBICSPLINE" else 1
    if len(values) != parts * len(times) or np.any(np.diff(times) <= 0.0):
        raise FormatError(path, "an animation's keys do not fit together or run backwards")
    if width == 4:
        values = values[:, _SCALAR_FIRST]
    if parts == 3:
        values = values.reshape(len(times), 3, width)
    elif width == 4:
        values = quaternion.unroll(quaternion.normalize(values))
    return _Keys(times, values, interpolation)


def _rate(channels: list[Floats]) -> float:
    """Return the frame rate of the densest channel, rounded to what float32 times can tell."""
    densest = max(channels, key=len)
    if len(densest) < 2:
        return _FALLBACK_RATE
    rate = 1.0 / float(np.median(np.diff(densest)))
    even = (len(densest) - 1) / float(densest[-1] - densest[0])
    rate = even if abs(rate - even) < 0.01 * even else rate
    return round(rate, 2) if _SLOWEST <= rate <= _FASTEST else _FALLBACK_RATE


def _sample(keys: _Keys, times: Floats) -> Floats:
    """Return `(T, width)`; before the first and after the last key the nearest holds."""
    last = len(keys.times) - 1
    before = np.clip(np.searchsorted(keys.times, times + 1e-6, side="right") - 1, 0, last)
    after = np.minimum(before + 1, last)
    span = np.maximum(keys.times[after] - keys.times[before], 1e-9)
    weight = np.clip((times - keys.times[before]) / span, 0.0, 1.0)
    if keys.interpolation == "CUBICSPLINE":
        return _cubic(keys.values, before, after, weight[:, None], span[:, None])
    if keys.interpolation == "STEP":
        return keys.values[before]
    a, b = keys.values[before], keys.values[after]
    if a.shape[1] == 4:
        return quaternion.slerp(a, b, weight)
    return np.asarray(a + weight[:, None] * (b - a))


def _cubic(values: Floats, before: Any, after: Any, t: Floats, span: Floats) -> Floats:
    """Return the Hermite spline of glTF 2.0, appendix C."""
    start, leaving = values[before, 1], values[before, 2]
    arriving, end = values[after, 0], values[after, 1]
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * start
        + span * (t**3 - 2 * t**2 + t) * leaving
        + (-2 * t**3 + 3 * t**2) * end
        + span * (t**3 - t**2) * arriving
    )
