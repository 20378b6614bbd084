"""`stridewire library fetch`: a public capture, its terms shown first."""

import sys
from pathlib import Path

import click

from stridewire_engine.building.captures import CaptureError, fetch, find_capture


@click.command("fetch")
@click.argument("name")
@click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), help="Folder; the name by default."
)
@click.option("--base-url", help="A mirror, instead of the list's address.")
@click.option("--yes", is_flag=True, help="Do not ask.")
def fetch_capture(name: str, out: Path | None, base_url: str | None, yes: bool) -> None:
    """Fetch the public capture NAME (such as cmu-locomotion, or a .toml list).

    Shows files, licence and credit and asks first. Run it again to go on after an interruption.
    """
    try:
        capture = find_capture(name)
    except (CaptureError, OSError) as error:
        raise click.ClickException(str(error)) from None
    out = out or Path(capture.name)
    motions = sum(file.frame_rate > 0.0 for file in capture.files)
    click.echo(f"{capture.title}\n  {len(capture.files)} files, {motions} of them motions")
    click.echo(f"  from    {base_url or capture.base_url}\n  into    {out}")
    click.echo(f"  licence {capture.licence}\n  credit  {capture.credit}")
    if not yes:
        click.confirm("Fetch them?", abort=True)
    problems = []
    with click.progressbar(
        fetch(capture, out, base_url), length=len(capture.files), label="fetching", file=sys.stderr
    ) as bar:
        for path, problem in bar:
            if problem:
                problems.append(f"failed: {path}: {problem}")
    for line in problems:
        click.echo(line, err=True)
    click.echo(f"{len(capture.files) - len(problems)} of {len(capture.files)} files are in {out}")
    if problems:
        raise click.ClickException("run the same command again to fetch the rest")
    click.echo(
        f"now: stridewire library build {out} --out LIBRARY --licence {capture.licence!r} "
        f"--credit {capture.credit!r}"
    )
