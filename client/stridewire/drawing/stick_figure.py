"""One panel of a contact sheet: the figure at one moment on its piece of ground."""

from typing import TYPE_CHECKING

import numpy as np

from stridewire.drawing.camera import Camera
from stridewire.drawing.palette import GRID, MIDDLE, PLANTED, SHADOW, side_colour
from stridewire.drawing.subject import Subject
from stridewire.motion.array_types import Floats, Vectors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_GROUND_RADIUS = 0.9
_GRID_STEP = 0.25
_GHOST_S = 0.1
_HEAD_RADIUS = 0.095
_PLANTED_RADIUS = 0.055


def draw_moment(axes: "Axes", subject: Subject, camera: Camera, frame: int) -> None:
    """Draw ground, path, planted feet, what was 0.1 s before, and the figure."""
    axes.set_xlim(-0.98, 0.98)
    axes.set_ylim(-1.22, 1.14)
    axes.set_aspect("equal")
    axes.axis("off")
    root = subject.root[frame]
    draw_ground(axes, camera, root, _GROUND_RADIUS)
    draw_path(axes, subject, camera, frame, _GROUND_RADIUS)
    draw_planted(axes, subject, camera, frame)
    _bones(axes, subject, camera, subject.positions[frame] * [1.0, 0.0, 1.0], root, shadow=True)
    before = subject.positions[max(frame - round(_GHOST_S * subject.frame_rate), 0)]
    _bones(axes, subject, camera, before, root, ghost=True)
    _bones(axes, subject, camera, subject.positions[frame], root)


def _bones(
    axes: "Axes",
    subject: Subject,
    camera: Camera,
    positions: Vectors,
    root: Vectors,
    *,
    ghost: bool = False,
    shadow: bool = False,
) -> None:
    """Draw bones, near ones on top, each in the colour of its lower joint's side."""
    from matplotlib.collections import LineCollection

    points, depth = camera.project(positions, root)
    joints = np.arange(1, len(subject.parents))
    parents = np.array(subject.parents[1:], np.intp)
    order = joints[np.argsort(-(depth[joints] + depth[parents]))]
    segments = np.stack([points[np.array(subject.parents)[order]], points[order]], axis=1)
    colours = [SHADOW if shadow else side_colour(int(subject.sides[j])) for j in order]
    lines = LineCollection(
        segments.tolist(),
        colors=colours,
        linewidths=2.2 if shadow else 1.2 if ghost else 2.8,
        alpha=0.28 if ghost else 1.0,
        capstyle="round",
        zorder=2 if shadow else 3 if ghost else 4,
    )
    axes.add_collection(lines)
    if subject.head is not None and not shadow and not ghost:
        _head(axes, subject, camera, positions, root)


def _head(
    axes: "Axes", subject: Subject, camera: Camera, positions: Vectors, root: Vectors
) -> None:
    """Draw a circle that continues the neck."""
    from matplotlib.patches import Circle

    assert subject.head is not None
    joint = positions[subject.head]
    neck = joint - positions[max(subject.parents[subject.head], 0)]
    centre = joint + neck / max(float(np.linalg.norm(neck)), 1e-6) * _HEAD_RADIUS * 0.8
    point, _ = camera.project(centre, root)
    axes.add_patch(
        Circle((point[0], point[1]), _HEAD_RADIUS, fc="white", ec=MIDDLE, lw=1.8, zorder=5)
    )


def draw_ground(
    axes: "Axes", camera: Camera, root: Vectors, radius: float, step: float = _GRID_STEP
) -> None:
    """Draw the world's grid within a circle around the root: it moves as the figure does."""
    from matplotlib.collections import LineCollection

    lines = []
    for axis, other in ((0, 2), (2, 0)):
        first = np.ceil((root[axis] - radius) / step) * step
        for value in np.arange(first, root[axis] + radius, step):
            half = np.sqrt(radius**2 - (value - root[axis]) ** 2)
            ends = np.zeros((2, 3))
            ends[:, axis] = value
            ends[:, other] = root[other] + np.array([-half, half])
            lines.append(camera.project(ends, root)[0].tolist())
    axes.add_collection(LineCollection(lines, colors=GRID, linewidths=0.6, zorder=0))


def draw_path(axes: "Axes", subject: Subject, camera: Camera, frame: int, radius: float) -> None:
    """Draw the root's way near the figure and an arrow where it faces."""
    root = subject.root[frame]
    near = np.linalg.norm(subject.root - root, axis=-1) < radius
    start = frame - int(np.argmin(np.append(near[frame::-1], False))) + 1
    end = frame + int(np.argmin(np.append(near[frame:], False)))
    way, _ = camera.project(subject.root[start:end], root)
    axes.plot(way[:, 0], way[:, 1], color=MIDDLE, lw=0.8, alpha=0.45, zorder=1)
    yaw = subject.heading[frame]
    front = np.array([np.sin(yaw), 0.0, np.cos(yaw)])
    ends, _ = camera.project(np.stack([root, root + 0.4 * front]), root)
    axes.annotate(
        "",
        xy=tuple(ends[1]),
        xytext=tuple(ends[0]),
        arrowprops={"arrowstyle": "-|>", "color": MIDDLE, "lw": 0.9, "alpha": 0.7},
        zorder=1,
    )


def draw_planted(
    axes: "Axes",
    subject: Subject,
    camera: Camera,
    frame: int,
    radius: float = _PLANTED_RADIUS,
) -> None:
    """Draw a disc on the ground under each planted joint."""
    from matplotlib.patches import Polygon

    angle = np.linspace(0.0, 2.0 * np.pi, 24)
    circle: Floats = radius * np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)], -1)
    for joint in subject.feet[subject.planted[frame]]:
        under = subject.positions[frame, joint] * [1.0, 0.0, 1.0]
        disc, _ = camera.project(under + circle, subject.root[frame])
        axes.add_patch(Polygon(disc.tolist(), closed=True, fc=PLANTED, ec="none", zorder=2.5))
