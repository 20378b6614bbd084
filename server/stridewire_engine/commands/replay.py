"""`stridewire replay`: a recorded session again, or what something else would have made of it."""

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from stridewire import __version__
from stridewire.formats.session_file import Advance, SessionFile
from stridewire_engine.building import open_library
from stridewire_engine.library import Library
from stridewire_engine.replaying.comparison import Track, compare
from stridewire_engine.replaying.replay import Variant, recorded, replay


@click.command("replay")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "--library",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Library of the recording; the embedded synthetic library by default.",
)
@click.option(
    "--against",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Library or folder of motion files to replay over instead; repeatable.",
)
@click.option("--stitch", multiple=True, metavar="NAME", help="Stitcher to use; repeatable.")
@click.option("--weight", "weights", multiple=True, metavar="NAME=W", help="Weight of a channel.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@click.pass_context
def replay_command(
    ctx: click.Context,
    file: Path,
    library: Path | None,
    against: tuple[Path, ...],
    stitch: tuple[str, ...],
    weights: tuple[str, ...],
    as_json: bool,
) -> None:
    """Run the controls of a recorded session again, without a clock.

    By itself it checks that the same comes out: the same clips and times, poses to 1e-5; exits
    with 1 where it does not. With --against, --stitch or --weight it tells what would have been
    different.
    """
    session = SessionFile.open(file)
    alike = not (against or stitch or weights)
    libraries = [open_library(folder) for folder in against] or [original(session, library)]
    variants = [Variant(name, dict(map(_weight, weights))) for name in stitch or ("",)]
    before = Track.of(recorded(session))
    rows = []
    for over in libraries:
        for variant in variants:
            track = Track.of(_with_progress(session, over, variant, as_json))
            told = {"library": over.name, "stitch": variant.stitcher or "as recorded"}
            rows.append({**told, **asdict(compare(track, before))})
    if as_json:
        click.echo(json.dumps({"settings": _settings(session, weights), "rows": rows}))
    else:
        _print(session, rows)
    if alike and not rows[0]["same"]:
        ctx.exit(1)


def original(session: SessionFile, folder: Path | None) -> Library:
    """Open the library that the session was recorded over.

    Raises:
        ValueError: If it is another one.
    """
    library = open_library(folder)
    wanted, found = session.opened.library, library.manifest.content_hash
    if found != wanted.content_hash:
        raise ValueError(
            f"{session.path} was recorded over library {wanted.name!r} "
            f"({wanted.content_hash[:12]}); {library.name!r} holds something else ({found[:12]}): "
            "give that library with "
            "--library FOLDER, or compare another one with --against FOLDER"
        )
    return library


def _with_progress(
    session: SessionFile, library: Library, variant: Variant, quiet: bool
) -> list[Any]:
    if quiet:
        return list(replay(session, library, variant))
    length = sum(isinstance(entry, Advance) for entry in session.entries())
    label = f"{library.name}, {variant.stitcher or 'as recorded'}"
    with click.progressbar(length=length, label=label, file=sys.stderr) as bar:
        return list(replay(session, library, variant, lambda: bar.update(1)))


def _settings(session: SessionFile, weights: tuple[str, ...]) -> dict[str, Any]:
    info = session.opened.library
    return {
        "version": __version__,
        "recording": str(session.path),
        "recorded_version": session.opened.server_version,
        "recorded_library": info.name,
        "recorded_library_hash": info.content_hash,
        "seed": session.opening.seed,
        "weights": dict(map(_weight, weights)),
    }


def _print(session: SessionFile, rows: list[dict[str, Any]]) -> None:
    info = session.opened.library
    click.echo(f"{session.path}: {len(session.opening.characters)} characters over {info.name}")
    head = f"{'library':<18} {'stitch':<12} {'frames':>6} {'jumps':>11} {'shared':>6} "
    click.echo(head + f"{'differs from':>12} {'roots apart':>19} {'joints apart':>12}")
    for row in rows:
        jumps = f"{row['transitions_before']} → {row['transitions']}"
        first = row["first_difference_s"]
        begins = "never" if first is None else f"{first:.2f} s"
        roots = f"{row['root_apart_mean_m']:.3f} ≤ {row['root_apart_max_m']:.3f} m"
        click.echo(
            f"{row['library']:<18} {row['stitch']:<12} {row['frames']:>6} {jumps:>11} "
            f"{row['shared_transitions']:>6} {begins:>12} {roots:>19} "
            f"{row['pose_apart_deg']:>8.2f} deg"
        )
    if all(row["same"] for row in rows):
        click.echo("the same clips and times, poses to 1e-5")


def _weight(text: str) -> tuple[str, float]:
    channel, _, weight = text.partition("=")
    try:
        return channel, float(weight)
    except ValueError:
        raise click.BadParameter(
            f"{text!r}; expected CHANNEL=NUMBER such as foot-position=0.5", param_hint="--weight"
        ) from None
