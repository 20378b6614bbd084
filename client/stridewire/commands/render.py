"""`stridewire render`: a motion file as a contact sheet, or as an animated picture."""

import json
from pathlib import Path

import click

from stridewire.drawing import Subject, draw_animation, draw_contact_sheet
from stridewire.formats.reading import read_motion


@click.command()
@click.argument("motion", metavar="MOTION", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    help="PNG to write; beside the input by default.",
)
@click.option(
    "--animate",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Animated WebP or GIF to write instead.",
)
@click.option("--start", default=0.0, show_default=True, help="Begin in seconds.")
@click.option("--end", type=float, help="End in seconds; the file's by default.")
@click.option(
    "--rate",
    type=click.FloatRange(1.0, 1000.0),
    help="Frames per second, for files that do not say (AMC) or say it wrong.",
)
@click.option("--title", help="Title; the file's name by default.")
@click.option("--columns", type=click.IntRange(4, 24), default=8, show_default=True)
@click.option("--rows", type=click.IntRange(1, 24), default=2, show_default=True)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def render(
    motion: Path,
    out: Path | None,
    animate: Path | None,
    start: float,
    end: float | None,
    rate: float | None,
    title: str | None,
    columns: int,
    rows: int,
    as_json: bool,
) -> None:
    """Draw a motion file (BVH, AMC beside its ASF, npz, glTF) as a contact sheet.

    Shows figures at even times, the way from above, the feet and the speed over time; with
    --animate a figure that moves.
    """
    if out and animate:
        raise click.UsageError("--out is a contact sheet, --animate an animated picture: give one")
    picture = animate or out or motion.with_suffix(".png")
    source = read_motion(motion)
    if source.frame_rate is None and rate is None:
        raise click.UsageError(f"{motion} does not say its frame rate; give it with --rate")
    subject = Subject.of_source(source, rate)
    subject = subject.between(start, subject.seconds if end is None else end)
    if animate:
        draw_animation(subject, animate)
    else:
        draw_contact_sheet(subject, picture, title=title, columns=columns, rows=rows)
    facts = {
        "picture": str(picture),
        "motion": str(motion),
        "frames": len(subject.positions),
        "frame_rate_hz": subject.frame_rate,
        "seconds": subject.seconds,
        "joints": len(subject.parents),
    }
    if as_json:
        click.echo(json.dumps(facts))
    else:
        click.echo(
            f"{picture}: {subject.seconds:.1f} s of {motion}, {len(subject.positions)} frames"
        )
