"""`stridewire explain`: why a recorded character showed what it showed, frame by frame."""

import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from stridewire import __version__
from stridewire._messages import Match
from stridewire.formats.session_file import Advance, SessionFile
from stridewire_engine.commands.explain_timeline import draw_timeline
from stridewire_engine.commands.replay import original
from stridewire_engine.replaying.inspection import Moment, inspect


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "--library",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Library of the recording; the embedded synthetic library by default.",
)
@click.option("--character", type=int, help="Id; the first one by default.")
@click.option("--frame", type=click.IntRange(1), help="Frame to explain.")
@click.option("--at", "at_s", type=float, help="Or the session's time of it, in seconds.")
@click.option("--png", type=click.Path(dir_okay=False, path_type=Path), help="Draw a timeline.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def explain(
    file: Path,
    library: Path | None,
    character: int | None,
    frame: int | None,
    at_s: float | None,
    png: Path | None,
    as_json: bool,
) -> None:
    """Explain a recorded session: which clip played, what else fitted, why it jumped or stayed.

    Without --frame or --at one line for each jump is printed; with one of them that frame alone,
    with its candidates, their cost by channel, and what the stitcher hid.
    """
    if frame is not None and at_s is not None:
        raise click.UsageError("--frame and --at name the same thing; give one of them")
    session = SessionFile.open(file)
    who = session.opening.characters[0].id if character is None else character
    moments = _moments(session, library, who, as_json)
    if not moments:
        raise ValueError(f"{file} has no character {who} in any frame")
    chosen = _chosen(moments, frame, at_s)
    if png is not None:
        draw_timeline(moments, png, None if chosen is None else chosen.frame)
        click.echo(f"drawn: {png}", err=True)
    if as_json:
        settings = {"version": __version__, "recording": str(file), "character": who}
        rows = [asdict(moment) for moment in (moments if chosen is None else [chosen])]
        click.echo(json.dumps({"settings": settings, "rows": rows}))
    elif chosen is not None:
        _print_one(chosen)
    else:
        _print_jumps(moments)


def _moments(
    session: SessionFile, library: Path | None, character: int, quiet: bool
) -> list[Moment]:
    found = inspect(session, original(session, library), character)
    if quiet:
        return list(found)
    length = sum(isinstance(entry, Advance) for entry in session.entries())
    with click.progressbar(found, length=length, label="replaying", file=sys.stderr) as moments:
        return list(moments)


def _chosen(moments: Sequence[Moment], frame: int | None, at_s: float | None) -> Moment | None:
    if frame is None and at_s is None:
        return None
    for moment in moments:
        if moment.frame == frame or (at_s is not None and moment.time_s >= at_s - 1e-6):
            return moment
    first, last = moments[0], moments[-1]
    raise ValueError(
        f"no such frame; the character is there from frame {first.frame} ({first.time_s:.2f} s) to "
        f"{last.frame} ({last.time_s:.2f} s)"
    )


def _print_jumps(moments: Sequence[Moment]) -> None:
    click.echo(f"{'frame':>6} {'time':>7}  {'why':<15} {'hidden':>8}  what")
    for moment in moments:
        if moment.transition is not None:
            click.echo(
                f"{moment.frame:>6} {moment.time_s:>5.2f} s  {moment.reason:<15} "
                f"{moment.hidden.mean_cm:>5.1f} cm  {moment.verdict}"
            )
    searched = sum(moment.searched for moment in moments)
    jumps = sum(moment.transition is not None for moment in moments)
    click.echo(f"{len(moments)} frames, {searched} searches, {jumps} jumps")


def _print_one(moment: Moment) -> None:
    click.echo(
        f"frame {moment.frame}, {moment.time_s:.2f} s: plays {moment.clip} at "
        f"{moment.clip_time_s:.2f} s"
    )
    click.echo(f"search: {moment.reason or 'none was due'}; next in {moment.next_search_s:.2f} s")
    click.echo(moment.verdict)
    click.echo(
        f"hidden: joints {moment.hidden.mean_cm:.1f} cm off the clip, "
        f"{moment.hidden.joint} the most with {moment.hidden.most_cm:.1f} cm"
    )
    click.echo(f"speed: {moment.speed:.2f} m/s, asked for {moment.asked_speed:.2f} m/s")
    names = list(moment.candidates[0].channels) if moment.candidates else []
    head = "".join(f"{name:>22}" for name in names)
    click.echo(f"\n{'':<10}{'clip':<34}{'time':>8}{'cost':>9}{'tag bias':>10}{head}  note")
    if moment.stay is not None:
        note = f"has to be beaten by {moment.bias:.3f}"
        click.echo(_line("stay", moment.stay, names, note))
    for match in moment.candidates:
        click.echo(_line("candidate", match, names, " ".join(match.tags)))
    for excluded in moment.excluded:
        click.echo(_line("excluded", excluded.match, names, excluded.reason))


def _line(kind: str, match: Match, names: Sequence[str], note: str) -> str:
    parts: list[Any] = [f"{match.channels[name]:>22.3f}" for name in names]
    return (
        f"{kind:<10}{match.clip[:33]:<34}{match.time_s:>6.2f} s{match.cost:>9.3f}"
        f"{match.bias:>10.3f}{''.join(parts)}  {note}"
    )
