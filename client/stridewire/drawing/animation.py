"""Animated pictures: a solid figure that walks over the ground, as WebP or GIF."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stridewire.drawing.body_shape import HEAD, TRUNK, limb_radii, trunk_joints
from stridewire.drawing.camera import Camera
from stridewire.drawing.canvas import new_figure
from stridewire.drawing.palette import SHADOW, side_colour
from stridewire.drawing.stick_figure import draw_ground, draw_path, draw_planted
from stridewire.drawing.subject import Subject
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image

FRAME_RATE = 20.0
"""Pictures a second: half as many stutter, twice as many make the file as much larger."""

ENDINGS = (".webp", ".gif")

_INCHES = (4.8, 3.2)
_DOTS_PER_INCH = 100
_HALF_WIDTH = 1.6
"""What the picture shows to either side; metres at the figure."""
_GROUND_RADIUS = 1.6
_GRID_STEP = 0.5
_PLANTED_RADIUS = 0.13
"""Seen around a solid foot."""
_OUTLINE = 0.012
"""Dark rim that keeps limbs apart; metres."""
_INK = "#20242a"
_TRUNK_SEEN = 1.25
"""Radius of the trunk between its depth and its breadth."""
_QUALITY = 45
_GIF_COLOURS = 48


def draw_animation(subject: Subject, path: Path | str) -> int:
    """Draw a motion as an animated picture that repeats, the camera going along.

    Left limbs are blue, right ones orange; a green disc lies under each planted joint.

    Args:
        subject: What to draw.
        path: Where it goes: `.webp`, or `.gif`, which is about twice as large.

    Returns:
        How many pictures it has.

    Raises:
        ValueError: If the ending is neither.
        StridewireError: If matplotlib is not installed.
        OSError: If the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in ENDINGS:
        raise ValueError(f"cannot animate {path.name}; expected {' or '.join(ENDINGS)}")
    count = max(round(subject.seconds * FRAME_RATE), 1)
    frames = np.round(np.arange(count) * subject.frame_rate / FRAME_RATE).astype(np.intp)
    figure = new_figure(*_INCHES)
    body, camera = _Body.of(subject), Camera.beside(subject)
    pictures = [_picture(figure, subject, body, camera, int(frame)) for frame in frames]
    _save(pictures, path)
    return count


@dataclass(frozen=True)
class _Body:
    """B bones to draw, each from its upper joint towards its lower one."""

    size: float
    """Length of the longest chain of bones; metres."""
    upper: Indices
    lower: Indices
    span: Floats
    """`(B, 2)` where it begins and ends, 0 at the upper joint, 1 at the lower."""
    of_trunk: Flags
    radii: Floats
    """`(B,)` metres."""
    colours: list[str]

    @classmethod
    def of(cls, subject: Subject) -> "_Body":
        """Give a subject's bones their thickness and colours."""
        parents, sides = subject.parents, subject.sides
        lengths = _bone_lengths(subject)
        size, trunk = _longest(parents, lengths), trunk_joints(parents, sides)
        radii = limb_radii(parents, lengths, trunk, size)
        bones: list[tuple[int, int, tuple[float, float], bool, float]] = []
        for lower, upper in enumerate(parents[1:], start=1):
            rises = upper in trunk and sides[lower] == 0
            half = 0.5 if rises and lower not in trunk else 1.0
            if rises:
                bones.append((upper, lower, (0.0, half), True, _TRUNK_SEEN * TRUNK * size))
            if upper in trunk and sides[lower] != 0 and lower in parents:
                continue  # a limb begins at its first joint; on the way there is the trunk
            if lower not in trunk:
                thick = radii[lower] if upper in trunk else 0.5 * (radii[lower] + radii[upper])
                bones.append((upper, lower, (half % 1.0, 1.0), False, float(thick)))
        ups, lows, span, of_trunk, thickness = map(np.array, zip(*bones, strict=True))
        colours = [side_colour(int(sides[lower])) for lower in lows]
        return cls(size, ups, lows, span, of_trunk, thickness, colours)


def _bone_lengths(subject: Subject) -> Floats:
    parents, positions = np.array(subject.parents, np.intp), subject.positions
    lengths = np.zeros(len(parents))
    bones = positions[:, 1:] - positions[:, parents[1:]]
    lengths[1:] = np.median(np.linalg.norm(bones, axis=-1), axis=0)
    return lengths


def _longest(parents: tuple[int, ...], bones: Floats) -> float:
    chain = np.zeros(len(parents))
    for joint, parent in enumerate(parents[1:], start=1):
        chain[joint] = chain[parent] + bones[joint]
    return max(float(chain.max()), 1e-6)


def _picture(
    figure: "Figure", subject: Subject, body: _Body, camera: Camera, frame: int
) -> "Image":
    from PIL.Image import fromarray

    figure.clear()
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    height = 2.0 * _HALF_WIDTH * _INCHES[1] / _INCHES[0]
    axes.set_xlim(-_HALF_WIDTH, _HALF_WIDTH)
    axes.set_ylim(-0.525 * height, 0.475 * height)
    axes.axis("off")
    draw_ground(axes, camera, subject.root[frame], _GROUND_RADIUS, _GRID_STEP)
    draw_path(axes, subject, camera, frame, _GROUND_RADIUS)
    draw_planted(axes, subject, camera, frame, _PLANTED_RADIUS)
    _solid(axes, subject, body, camera, frame)
    canvas: Any = figure.canvas
    canvas.draw()
    return fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _solid(axes: "Axes", subject: Subject, body: _Body, camera: Camera, frame: int) -> None:
    """Draw the shadow, then limbs and head from far to near, each with its rim."""
    root, positions = subject.root[frame], subject.positions[frame]
    upper, bone = positions[body.upper], positions[body.lower] - positions[body.upper]
    ends = upper + body.span.T[:, :, None] * bone
    radii, colours, of_trunk = body.radii, body.colours, body.of_trunk
    if subject.head is not None:
        ends = np.concatenate([ends, _head(subject, body, positions)[:, None]], axis=1)
        radii, colours = np.append(radii, HEAD * body.size), [*colours, side_colour(0)]
        of_trunk = np.append(of_trunk, False)
    flat, _ = camera.project(ends * [1.0, 0.0, 1.0], root)
    _limbs(axes, flat, 1.3 * radii, [SHADOW] * len(radii), layer=2)
    points, depth = camera.project(ends, root)
    far = depth.mean(axis=0)
    far[of_trunk] = far[of_trunk].mean() if of_trunk.any() else 0.0
    # rims first where bones are equally far: those of the trunk do not cut it into pieces
    inside = np.arange(2 * len(radii)) % 2
    order = np.lexsort((inside, -np.repeat(far, 2)))
    rims = np.repeat(radii, 2) + _OUTLINE * body.size * (1 - inside)
    inked = [ink for colour in colours for ink in (_INK, colour)]
    _limbs(
        axes,
        np.repeat(points, 2, axis=1)[:, order],
        rims[order],
        [inked[i] for i in order],
        layer=3,
    )


def _head(subject: Subject, body: _Body, positions: Vectors) -> Vectors:
    """Return `(2, 3)` both ends of the middle of the head, which continues the neck; metres."""
    assert subject.head is not None
    joint = positions[subject.head]
    neck = joint - positions[max(subject.parents[subject.head], 0)]
    way = neck / max(float(np.linalg.norm(neck)), 1e-6) * HEAD * body.size
    return np.stack([joint + 0.62 * way, joint + 0.98 * way])


def _limbs(axes: "Axes", ends: Floats, radii: Floats, colours: list[str], *, layer: int) -> None:
    """Draw lines with round ends, `(2, B, 2)` in the picture, the last on top."""
    from matplotlib.collections import LineCollection

    points_per_metre = 72.0 * _INCHES[0] / (2.0 * _HALF_WIDTH)
    lines = LineCollection(
        np.swapaxes(ends, 0, 1).tolist(),
        colors=colours,
        linewidths=(2.0 * points_per_metre * radii).tolist(),
        capstyle="round",
        zorder=layer,
    )
    axes.add_collection(lines)


def _save(pictures: "list[Image]", path: Path) -> None:
    duration = round(1e3 / FRAME_RATE)
    if path.suffix.lower() == ".gif":
        from PIL.Image import Dither

        palette = pictures[0].quantize(_GIF_COLOURS)
        pictures = [picture.quantize(palette=palette, dither=Dither.NONE) for picture in pictures]
        options: dict[str, Any] = {"optimize": True}
    else:
        options = {"quality": _QUALITY, "method": 4}
    first, *others = pictures
    first.save(path, save_all=True, append_images=others, duration=duration, loop=0, **options)
