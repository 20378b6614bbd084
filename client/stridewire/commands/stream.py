"""`stridewire stream`: drive characters by a script and keep what they did."""

import json
from functools import partial
from pathlib import Path

import click

from stridewire.commands.driven import (
    as_object,
    drive_with_progress,
    spread_out,
    tell,
    write_motion,
)
from stridewire.commands.targets import connect, target_options
from stridewire.formats.writing import find_writer
from stridewire.scripts import SCRIPT_NAMES, script


@click.command()
@click.option(
    "--script",
    "script_name",
    type=click.Choice(SCRIPT_NAMES),
    default="walk-turn-stop",
    show_default=True,
    help="What the characters are asked to do.",
)
@click.option("--seconds", type=click.FloatRange(0.1), default=10.0, show_default=True)
@click.option("--characters", type=click.IntRange(1, 4096), default=1, show_default=True)
@click.option("--seed", default=0, show_default=True, help="Seed of the script and the session.")
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    help="BVH, GLB or npz to write, and one more file for each further character.",
)
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File to record the session in, for `stridewire replay`.",
)
@click.option("--library-name", default="", help="Library of the server; its default by default.")
@target_options
@click.option(
    "--realtime/--no-realtime",
    default=None,
    help="At wall-clock 60 frames/s, or as fast as frames come; with a server realtime by default.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def stream(
    script_name: str,
    seconds: float,
    characters: int,
    seed: int,
    out: Path | None,
    record: Path | None,
    library_name: str,
    address: str | None,
    library: Path | None,
    realtime: bool | None,
    as_json: bool,
) -> None:
    """Drive characters by a script; record, measure, write motion files."""
    if out:
        find_writer(out)
    control = partial(script(script_name).controls, characters=characters, seed=seed)
    paced = library is None if realtime is None else realtime
    with (
        connect(address, library, record) as client,
        client.open_session(spread_out(characters), library=library_name, seed=seed) as session,
    ):
        run = drive_with_progress(
            session, control, seconds, realtime=paced, open_loop=library is None, quiet=as_json
        )
        opened = session.opened
    files = write_motion(run, out, script_name) if out else []
    files += [record] if record else []
    if as_json:
        settings = {"script": script_name, "seconds": seconds, "seed": seed}
        click.echo(json.dumps(as_object(opened, run, files, settings)))
    else:
        tell(opened, run, files, way="over gRPC" if library is None else "in this process")
