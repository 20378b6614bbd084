"""`stridewire convert`: motion files from one format, rate, unit, axis or skeleton to another."""

from dataclasses import replace
from pathlib import Path

import click

from stridewire._errors import StridewireError
from stridewire.formats.conversion import scaled, turned_up, with_rate
from stridewire.formats.reading import read_motion
from stridewire.formats.retargeting import find_retargeting
from stridewire.formats.source_motion import SourceMotion
from stridewire.formats.units import UNITS, likely_unit, parse_unit, unit_name
from stridewire.formats.writing import find_writer

_ACCLAIM_RATE = 120.0


_UNIT_HELP = f"({', '.join(UNITS)}, or metres)"


@click.command()
@click.argument(
    "motion", metavar="IN", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@click.argument("out", metavar="OUT", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--rate", type=click.FloatRange(1.0, 1000.0), help="Frames per second of OUT.")
@click.option("--true-rate", type=click.FloatRange(1.0, 1000.0), help="Of IN, if it is wrong.")
@click.option("--unit", "from_unit", help=f"Of IN {_UNIT_HELP}; AMC know theirs.")
@click.option("--to-unit", help=f"Of OUT {_UNIT_HELP}; IN's by default.")
@click.option("--from-up", type=click.Choice(["Y", "Z"]), default="Y", show_default=True)
@click.option("--up", type=click.Choice(["Y", "Z"]), help="Which axis points up in OUT.")
@click.option("--skeleton", help="Bring it onto this skeleton: `reference`.")
def convert(
    motion: Path,
    out: Path,
    rate: float | None,
    true_rate: float | None,
    from_unit: str | None,
    to_unit: str | None,
    from_up: str,
    up: str | None,
    skeleton: str | None,
) -> None:
    """Convert a motion file (BVH, AMC with its ASF, npz, glTF) to BVH, npz or GLB.

    On its own skeleton whatever it is, or brought onto the reference skeleton as `stridewire
    library build` does it: Y up, on the ground, in centimetres unless --to-unit says another. A
    GLB is in metres, Y up, with a simple body for its skeleton.
    """
    try:
        writer = find_writer(out)
    except ValueError as error:
        raise click.UsageError(str(error)) from None
    if is_gltf := out.suffix.lower() == ".glb":
        if to_unit is not None or up == "Z":
            raise click.UsageError("a GLB is in metres, Y up: leave out --to-unit and --up Z")
        up = "Y"
    try:
        source = _with_true_rate(read_motion(motion), true_rate)
        given = parse_unit(from_unit) if from_unit else None
        source = source if given is None else replace(source, metres_per_unit=given)
        if skeleton is not None:
            source = find_retargeting(skeleton)(turned_up(source, from_up, "Y"), given)
            from_up = "Y"
        source = turned_up(source, from_up, up or from_up)
        if is_gltf and source.metres_per_unit is None:
            source = _with_likely_unit(source)
        if to_unit is not None:
            source = scaled(source, _metres(source) / parse_unit(to_unit))
        if rate is not None:
            source = with_rate(source, rate)
        writer(out, source)
    except (ValueError, OSError, StridewireError) as error:
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


def _with_likely_unit(source: SourceMotion) -> SourceMotion:
    metres = likely_unit(source.skeleton)
    name = unit_name(metres)
    click.echo(f"note: {source.path} says no unit; {name} by its size (--unit is yours)", err=True)
    return replace(source, metres_per_unit=metres)


def _metres(source: SourceMotion) -> float:
    if source.metres_per_unit is None:
        raise click.UsageError(f"{source.path} does not say its unit; give it with --unit")
    return source.metres_per_unit
