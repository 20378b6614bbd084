"""`stridewire evaluate blend`: how good blended postures are, beside linear blending."""

import json
import sys
from collections.abc import Mapping
from itertools import product
from pathlib import Path
from typing import Any

import click
import numpy as np

from stridewire import __version__
from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation.blend_methods import (
    BATCHES,
    as_served,
    by_network,
    microseconds,
    share_by_network,
)
from stridewire_engine.evaluation.blend_table import rows
from stridewire_engine.evaluation.blending import DURATIONS, LINEAR, Method, blend_linearly, measure
from stridewire_engine.evaluation.checkout import commit
from stridewire_engine.evaluation.split_clips import import_clips, split_files
from stridewire_engine.evaluation.training_runs import WEIGHTS, record
from stridewire_engine.networks.blend import BlendNetwork, blend_network
from stridewire_engine.networks.blend.network import PaperNetwork, load_network
from stridewire_engine.networks.blend.pairs import Frames, Pairs

_COLUMNS = (
    ("mse", "mse"), ("position cm", "position_error_cm"), ("ends gain cm", "end_effector_gain_cm"),
    ("C cm/s", "sliding_c_cm_s"), ("collisions %", "collisions_pct_of_linear"),
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
    "--set",
    "names",
    multiple=True,
    default=("cmu",),
    show_default=True,
    help="Data set; may be given several times.",
)
@click.option(
    "--split",
    "splits",
    multiple=True,
    type=click.Choice(("test", "validation", "train")),
    default=("test",),
    show_default=True,
    help="Split of each; may be given several times.",
)
@click.option(
    "--run",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Measure the exported network of this training run instead of the one that ships, and "
    "tell how it was trained.",
)  # fmt: skip
@click.option(
    "--network",
    "networks",
    multiple=True,
    metavar="NAME=FILE",
    help="Measure another exported network too; may be given several times.",
)
@click.option(
    "--step", default=0.25, show_default=True, type=click.FloatRange(0.01, 10.0),
    help="Seconds from one pair to the next.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def blend(
    data: Path,
    names: tuple[str, ...],
    splits: tuple[str, ...],
    run: Path | None,
    networks: tuple[str, ...],
    step: float,
    as_json: bool,
) -> None:
    """Measure posture blends on captured pairs 0.1 to 1 s apart.

    What was captured between two moments is the truth. Intervals are 95 % bootstrap intervals over
    clips.
    """
    network = load_network(run / WEIGHTS) if run else blend_network()
    methods = {**_ways(network, in_parts=not run), **dict(map(_other, networks))}
    settings: dict[str, Any] = {
        "version": __version__,
        "command": " ".join(["stridewire", *sys.argv[1:]]),
        "commit": commit(),
        "model_sha256": network.model.hash,
        "training": record(run) if run else None,
        "step_s": step,
        "data": [],
    }
    table: list[dict[str, Any]] = []
    for name, split in product(names, splits):
        frames = _frames(data, name, split)
        settings["data"].append(_about(name, split, frames, network))
        part = _rows(name, split, frames, methods, network.deviation, step)
        table += part
        if not as_json:
            click.echo(f"{name}, {split}")
            _print(part)
    if as_json:
        click.echo(json.dumps({"settings": settings, "rows": table}))


def _ways(network: BlendNetwork | PaperNetwork, in_parts: bool) -> dict[str, Method]:
    """Return what is measured of a network, in parts also without one thing or another."""
    if isinstance(network, PaperNetwork):
        return {"neural-paper": by_network(network)}
    served = {"neural": as_served(network)}
    if not in_parts:
        return served
    return served | {
        "neural, duration not told": as_served(network, tell_duration=False),
        "neural, feet as they come": by_network(network),
    }


def _frames(data: Path, name: str, split: str) -> Frames:
    files = split_files(data, name, split)
    with click.progressbar(
        import_clips(files), length=len(files), label=f"importing {name}", file=sys.stderr
    ) as clips:
        return Frames.of(clip for clip in clips if clip is not None)


def _about(
    name: str, split: str, frames: Frames, network: BlendNetwork | PaperNetwork
) -> dict[str, Any]:
    about = {
        "data": name,
        "split": split,
        "clips": len(frames.lengths),
        "frames": int(frames.lengths.sum()),
    }
    if isinstance(network, BlendNetwork):
        share = share_by_network(network, _drawn(frames))
        about["by_network_pct"] = round(100.0 * share, 1)
    return about


def _rows(
    name: str,
    split: str,
    frames: Frames,
    methods: Mapping[str, Method],
    deviation: Floats,
    step: float,
) -> list[dict[str, Any]]:
    with click.progressbar(
        length=len(DURATIONS), label=f"measuring {name} {split}", file=sys.stderr
    ) as bar:
        measured = measure(frames, methods, deviation, step=step, done=bar.update)
    return [*rows(name, split, measured), *_times(name, split, frames, methods)]


def _other(text: str) -> tuple[str, Method]:
    label, _, path = text.partition("=")
    if not label or not path:
        raise click.BadParameter(
            f"{text!r}; expected NAME=FILE such as neural-paper=runs/paper/blend.onnx",
            param_hint="--network",
        )
    return label, by_network(load_network(Path(path)))


def _drawn(frames: Frames) -> Pairs:
    return frames.draw(np.random.default_rng(0), BATCHES[-1], 1)


def _times(
    name: str, split: str, frames: Frames, methods: Mapping[str, Method]
) -> list[dict[str, Any]]:
    pairs = _drawn(frames)
    out = []
    for label, method in {LINEAR: blend_linearly, **methods}.items():
        taken = microseconds(method, pairs)
        times = {f"us_per_posture_batch{batch}": round(us, 1) for batch, us in taken.items()}
        out.append({"data": name, "split": split, "method": label, "weight": "all", **times})
    return out


def _print(table: list[dict[str, Any]]) -> None:
    head = f"{'method':<27}{'weight':>7}{'s':>5}  "
    click.echo(head + "".join(f"{title:<24}" for title, _ in _COLUMNS) + f"{'linear':>8}")
    for row in table:
        if "mse" in row:
            cells = "".join(f"{_cell(row, key):<24}" for _, key in _COLUMNS)
            duration = row["duration_s"] or "all"
            start = f"{row['method']:<27}{row['weight']:>7}{duration:>5}  "
            click.echo(f"{start}{cells}{row['linear_collisions']:>8}")
    for row in table:
        if row.get("figure"):
            share = _cell(row, "collisions_pct_of_linear")
            click.echo(
                f"{row['method']}: collisions {share} % of linear's, mean over "
                f"{row['durations']} measurable durations"
            )
        if "us_per_posture_batch1" in row:
            times = ", ".join(f"{row[f'us_per_posture_batch{batch}']:g}" for batch in BATCHES)
            click.echo(f"{row['method']}: {times} us a posture at batch 1, 32, 1024")


def _cell(row: dict[str, Any], key: str) -> str:
    if row[key] is None:
        return "-"
    return f"{row[key]:.3g} ({row[f'{key}_low']:.3g} … {row[f'{key}_high']:.3g})"
