"""The timeline of an inspected character: clips, costs, what was hidden, speed; one picture."""

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from stridewire_engine.replaying.inspection import Moment

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_BANDS = ("#a5c4e5", "#d9e6f3")


def draw_timeline(moments: Sequence[Moment], path: Path, frame: int | None = None) -> None:
    """Draw moments in the order of time as a PNG; one frame may be marked."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 8), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(4, 1, sharex=True, height_ratios=(1.2, 2, 1.5, 1.5))
    _clips(axes[0], moments)
    _costs(axes[1], moments)
    time = [moment.time_s for moment in moments]
    axes[2].plot(time, [m.hidden.mean_cm for m in moments], color="#3b6ea5", label="mean joint")
    axes[2].plot(time, [m.hidden.most_cm for m in moments], color="#c0504d", lw=0.8, label="worst")
    axes[2].set_ylabel("hidden, cm")
    axes[3].plot(time, [m.asked_speed for m in moments], color="#999999", label="asked for")
    axes[3].plot(time, [m.speed for m in moments], color="#3b6ea5", label="root")
    axes[3].set_ylabel("speed, m/s")
    axes[3].set_xlabel("seconds")
    for one in axes[1:]:
        one.legend(loc="upper right", fontsize=7)
    for one in axes:
        for moment in moments:
            if moment.transition is not None:
                one.axvline(moment.time_s, color="#555555", lw=0.6)
            if moment.frame == frame:
                one.axvline(moment.time_s, color="#c0504d", lw=1.6, ls="--")
    figure.savefig(path, dpi=110)


def _clips(axes: "Axes", moments: Sequence[Moment]) -> None:
    """Draw a band for each stretch of a clip, with its name and why it was entered."""
    stretch = 0

    def number(moment: Moment) -> int:
        nonlocal stretch
        stretch += moment.transition is not None
        return stretch

    for i, (_, part) in enumerate(groupby(moments, number)):
        inside = list(part)
        start, stop = inside[0].time_s, inside[-1].time_s
        axes.axvspan(start, stop, color=_BANDS[i % 2])
        label = f"{inside[0].clip}\n{inside[0].reason}"
        axes.text(start, 0.1, label, fontsize=6, rotation=30, clip_on=True)
    axes.set_yticks([])
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("clip")


def _costs(axes: "Axes", moments: Sequence[Moment]) -> None:
    """Draw what staying and the best other cost, where searches were made."""
    found = [m for m in moments if m.searched and m.stay is not None and m.candidates]
    time = [moment.time_s for moment in found]
    stay = [moment.stay.cost for moment in found if moment.stay is not None]
    needed = [cost - moment.bias for cost, moment in zip(stay, found, strict=True)]
    axes.plot(time, stay, ".-", color="#3b6ea5", lw=0.8, ms=4, label="staying")
    axes.plot(time, needed, color="#a5c4e5", lw=0.8, label="staying less bias")
    best = [moment.candidates[0].cost for moment in found]
    axes.plot(time, best, ".-", color="#c0504d", lw=0.8, ms=4, label="best other")
    axes.set_yscale("symlog", linthresh=1.0)
    axes.set_ylabel("cost")
