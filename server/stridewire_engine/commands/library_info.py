"""`stridewire library info`: what is in a library."""

import json
from dataclasses import asdict
from pathlib import Path

import click

from stridewire_engine.library import Library, LibraryError


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def info(folder: Path, as_json: bool) -> None:
    """Say what is in a library, and check that it is whole."""
    library = open_library(folder)
    try:
        library.verify()
    except LibraryError as error:
        raise click.ClickException(str(error)) from None
    if as_json:
        click.echo(json.dumps(_facts(library), indent=2))
    else:
        show(library)


def open_library(folder: Path) -> Library:
    """Open a library or end the command with its error."""
    try:
        return Library.open(folder)
    except LibraryError as error:
        raise click.ClickException(str(error)) from None


def show(library: Library) -> None:
    """Print a library in a few lines."""
    about = library.info()
    seconds = about.frames / about.frame_rate_hz
    click.echo(f"library {about.name} in {library.path}")
    click.echo(
        f"  {about.clips} clips, {about.frames} frames, {seconds / 60:.1f} min at "
        f"{about.frame_rate_hz:g} frames/s; {'synthetic' if about.synthetic else 'captured'}"
    )
    for label, text in (("licence", about.licence), ("credit", about.credit)):
        click.echo(f"  {label}: {text or 'not given'}")
    click.echo(f"  {_search_line(library)}")
    for tag, held in library.seconds_by_tag().items():
        click.echo(f"  {tag:<16}{held:9.1f} s")


def _search_line(library: Library) -> str:
    """Say what is matched and how sure the search is."""
    schema = library.manifest.schema
    proof = schema["proof"]
    start = f"search: schema {schema['name']}, {proof['rows']} moments, {proof['index']}"
    if proof["index"] == "exact":
        return start
    worst = proof["worst_cell"]
    where = f"{worst['weights']} weights, filter {worst['filter'] or 'none'}"
    return (
        f"{start}, {proof['probes']} looked into; best row found in {100 * worst['recall']:.1f} % "
        f"at worst ({where}), cost ratio {proof['worst_cost_ratio']:.4f} at worst"
    )


def _facts(library: Library) -> dict[str, object]:
    seconds = sum(clip.frames for clip in library.clips) / library.frame_rate
    return {
        **asdict(library.info()),
        "path": str(library.path),
        "proof": library.manifest.schema["proof"],
        "seconds": round(seconds, 2),
        "seconds_by_tag": {tag: round(s, 2) for tag, s in library.seconds_by_tag().items()},
    }
