"""`stridewire library profile`: a draft of a joint map for a skeleton that no profile fits."""

from pathlib import Path

import click

from stridewire.formats.reading import read_motion
from stridewire_engine.building.onto_reference import find_profile
from stridewire_engine.building.profile_draft import draft_profile
from stridewire_engine.building.profiles import shipped_profiles


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--name", help="Name of the profile; the file's by default.")
@click.option("--out", type=click.Path(dir_okay=False, path_type=Path), help="Write it here.")
def profile(file: Path, name: str | None, out: Path | None) -> None:
    """Print a joint-map profile for the skeleton of FILE, filled in, with what to check.

    Correct it and give it to `stridewire library build` with --profile.
    """
    try:
        source = read_motion(file)
        fitting = find_profile(source, shipped_profiles())
        draft = draft_profile(source, name or file.stem, f"Skeleton of {file.name}")
    except (ValueError, OSError) as error:
        raise click.ClickException(str(error)) from None
    text = draft.to_toml()
    if out is None:
        click.echo(text, nl=False)
    else:
        out.write_text(text, encoding="utf-8")
    known = fitting.name != "by names"
    said = f"the shipped profile {fitting.name!r} fits" if known else "no shipped profile fits"
    unit = f"its unit is {draft.unit}; " if draft.unit else ""
    click.echo(f"{file}: {said}; {unit}{len(draft.doubts)} thing(s) to check", err=True)
