"""`stridewire export`: from a training run to a file that serves."""

import hashlib
import json
from pathlib import Path

import click

from stridewire_engine.evaluation.split_clips import import_clips, split_files
from stridewire_engine.networks.blend.pairs import Frames
from stridewire_engine.networks.onnx_model import SUMS
from stridewire_models.commands.export_rmr import rmr
from stridewire_models.commands.sums import enter


@click.group()
def export() -> None:
    """Make the files that serve out of training runs."""


@export.command()
@click.argument("run", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "--data",
    envvar="STRIDEWIRE_DATA",
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder of the training; figures are in its deviations. STRIDEWIRE_DATA by default.",
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File to write; SHA256SUMS beside it is kept up to date.  [default: RUN/blend.onnx]",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def blend(run: Path, data: Path, out: Path | None, as_json: bool) -> None:
    """Export the best weights of a run of `stridewire train blend` as ONNX (needs torch, onnx)."""
    try:
        from stridewire_models.blend.export import FURTHEST, posture_deviation, read_run, to_onnx
    except ModuleNotFoundError as error:
        raise click.ClickException(
            f"exporting needs {error.name}: pip install 'stridewire[server,train]'"
        ) from error
    network, told = read_run(run)
    files = split_files(data, "cmu", "train")
    with click.progressbar(
        import_clips(files), length=len(files), label="importing train", hidden=as_json
    ) as clips:
        train = Frames.of((clip for clip in clips if clip is not None), mirror=True)
    content = to_onnx(network, int(str(told["seed"])), posture_deviation(train))
    path = out or run / "blend.onnx"
    path.write_bytes(content)
    digest = hashlib.sha256(content).hexdigest()
    enter(path.parent / SUMS, path.name, digest)
    facts = {
        "file": str(path),
        "variant": told["variant"],
        "bytes": len(content),
        "sha256": digest,
        "furthest": FURTHEST,
    }
    click.echo(
        json.dumps(facts)
        if as_json
        else "{file}: {variant}, {bytes} bytes, sha256 {sha256}".format(**facts)
    )


export.add_command(rmr)
