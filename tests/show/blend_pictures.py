"""Contact sheets of blends: what was captured, the network, the linear blend, at five weights."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from stridewire._messages import BlendMethod
from stridewire.drawing.camera import Camera
from stridewire.drawing.stick_figure import draw_moment
from stridewire.drawing.subject import Subject
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.kinematics import forward_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.blending import Pair, blend
from stridewire_engine.building.importing import import_file
from stridewire_engine.networks.blend import blend_network

WEIGHTS = np.linspace(0.0, 1.0, 5)
DURATION = 1.0
_RATE = 4.0
"""Slow enough that a figure has no shadow of the one before."""


def draw(data: Path, folder: Path) -> Iterator[Path]:
    """Draw the paper's kinds of pairs, of subjects that the network never saw.

    Nobody of them brings a knee to an elbow standing; where these are nearest is a jump.

    Args:
        data: Folder with `cmu/`.
        folder: Where the pictures go.
    """
    folder.mkdir(parents=True, exist_ok=True)
    walk = _clip(data / "cmu" / "08" / "08_01.bvh")
    backward = _clip(data / "cmu" / "06" / "06_06.bvh")
    actions = _clip(data / "cmu" / "86" / "86_01.amc")
    for name, clip, start_s in (
        ("walk", walk, 0.5 * walk.seconds - 0.5),
        ("backward-dribble", backward, 0.5 * backward.seconds - 0.5),
        ("jump", actions, _highest_knee(actions) - 0.5 * DURATION),
    ):
        path = folder / f"blend-{name}.png"
        _sheet(clip, start_s, path)
        yield path


def _clip(path: Path) -> Clip:
    clip = import_file(path).clip
    assert clip is not None
    return clip


def _highest_knee(clip: Clip) -> float:
    """Return when an elbow and the other side's knee are nearest, seconds."""
    margin = round(DURATION * clip.frame_rate)
    positions = forward_world(REFERENCE, clip.pose)[0][margin:-margin]
    pairs = (("LeftForeArm", "RightLeg"), ("RightForeArm", "LeftLeg"))
    away = [
        np.linalg.norm(
            positions[:, REFERENCE.index(elbow)] - positions[:, REFERENCE.index(knee)], axis=-1
        )
        for elbow, knee in pairs
    ]
    return float((np.min(away, axis=0).argmin() + margin) / clip.frame_rate)


def _sheet(clip: Clip, start_s: float, path: Path) -> None:
    truth = clip.sample(start_s + WEIGHTS * DURATION)
    pair = Pair(
        clip.sample(start_s),
        clip.sample(start_s + DURATION),
        WEIGHTS,
        np.ones(len(REFERENCE)),
        duration=DURATION,
    )
    linear = Pair(pair.start, pair.end, WEIGHTS, pair.shares, BlendMethod.SLERP)
    by_network, by_slerp = (blend([p], blend_network())[0].pose for p in (pair, linear))
    figure = Figure(figsize=(9.0, 6.6), facecolor="white")
    FigureCanvasAgg(figure)
    for row, (label, pose) in enumerate(
        (("captured", truth), ("network", by_network), ("linear", by_slerp))
    ):
        subject = _subject(pose)
        camera = Camera.beside(_subject(truth))
        for column, weight in enumerate(WEIGHTS):
            axes = figure.add_axes((0.2 * column, 0.98 - 0.325 * (row + 1), 0.2, 0.31))
            draw_moment(axes, subject, camera, column)
            axes.set_title(f"{label}, {weight:g}", fontsize=9)
    figure.savefig(path, dpi=90)


def _subject(pose: Pose) -> Subject:
    nowhere = np.zeros((len(WEIGHTS), 4), np.bool_)
    clip = Clip("blend", REFERENCE, _RATE, pose.astype(np.float64), nowhere)
    return Subject.of_clip(clip)
