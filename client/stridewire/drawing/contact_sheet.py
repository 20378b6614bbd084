"""Contact sheets: one picture by which a person can judge a motion."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stridewire.drawing.camera import Camera
from stridewire.drawing.canvas import new_figure
from stridewire.drawing.palette import LEFT, MIDDLE, PLANTED, RIGHT
from stridewire.drawing.stick_figure import draw_moment
from stridewire.drawing.strips import draw_feet, draw_plan, draw_speed
from stridewire.drawing.subject import Subject
from stridewire.motion.array_types import Indices
from stridewire.motion.clip import Clip

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PANEL_INCHES = (1.65, 2.0)
_STRIPS_INCHES = 3.2
_DOTS_PER_INCH = 110


def contact_sheet(
    clip: Clip, path: Path | str, *, title: str | None = None, columns: int = 8, rows: int = 2
) -> None:
    """Draw a clip as `draw_contact_sheet` does."""
    draw_contact_sheet(Subject.of_clip(clip), path, title=title, columns=columns, rows=rows)


def draw_contact_sheet(
    subject: Subject, path: Path | str, *, title: str | None = None, columns: int = 8, rows: int = 2
) -> None:
    """Draw figures at even times, the way from above, feet and speed over time, as a PNG.

    Left limbs are blue, right ones orange; a green disc lies under each planted joint; the faint
    figure is where it was 0.1 s before, so that a planted foot that slides shows.

    Args:
        subject: What to draw.
        path: Where the PNG goes.
        title: Instead of the subject's name.
        columns: Figures side by side, 4 or more.
        rows: Rows of figures.

    Raises:
        ValueError: If there are fewer than 4 columns or no row.
        StridewireError: If matplotlib is not installed.
        OSError: If the file cannot be written.
    """
    if columns < 4 or rows < 1:
        raise ValueError(f"{columns} columns, {rows} rows; expected 4 or more columns and a row")
    figure = new_figure(columns * _PANEL_INCHES[0], rows * _PANEL_INCHES[1] + _STRIPS_INCHES + 0.4)
    camera = Camera.beside(subject)
    frames = np.linspace(0, len(subject.positions) - 1, columns * rows).round().astype(np.intp)
    _moments(figure, subject, camera, frames, columns)
    _strips(figure, subject, camera, frames)
    _heading(figure, subject, title)
    figure.savefig(path, dpi=_DOTS_PER_INCH, format="png")


def _moments(
    figure: "Figure", subject: Subject, camera: Camera, frames: Indices, columns: int
) -> None:
    height = figure.get_figheight()
    top, bottom = 1.0 - 0.4 / height, (_STRIPS_INCHES + 0.05) / height
    rows = len(frames) // columns
    speed = subject.speed
    grid = figure.add_gridspec(
        rows, columns, left=0.005, right=0.995, top=top, bottom=bottom, wspace=0.0, hspace=0.06
    )
    for number, frame in enumerate(frames):
        axes = figure.add_subplot(grid[number // columns, number % columns])
        draw_moment(axes, subject, camera, int(frame))
        label = f"{number + 1}:  {frame / subject.frame_rate:.2f} s   {speed[frame]:.2f} m/s"
        axes.text(0.5, 0.0, label, transform=axes.transAxes, fontsize=7, ha="center", color=MIDDLE)


def _strips(figure: "Figure", subject: Subject, camera: Camera, frames: Indices) -> None:
    width, height = figure.get_figwidth(), figure.get_figheight()
    top, bottom = (_STRIPS_INCHES - 0.35) / height, 0.25 / height
    grid = figure.add_gridspec(
        2, 2, left=0.3 / width, right=1.0 - 0.12 / width, top=top, bottom=bottom,
        width_ratios=(_STRIPS_INCHES, width - _STRIPS_INCHES), height_ratios=(3, 2),
        wspace=0.05, hspace=0.25,
    )  # fmt: skip
    plan, feet, speed = (
        figure.add_subplot(grid[place]) for place in (np.s_[:, 0], np.s_[0, 1], np.s_[1, 1])
    )
    draw_plan(plan, subject, camera, frames)
    draw_feet(feet, subject, frames)
    draw_speed(speed, subject, frames)
    for axes in (plan, feet, speed):
        axes.tick_params(labelsize=6, length=2, pad=1.5, colors=MIDDLE)


def _heading(figure: "Figure", subject: Subject, title: str | None) -> None:
    height, width = figure.get_figheight(), figure.get_figwidth()
    y = 1.0 - 0.2 / height
    words = f"{title or subject.name}   {subject.seconds:.1f} s at {subject.frame_rate:g} frames/s"
    figure.text(0.12 / width, y, words, fontsize=10, color=MIDDLE, va="center", weight="bold")
    keys = (("left", LEFT), ("right", RIGHT), ("planted", PLANTED))
    for index, (word, colour) in enumerate(keys):
        x = 1.0 - (0.12 + 0.6 * (len(keys) - index)) / width
        figure.text(x, y, f"\u25cf {word}", fontsize=8, color=colour, va="center")
