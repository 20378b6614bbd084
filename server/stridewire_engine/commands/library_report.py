"""`stridewire library report`: coverage and quality of a library, and what to capture next."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path

import click

from stridewire import __version__
from stridewire_engine.building.coverage import SPEEDS, TURNS, Report, examine
from stridewire_engine.commands.library_info import open_library

_WORST = 15


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(dir_okay=False, path_type=Path), help="Draw it into a PNG.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def report(folder: Path, out: Path | None, as_json: bool) -> None:
    """Say what a library covers, how clean its clips are and what to capture next."""
    library = open_library(folder)
    found = examine(library)
    if out is not None:
        _draw(found, library.name, out)
    if as_json:
        click.echo(json.dumps(_facts(found, folder), indent=2))
        return
    _print_coverage(found)
    _print_quality(found)
    _print_wanted(found)
    if out is not None:
        click.echo(f"drawn: {out}")


def _labels(edges: Sequence[float], unit: str) -> list[str]:
    names = []
    for low, high in pairwise(edges):
        if low == float("-inf"):
            names.append(f"< {high:g}{unit}")
        elif high == float("inf"):
            names.append(f"> {low:g}{unit}")
        else:
            names.append(f"{low:g} to {high:g}{unit}")
    return names


def _print_coverage(found: Report) -> None:
    click.echo(
        "minutes by speed (m/s, down) and turning rate (degrees/s, across; left is positive)"
    )
    turns = _labels(TURNS, "")
    click.echo(" " * 14 + "".join(f"{turn:>14}" for turn in turns))
    for label, row in zip(_labels(SPEEDS, ""), found.minutes, strict=True):
        click.echo(f"{label:<14}" + "".join(f"{minutes:14.2f}" for minutes in row))
    click.echo(
        "seconds by tag: " + ", ".join(f"{t} {s:.0f}" for t, s in found.seconds_by_tag.items())
    )


def _print_quality(found: Report) -> None:
    faulty = [clip for clip in found.clips if clip.problems]
    click.echo(f"{len(found.clips)} clips without their mirrored copies, {len(faulty)} to look at")
    for clip in sorted(faulty, key=lambda c: -len(c.problems))[:_WORST]:
        click.echo(
            f"  {clip.name:<32} {clip.seconds:6.1f} s  jerk {clip.noise:5.0f} m/s3  floor "
            f"{clip.floor_cm:+5.1f} cm  sliding {clip.sliding_cm_s:4.1f} cm/s  contact "
            f"{clip.contact_share:4.0%}: {'; '.join(clip.problems)}"
        )
    if len(faulty) > _WORST:
        click.echo(f"  … and {len(faulty) - _WORST} more; all with --json")


def _print_wanted(found: Report) -> None:
    if not found.wanted:
        click.echo("nothing is missing for steering a character")
        return
    click.echo("capture next:")
    for tag, held, wanted in found.wanted:
        click.echo(f"  {tag:<16}{held:6.1f} s held, {wanted:g} s wanted")


def _facts(found: Report, folder: Path) -> dict[str, object]:
    speeds, turns = _labels(SPEEDS, " m/s"), _labels(TURNS, " deg/s")
    return {
        "settings": {"version": __version__, "library": str(folder)},
        "rows": [
            {"speed": speed, "turning": turn, "minutes": round(float(found.minutes[i, j]), 4)}
            for i, speed in enumerate(speeds)
            for j, turn in enumerate(turns)
        ],
        "seconds_by_tag": found.seconds_by_tag,
        "clips": [{**asdict(clip), "problems": clip.problems} for clip in found.clips],
        "wanted": [
            {"tag": tag, "seconds": held, "wanted_s": wanted} for tag, held, wanted in found.wanted
        ],
    }


def _draw(found: Report, name: str, out: Path) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 5), layout="constrained")
    heat, bars = figure.subplots(1, 2, width_ratios=(3, 2))
    heat.imshow(found.minutes**0.5, cmap="viridis", aspect="auto")
    heat.set_xticks(range(len(TURNS) - 1), _labels(TURNS, ""), rotation=30, ha="right")
    heat.set_yticks(range(len(SPEEDS) - 1), _labels(SPEEDS, ""))
    heat.set_xlabel("turning rate, degrees/s (left is positive)")
    heat.set_ylabel("speed, m/s")
    heat.set_title(f"{name}: minutes")
    brightest = found.minutes.max() ** 0.5
    for (row, column), minutes in _cells(found):
        color = "white" if minutes**0.5 < 0.6 * brightest else "black"
        heat.text(column, row, f"{minutes:.2f}", ha="center", va="center", color=color, fontsize=8)
    tags = list(found.seconds_by_tag.items())[::-1]
    bars.barh([tag for tag, _ in tags], [seconds / 60.0 for _, seconds in tags])
    bars.set_xlabel("minutes by tag")
    figure.savefig(out, dpi=110)


def _cells(found: Report) -> list[tuple[tuple[int, int], float]]:
    rows, columns = found.minutes.shape
    return [((i, j), float(found.minutes[i, j])) for i in range(rows) for j in range(columns)]
