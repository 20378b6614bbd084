"""`stridewire library`: from capture to a library, and what is in it."""

import json
import shlex
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import click

from stridewire.motion.clip import Clip
from stridewire_engine.building.build import build_library
from stridewire_engine.building.importing import Outcome, import_files, motion_files
from stridewire_engine.library import Library, LibraryError


@click.group()
def library() -> None:
    """Build libraries from motion capture and look into them."""


@library.command()
@click.argument("inputs", nargs=-1, required=True, type=click.Path(exists=True, path_type=Path))
@click.option(
    "--out",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to write.",
)
@click.option("--name", help="Name of the library; the folder's by default.")
@click.option("--mirror/--no-mirror", default=True, show_default=True, help="Add mirrored copies.")
@click.option("--licence", default="", help="Licence of the motion.")
@click.option("--credit", default="", help="Credit line of the motion.")
def build(
    inputs: tuple[Path, ...], out: Path, name: str | None, mirror: bool, licence: str, credit: str
) -> None:
    """Build a library from motion files (BVH) and folders of them."""
    paths = motion_files(inputs)
    if not paths:
        raise click.ClickException(
            f"no motion file in {', '.join(map(str, inputs))}; expected .bvh files"
        )
    clips = _import(paths)
    if not clips:
        raise click.ClickException("no file could be imported; the reasons are above")
    click.echo(f"writing {len(clips)} clips{' and their mirrored copies' if mirror else ''} …")
    command = shlex.join(
        ["stridewire", "library", "build", *map(str, inputs), "--out", str(out)]
        + (["--name", name] if name else [])
        + ([] if mirror else ["--no-mirror"])
    )
    try:
        built = build_library(
            clips,
            out,
            name=name or out.resolve().name,
            synthetic=False,
            licence=licence,
            credit=credit,
            mirror=mirror,
            build_command=command,
        )
    except LibraryError as error:
        raise click.ClickException(str(error)) from None
    _show(built)


@library.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def info(folder: Path, as_json: bool) -> None:
    """Say what is in a library."""
    try:
        opened = Library.open(folder)
    except LibraryError as error:
        raise click.ClickException(str(error)) from None
    if as_json:
        click.echo(json.dumps(_facts(opened), indent=2))
    else:
        _show(opened)


def _import(paths: Sequence[Path]) -> list[Clip]:
    """Import with a progress bar; print a line for each file that is refused or odd."""
    clips = []
    refused: list[Outcome] = []
    odd: list[Outcome] = []
    with click.progressbar(
        import_files(paths), length=len(paths), label="importing", show_pos=True
    ) as outcomes:
        for outcome in outcomes:
            if outcome.clip is None:
                refused.append(outcome)
            else:
                clips.append(outcome.clip)
                odd += [outcome] if outcome.notes else []
    for outcome in odd:
        click.echo(f"note: {outcome.path}: {'; '.join(outcome.notes)}", err=True)
    for outcome in refused:
        click.echo(f"refused: {outcome.problem}", err=True)
    click.echo(f"imported {len(clips)} of {len(paths)} files")
    return clips


def _facts(opened: Library) -> dict[str, object]:
    seconds = sum(clip.frames for clip in opened.clips) / opened.frame_rate
    return {
        **asdict(opened.info()),
        "path": str(opened.path),
        "seconds": round(seconds, 2),
        "seconds_by_tag": {tag: round(s, 2) for tag, s in opened.seconds_by_tag().items()},
    }


def _show(opened: Library) -> None:
    about = opened.info()
    seconds = about.frames / about.frame_rate_hz
    click.echo(f"library {about.name} in {opened.path}")
    click.echo(
        f"  {about.clips} clips, {about.frames} frames, {seconds / 60:.1f} min at "
        f"{about.frame_rate_hz:g} frames/s; {'synthetic' if about.synthetic else 'captured'}"
    )
    for label, text in (("licence", about.licence), ("credit", about.credit)):
        click.echo(f"  {label}: {text or 'not given'}")
    for tag, held in opened.seconds_by_tag().items():
        click.echo(f"  {tag:<16}{held:9.1f} s")
