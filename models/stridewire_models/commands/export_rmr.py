"""`stridewire export rmr`: from a run of the refiner to a file that serves."""

import hashlib
import json
from pathlib import Path

import click

from stridewire_engine.networks.onnx_model import SUMS
from stridewire_models.commands.sums import enter


@click.command()
@click.argument("run", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File to write; SHA256SUMS beside it is kept up to date.  [default: RUN/rmr.onnx]",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def rmr(run: Path, out: Path | None, as_json: bool) -> None:
    """Export the best weights of a run of `stridewire train rmr` as ONNX (needs torch, onnx)."""
    try:
        from stridewire_models.rmr.export import exported
    except ModuleNotFoundError as error:
        raise click.ClickException(
            f"exporting needs {error.name}: pip install 'stridewire[server,train]'"
        ) from error
    content, told = exported(run)
    path = out or run / "rmr.onnx"
    path.write_bytes(content)
    digest = hashlib.sha256(content).hexdigest()
    enter(path.parent / SUMS, path.name, digest)
    facts = {
        "file": str(path),
        "variant": told["variant"],
        "bytes": len(content),
        "sha256": digest,
    }
    click.echo(
        json.dumps(facts)
        if as_json
        else "{file}: {variant}, {bytes} bytes, sha256 {sha256}".format(**facts)
    )
