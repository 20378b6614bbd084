"""Pictures of gait: random windows as stick figures, figures against speed."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from gait_figures import ankle_separation, features, knee_angles, local_positions, smooth_jerk

from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import REFERENCE
from stridewire_models.gait.measuring import Steps, measure_steps

matplotlib.use("Agg")
from matplotlib import pyplot as plt

_SPEEDS = np.arange(0.4, 4.3, 0.4)
_CROSSED = -0.02


def random_windows(clips: Sequence[Clip], path: Path, count: int = 20) -> Path:
    """Draw windows of 0.6 s at random places, from the side and from the front."""
    rng = np.random.default_rng(7)
    moments = 8
    figure, axes = plt.subplots(count, 2 * moments, figsize=(16, 2.1 * count))
    for row in axes:
        clip = clips[int(rng.integers(len(clips)))]
        start = int(rng.integers(len(clip) - 36))
        _, local = local_positions(clip)
        for k in range(moments):
            joints = local[start + 5 * k]
            _stick(row[k], joints[:, 2], joints[:, 1])
            _stick(row[moments + k], -joints[:, 0], joints[:, 1])
        row[0].set_title(f"{clip.name} {start / 60.0:.1f} s", fontsize=8, loc="left")
    figure.subplots_adjust(0, 0, 1, 0.99, 0, 0.1)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=70)
    plt.close(figure)
    return path


def crossed(clips: Sequence[Clip]) -> float:
    """Return the share of frames whose left ankle is more than 2 cm right of the right one."""
    return float(np.mean(np.concatenate([ankle_separation(c) for c in clips]) < _CROSSED))


def against_speed(
    synthetic: Sequence[Clip], captured: Sequence[Clip], unseen: Sequence[Clip], path: Path
) -> list[tuple[str, str, str]]:
    """Draw four figures against speed; return each as text of synthetic and captured."""
    sets = {"synthetic": synthetic, "captured": captured, "unseen": unseen}
    curves = {name: _curves(clips) for name, clips in sets.items()}
    figure, axes = plt.subplots(1, 4, figsize=(17, 4))
    for axis, what in zip(axes, curves["synthetic"], strict=True):
        for name, of in curves.items():
            axis.plot(0.5 * (_SPEEDS[1:] + _SPEEDS[:-1]), of[what], "o-", label=name)
        axis.set_xlabel("speed, m/s")
        axis.set_title(what)
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    plt.close(figure)
    return [
        (what, _text(curves["synthetic"][what]), _text(curves["captured"][what]))
        for what in curves["synthetic"]
    ]


def _curves(clips: Sequence[Clip]) -> dict[str, Floats]:
    steps = [s for clip in clips if (s := measure_steps(clip, "")) is not None]
    speeds, cadences, lengths = np.concatenate([_steps(s) for s in steps]).T
    frames = [(features(clip).speed, clip) for clip in clips]
    return {
        "steps a second": _by_speed(speeds, cadences, np.median),
        "step length, m": _by_speed(speeds, lengths, np.median),
        "knee bend, 95 % of frames, deg": _framewise(frames, _largest_knee, _percentile_95),
        "jerk after 0.05 s, m/s^3": _framewise(frames, smooth_jerk, np.median),
    }


def _steps(steps: Steps) -> Floats:
    """Return speed, steps a second and length of each step."""
    rows = []
    for number in np.unique(steps.step):
        inside = steps.step == number
        speed, seconds = steps.speed[inside].mean(), inside.sum() / 60.0
        rows.append((speed, 1.0 / seconds, speed * seconds))
    return np.array(rows)


def _framewise(
    frames: Sequence[tuple[Floats, Clip]], of: Callable[[Clip], Floats], statistic: Any
) -> Floats:
    speeds = np.concatenate([speed for speed, _ in frames])
    values = np.concatenate([of(clip)[2:-2] for _, clip in frames])
    return _by_speed(speeds, values, statistic)


def _by_speed(speeds: Floats, values: Floats, statistic: Any) -> Floats:
    """Return the statistic in each band of speed; NaN below ten values."""
    bands = np.digitize(speeds, _SPEEDS) - 1
    inside = [values[bands == band] for band in range(len(_SPEEDS) - 1)]
    return np.array([statistic(v) if len(v) >= 10 else np.nan for v in inside])


def _largest_knee(clip: Clip) -> Floats:
    return np.asarray(knee_angles(clip).max(axis=1))


def _percentile_95(values: Floats) -> float:
    return float(np.percentile(values, 95))


def _stick(axis: Any, x: Floats, y: Floats) -> None:
    for joint, parent in enumerate(REFERENCE.parents[1:], start=1):
        name = REFERENCE.names[joint]
        colour = "C3" if name.startswith("Left") else "C0" if name.startswith("Right") else "k"
        axis.plot(x[[parent, joint]], y[[parent, joint]], colour, lw=1.6)
    axis.axhline(0.0, color="grey", lw=0.5)
    axis.set(xlim=(-0.75, 0.75), ylim=(-0.05, 1.8), aspect="equal")
    axis.axis("off")


def _text(values: Floats) -> str:
    return " ".join("-" if np.isnan(v) else f"{v:.3g}" for v in values)
