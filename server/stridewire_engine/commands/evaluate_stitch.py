"""`stridewire evaluate stitch`: how well seams are hidden, beside what the actors did."""

import json
import sys
from pathlib import Path
from typing import Any

import click

from stridewire import __version__
from stridewire_engine.evaluation.seam_methods import plain_methods
from stridewire_engine.evaluation.split_clips import import_clips, split_files
from stridewire_engine.evaluation.stitch_figures import PATHS, Figures, Judge
from stridewire_engine.evaluation.stitch_networks import Measured, networks
from stridewire_engine.evaluation.stitch_table import rows
from stridewire_engine.networks.onnx_model import ModelError
from stridewire_engine.networks.rmr.takes import Takes

_COLUMNS = (
    ("A cm/s", "sliding_a_cm_s"), ("C cm/s", "sliding_c_cm_s"), ("error cm", "position_error_cm"),
    ("feet cm", "foot_error_cm"), ("NPSS", "npss"), ("toe jerk", "toe_jerk_ratio"),
    ("knee jerk", "knee_jerk_ratio"), ("jump %", "jump_pct"),
)  # fmt: skip


@click.command()
@click.option(
    "--data",
    envvar="STRIDEWIRE_DATA",
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder with split.csv and the unpacked data sets; STRIDEWIRE_DATA by default.",
)
@click.option(
    "--set", "name", default="cmu", show_default=True, help="Data set; folders NAME and NAME-…."
)
@click.option(
    "--split", type=click.Choice(("train", "validation", "test")), default="test",
    show_default=True, help="Subjects to measure on.",
)  # fmt: skip
@click.option(
    "--path", type=click.Choice(PATHS), default=PATHS[0], show_default=True,
    help="Root path that clips are put under: the take's, or it smoothed.",
)  # fmt: skip
@click.option(
    "--stride", type=click.IntRange(1), default=30, show_default=True,
    help="Frames from one window to the next.",
)  # fmt: skip
@click.option(
    "--network", "named", multiple=True, metavar="NAME=FILE",
    help="Also measure a network exported by `stridewire export rmr`; may be repeated.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def stitch(
    data: Path,
    name: str,
    split: str,
    path: str,
    stride: int,
    named: tuple[str, ...],
    as_json: bool,
) -> None:
    """Measure what hides seams of clips that follow a captured take's path."""
    trained = _networks(named)
    methods = {**plain_methods(), **{label: each.method for label, each in trained.items()}}
    files = split_files(data, name, split)
    with click.progressbar(
        import_clips(files), length=len(files), label=f"importing {split}", hidden=as_json
    ) as clips:
        takes = Takes.of(clip for clip in clips if clip is not None)
    judge = Judge(takes, stride, path)
    measured: dict[str, Figures] = {}
    for label, method in methods.items():
        with click.progressbar(length=len(judge.pairs), label=label, hidden=as_json) as bar:
            measured[label] = judge.measure(method, bar.update)
    about = {"data": name, "split": split, "path": path, "pairs": len(judge.pairs)}
    table = list(rows(about, measured))
    for row in table:
        if row["method"] in trained:
            row["budget_min"] = trained[row["method"]].budget_min
    settings = {
        "version": __version__,
        "takes": len(judge.clips),
        "stride": stride,
        "command": " ".join(sys.argv[1:]),
    }
    if as_json:
        click.echo(json.dumps({"settings": settings, "rows": table}))
    else:
        _print(table)


def _networks(named: tuple[str, ...]) -> dict[str, Measured]:
    """Return the networks that ship, and others by name."""
    others: dict[str, Path] = {}
    for text in named:
        label, _, path = text.partition("=")
        if not label or not path:
            raise click.BadParameter(
                f"{text!r}; expected NAME=FILE such as refine-1=runs/1/rmr.onnx",
                param_hint="--network",
            )
        others[label] = Path(path)
    try:
        return networks(others)
    except ModelError as error:
        raise click.ClickException(str(error)) from error


def _print(table: list[dict[str, Any]]) -> None:
    click.echo(f"{'method':<14}" + "".join(f"{title:<24}" for title, _ in _COLUMNS))
    for row in table:
        click.echo(
            f"{row['method']:<14}" + "".join(f"{_cell(row, key):<24}" for _, key in _COLUMNS)
        )
    click.echo("of the spring's:")
    for row in table:
        if "npss_of_spring" in row:
            names = ("sliding_a_cm_s", "sliding_c_cm_s", "position_error_cm", "foot_error_cm")
            cells = "".join(f"{_cell(row, f'{name}_of_spring'):<24}" for name in names)
            click.echo(f"{row['method']:<14}{cells}")


def _cell(row: dict[str, Any], key: str) -> str:
    if row[key] is None:
        return "-"
    return f"{row[key]:.3g} ({row[f'{key}_low']:.3g} … {row[f'{key}_high']:.3g})"
