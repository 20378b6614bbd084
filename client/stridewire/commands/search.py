"""`stridewire search`: moments of the motion database that fit."""

import json
from dataclasses import asdict
from pathlib import Path

import click

from stridewire._messages import ClipTime, DesiredMotion, Match, SearchResult
from stridewire.commands.targets import connect, target_options


@click.command()
@click.option("--clip", required=True, help="Clip to continue from.")
@click.option("--time", "time_s", default=0.0, show_default=True, help="Seconds within the clip.")
@click.option(
    "--velocity",
    metavar="X,Z",
    help="Desired velocity to the character's left and front, m/s; the clip's by default.",
)
@click.option("--facing", type=float, help="Desired heading relative to the root, radians.")
@click.option("--filter", "tags", default="", help="Tags, such as '(walk | run) & !turn'.")
@click.option("--weight", "weights", multiple=True, metavar="NAME=W", help="Weight of a channel.")
@click.option("--explain", is_flag=True, help="Show costs by channel and what was excluded.")
@click.option("--exclude-itself", is_flag=True, help="Leave out the moment asked about.")
@click.option("-k", "count", default=5, show_default=True, help="Number of matches.")
@click.option("--library-name", default="", help="Library of the server; its default by default.")
@target_options
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def search(
    clip: str,
    time_s: float,
    velocity: str | None,
    facing: float | None,
    tags: str,
    weights: tuple[str, ...],
    explain: bool,
    exclude_itself: bool,
    count: int,
    library_name: str,
    address: str | None,
    library: Path | None,
    as_json: bool,
) -> None:
    """Find the moments that continue best from a moment of a clip."""
    intent = _intent(velocity, facing)
    with connect(address, library) as client:
        result = client.search(
            clip,
            time_s,
            intent,
            k=count,
            library=library_name,
            filter=tags,
            weights=dict(map(_weight, weights)),
            exclude=[ClipTime(clip, time_s)] if exclude_itself else (),
        )
    if as_json:
        click.echo(json.dumps(asdict(result)))
    else:
        _print(result)
        if explain:
            _explain(result)


def _intent(velocity: str | None, facing: float | None) -> DesiredMotion | None:
    if velocity is None:
        if facing is not None:
            raise click.UsageError("--facing needs --velocity; give --velocity 0,0 to stand")
        return None
    try:
        x, z = map(float, velocity.split(","))
    except ValueError:
        raise click.BadParameter(
            f"{velocity!r}; expected two numbers such as 0,1.4", param_hint="--velocity"
        ) from None
    return DesiredMotion(x, z, facing)


def _weight(text: str) -> tuple[str, float]:
    channel, _, weight = text.partition("=")
    try:
        return channel, float(weight)
    except ValueError:
        raise click.BadParameter(
            f"{text!r}; expected CHANNEL=NUMBER such as foot-position=0.5", param_hint="--weight"
        ) from None


def _print(result: SearchResult) -> None:
    click.echo(f"{'clip':<32} {'time':>8}  {'cost':>9}  tags")
    for match in result.matches:
        click.echo(_line(match))


def _line(match: Match) -> str:
    tags = ", ".join(match.tags)
    return f"{match.clip:<32} {match.time_s:>6.2f} s  {match.cost:>9.4f}  {tags}"


def _explain(result: SearchResult) -> None:
    """Show where each cost comes from, what was left out and why, and how sure the search is."""
    channels = list(result.matches[0].channels) if result.matches else []
    click.echo("\ncost by channel")
    click.echo(f"{'clip':<32} {'time':>8}  " + "  ".join(f"{n:>20}" for n in (*channels, "bias")))
    for match in result.matches:
        costs = (*match.channels.values(), match.bias)
        shares = "  ".join(f"{cost:>20.4f}" for cost in costs)
        click.echo(f"{match.clip:<32} {match.time_s:>6.2f} s  {shares}")
    if result.excluded:
        click.echo("\nbetter, but excluded")
        for excluded in result.excluded:
            click.echo(f"{_line(excluded.match)}  ({excluded.reason})")
    looked = "every row" if result.exact else "the nearest lists; `library info` says how sure"
    click.echo(f"\nlooked at {looked}")
