"""The lower part of a contact sheet: the way from above, and feet and speed over time."""

from typing import TYPE_CHECKING

import numpy as np

from stridewire.drawing.camera import Camera
from stridewire.drawing.palette import GRID, LEFT, MIDDLE, side_colour
from stridewire.drawing.subject import Subject
from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire.motion.clip import TagSpan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SMALLEST_PLAN = 1.0


def draw_plan(axes: "Axes", subject: Subject, camera: Camera, frames: Indices) -> None:
    """Draw the root's way from above, turned as the camera sees it, with ticks where it faces."""
    origin = subject.root[0]
    way = camera.plan(subject.root - origin)
    axes.plot(way[:, 0], way[:, 1], color=MIDDLE, lw=1.3, zorder=2)
    low, high = way.min(axis=0), way.max(axis=0)
    half = max(float((high - low).max()) / 2.0 * 1.25, _SMALLEST_PLAN)
    middle = (low + high) / 2.0
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_aspect("equal")
    shown = _apart(way, frames, 0.1 * half)
    yaw = subject.heading[frames[shown]]
    front = camera.plan(np.stack([np.sin(yaw), 0.0 * yaw, np.cos(yaw)], axis=-1)) * 0.16 * half
    axes.quiver(
        *way[frames[shown]].T, *front.T,
        angles="xy", scale_units="xy", scale=1.0, color=LEFT, width=0.008, zorder=3,
    )  # fmt: skip
    beside = np.stack([-front[:, 1], front[:, 0]], axis=-1) * 0.6
    for number, (x, y) in zip(shown, way[frames[shown]] + beside, strict=True):
        axes.text(x, y, str(number + 1), fontsize=6, ha="center", va="center", zorder=4)
    axes.grid(color=GRID, lw=0.6)
    axes.set_title("from above, m", fontsize=8, loc="left", color=MIDDLE)


def draw_feet(axes: "Axes", subject: Subject, frames: Indices) -> None:
    """Draw the heights of the last foot joint of each side, and bars where joints are planted."""
    time = np.arange(len(subject.positions)) / subject.frame_rate
    per_side = max(len(subject.feet) // 2, 1)
    for joint in subject.feet[per_side - 1 :: per_side]:
        height = 100.0 * subject.positions[:, joint, 1]
        axes.plot(time, height, color=side_colour(int(subject.sides[joint])), lw=1.1)
    top = max(30.0, axes.get_ylim()[1])
    row = 0.05 * top
    for index, joint in enumerate(subject.feet):
        axes.broken_barh(
            _spans(subject.planted[:, index], subject.frame_rate),
            (-(index + 2) * row, 0.75 * row),
            facecolors=side_colour(int(subject.sides[joint])),
        )
    axes.set_ylim(-(len(subject.feet) + 2) * row, top)
    axes.axhline(0.0, color=MIDDLE, lw=0.6)
    _finish(axes, subject, frames, "toes above ground, cm; bars: planted")
    axes.tick_params(labelbottom=False)
    for number, frame in enumerate(frames, start=1):
        axes.text(time[frame], 0.97 * top, str(number), fontsize=6, ha="center", va="top")


def draw_speed(axes: "Axes", subject: Subject, frames: Indices) -> None:
    """Draw the root's speed, with the names of tagged spans."""
    time = np.arange(len(subject.positions)) / subject.frame_rate
    axes.plot(time, subject.speed, color=MIDDLE, lw=1.1)
    top = max(2.0, 1.5 * float(subject.speed.max()))
    axes.set_ylim(0.0, top)
    for tag, lane in zip(subject.tags, _lanes(subject.tags), strict=True):
        start, end = tag.start / subject.frame_rate, tag.end / subject.frame_rate
        y = top * (0.96 - 0.11 * lane)
        axes.plot([start, end], [y, y], color=GRID, lw=5.0, solid_capstyle="butt")
        axes.text(start, y, f" {tag.name}", fontsize=6, va="center_baseline", clip_on=True)
    _finish(axes, subject, frames, "root speed, m/s, over seconds")


def _apart(way: Floats, frames: Indices, distance: float) -> list[int]:
    """Return which of the frames lie far enough from all those before to be told apart."""
    shown: list[int] = []
    for number, place in enumerate(way[frames]):
        near = np.linalg.norm(way[frames[shown]] - place, axis=-1) < distance
        if not near.any():
            shown.append(number)
    return shown


def _lanes(tags: tuple[TagSpan, ...]) -> list[int]:
    """Return for each span the first lane that is free when it begins."""
    ends: list[int] = []
    lanes = {}
    for tag in sorted(tags, key=lambda t: (t.start, t.name)):
        lane = next((i for i, end in enumerate(ends) if end <= tag.start), len(ends))
        ends[lane : lane + 1] = [tag.end]
        lanes[tag] = lane
    return [lanes[tag] for tag in tags]


def _finish(axes: "Axes", subject: Subject, frames: Indices, title: str) -> None:
    axes.set_xlim(0.0, max(subject.seconds, 1.0 / subject.frame_rate))
    for frame in frames:
        axes.axvline(frame / subject.frame_rate, color=GRID, lw=0.6, zorder=0)
    axes.set_title(title, fontsize=8, loc="left", color=MIDDLE, pad=2.0)
    axes.spines[["top", "right"]].set_visible(False)


def _spans(flags: Flags, frame_rate: float) -> list[tuple[float, float]]:
    """Return begin and length in seconds of each run of true flags."""
    edges = np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return [(a / frame_rate, (b - a) / frame_rate) for a, b in zip(starts, ends, strict=True)]
