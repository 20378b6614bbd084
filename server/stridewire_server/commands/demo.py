"""`stridewire demo`: a real server, a real client, ten seconds at 60 frames a second."""

import json
from pathlib import Path

import click
import numpy as np

from stridewire.client import Client
from stridewire.commands.driven import (
    as_object,
    drive_with_progress,
    spread_out,
    tell,
)
from stridewire.drawing import contact_sheet
from stridewire.formats.bvh_writing import write_bvh
from stridewire.scripts import Controls, script
from stridewire.testing import serve

SCRIPTS = ("walk-turn-stop", "circle", "stop-and-go", "u-turns")
"""What the characters are asked to do, in turn."""


@click.command()
@click.option(
    "--library",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Library or folder of motion files; the embedded synthetic library by default.",
)
@click.option("--seconds", type=click.FloatRange(1.0), default=10.0, show_default=True)
@click.option("--characters", type=click.IntRange(1, 256), default=4, show_default=True)
@click.option(
    "--stitcher", default="", help="What hides transitions; the server's default by default."
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("demo.bvh"),
    show_default=True,
    help="Motion of the first character.",
)
@click.option(
    "--sheet",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("demo.png"),
    show_default=True,
    help="Contact sheet of the first character.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def demo(
    library: Path | None,
    seconds: float,
    characters: int,
    stitcher: str,
    out: Path,
    sheet: Path,
    as_json: bool,
) -> None:
    """Start a server, drive characters over gRPC at wall-clock 60 frames/s, show what came."""
    if not as_json:
        click.echo("starting a server …", err=True)
    with (
        serve(*([] if library is None else [library])) as address,
        Client(address) as client,
        client.open_session(spread_out(characters, stitcher)) as session,
    ):
        run = drive_with_progress(
            session,
            lambda time_s: _controls(time_s, characters),
            seconds,
            realtime=True,
            open_loop=True,
            quiet=as_json,
        )
        opened = session.opened
    clip = run.recording.clip(run.recording.characters[0], "demo", run.rate_hz)
    write_bvh(out, clip)
    contact_sheet(clip, sheet, title=f"demo: {SCRIPTS[0]}, library {opened.library.name}")
    files = (out, sheet)
    if as_json:
        settings = {"scripts": SCRIPTS, "seconds": seconds}
        click.echo(json.dumps(as_object(opened, run, files, settings)))
    else:
        tell(opened, run, files, way="over gRPC")


def _controls(time_s: float, characters: int) -> Controls:
    """Give every character another script."""
    each = [script(name).controls(time_s, characters) for name in SCRIPTS]
    which = np.arange(characters) % len(SCRIPTS)
    rows = np.arange(characters)
    return Controls(
        np.stack([c.velocity for c in each])[which, rows],
        np.stack([c.facing for c in each])[which, rows],
    )
