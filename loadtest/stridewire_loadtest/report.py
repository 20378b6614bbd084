"""The picture of a measurement: latencies, late frames over time, CPU and memory."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stridewire_loadtest.measurement import Measured

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_BUDGET_MS = 1000.0 / 60.0
_PERCENTILES = np.concatenate([np.linspace(0.0, 99.0, 100), [99.5, 99.9, 99.95, 99.99, 100.0]])


def draw_report(measured: Measured, path: Path) -> None:
    """Write a PNG of a measurement.

    Raises:
        OSError: If it cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 7.0), layout="constrained")
    percentiles, spread, late, used = figure.subplots(2, 2).flat
    _draw_percentiles(percentiles, measured)
    _draw_spread(spread, measured)
    _draw_late(late, measured)
    _draw_usage(used, measured)
    row = measured.row()
    verdict = "" if row["valid"] else "VOID: " + "; ".join(measured.void()) + "\n"
    figure.suptitle(
        f"{verdict}{row['scenario']}: {row['streams']} streams, {row['characters']} characters, "
        f"{row['seconds']:g} s; {row['late_pct']:.2f} % late",
        fontsize=11,
    )
    figure.savefig(path, dpi=110)


def _draw_percentiles(axes: "Axes", measured: Measured) -> None:
    for name, histogram in (("frame", measured.tally.frames), ("sending", measured.tally.sending)):
        if histogram.get_total_count():
            values = [histogram.get_value_at_percentile(p) / 1e3 for p in _PERCENTILES]
            axes.plot(_PERCENTILES, values, label=name)
    axes.axhline(_BUDGET_MS, color="0.3", lw=0.8, ls="--")
    axes.set(xlabel="percentile", ylabel="ms from the scheduled time", yscale="log")
    axes.legend(frameon=False)


def _draw_spread(axes: "Axes", measured: Measured) -> None:
    recorded = [
        (bucket.value_iterated_to / 1e3, bucket.count_added_in_this_iter_step)
        for bucket in measured.tally.frames.get_recorded_iterator()
    ]
    if recorded:
        values, counts = np.array(recorded).T
        edges = np.linspace(0.0, max(2.0 * _BUDGET_MS, float(np.percentile(values, 99))), 80)
        axes.hist(np.minimum(values, edges[-1]), edges.tolist(), weights=counts, log=True)
    axes.axvline(_BUDGET_MS, color="0.3", lw=0.8, ls="--")
    axes.set(xlabel="ms from the scheduled time", ylabel="frames")


def _draw_late(axes: "Axes", measured: Measured) -> None:
    seconds = np.arange(int(measured.load.seconds) + 1)
    axes.bar(seconds, [measured.tally.late_by_second[int(s)] for s in seconds], width=1.0)
    axes.set(xlabel="s", ylabel="late frames a second")


def _draw_usage(axes: "Axes", measured: Measured) -> None:
    usage = measured.usage
    seconds = np.array(usage.seconds)
    if len(seconds) > 1:
        axes.plot(seconds[1:], np.diff(usage.cpu_s) / np.diff(seconds), label="cores of the server")
    axes.set(xlabel="s", ylabel="cores")
    memory = axes.twinx()
    memory.plot(seconds, usage.rss_mb, color="C1", label="memory of the server")
    memory.set(ylabel="MB")
    memory.set_ylim(bottom=0.0)
    memory.legend(handles=[*axes.lines, *memory.lines], loc="center right", frameon=False)
