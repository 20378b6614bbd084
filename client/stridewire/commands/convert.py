"""`stridewire convert`: motion files from one format, rate, unit or up axis to another."""

from dataclasses import replace
from pathlib import Path

import click

from stridewire.formats.bvh_writing import write_source_bvh
from stridewire.formats.conversion import UNITS, scaled, turned_up, with_rate
from stridewire.formats.npz import write_npz
from stridewire.formats.reading import read_motion
from stridewire.formats.source_motion import SourceMotion

_WRITERS = {".bvh": write_source_bvh, ".npz": write_npz}
_ACCLAIM_RATE = 120.0


@click.command()
@click.argument(
    "motion", metavar="IN", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@click.argument("out", metavar="OUT", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--rate", type=click.FloatRange(1.0, 1000.0), help="Frames per second of OUT.")
@click.option("--true-rate", type=click.FloatRange(1.0, 1000.0), help="Of IN, if it is wrong.")
@click.option("--from-unit", type=click.Choice(list(UNITS)), help="Of IN; AMC files know theirs.")
@click.option("--to-unit", type=click.Choice(list(UNITS)), help="Of OUT; IN's by default.")
@click.option("--from-up", type=click.Choice(["Y", "Z"]), default="Y", show_default=True)
@click.option("--up", type=click.Choice(["Y", "Z"]), help="Which axis points up in OUT.")
def convert(
    motion: Path,
    out: Path,
    rate: float | None,
    true_rate: float | None,
    from_unit: str | None,
    to_unit: str | None,
    from_up: str,
    up: str | None,
) -> None:
    """Convert a motion file (BVH, AMC with its ASF, npz) on its own skeleton to BVH or npz.

    To bring it onto the reference skeleton, import it with `stridewire library build`.
    """
    writer = _WRITERS.get(out.suffix.lower())
    if writer is None:
        raise click.UsageError(f"cannot write {out.name}; expected {' or '.join(_WRITERS)}")
    try:
        source = _with_true_rate(read_motion(motion), true_rate)
        source = turned_up(source, from_up, up or from_up)
        if to_unit is not None:
            source = scaled(source, _factor(source, from_unit, to_unit))
        if rate is not None:
            source = with_rate(source, rate)
        writer(out, source)
    except (ValueError, OSError) as error:
        raise click.ClickException(str(error)) from None
    for note in source.notes:
        click.echo(f"note: {motion}: {note}", err=True)
    click.echo(
        f"{out}: {len(source)} frames at {source.frame_rate:g} per second, "
        f"{len(source.skeleton)} joints"
    )


def _with_true_rate(source: SourceMotion, true_rate: float | None) -> SourceMotion:
    if true_rate is None and source.frame_rate is None:
        click.echo(f"note: {source.path} says no frame rate; {_ACCLAIM_RATE:g} assumed", err=True)
        true_rate = _ACCLAIM_RATE
    return source if true_rate is None else replace(source, frame_rate=true_rate)


def _factor(source: SourceMotion, from_unit: str | None, to_unit: str) -> float:
    metres = UNITS[from_unit] if from_unit else source.metres_per_unit
    if metres is None:
        raise click.UsageError(f"{source.path} does not say its unit; give it with --from-unit")
    return metres / UNITS[to_unit]
