"""What `stream` and `demo` share: driving with progress, and telling what came of it."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from stridewire._messages import CharacterSpec, GroundPose, Opened
from stridewire._session import Session
from stridewire._version import __version__
from stridewire.driving import Control, Run, drive
from stridewire.formats.writing import write_clip

_SPACING = 2.0


def spread_out(characters: int, stitcher: str = "") -> list[CharacterSpec]:
    """Return characters side by side, two metres apart, looking along +Z."""
    return [
        CharacterSpec(i, GroundPose((_SPACING * i, 0.0, 0.0)), stitcher=stitcher)
        for i in range(characters)
    ]


def drive_with_progress(
    session: Session,
    control: Control,
    seconds: float,
    *,
    realtime: bool,
    open_loop: bool,
    quiet: bool,
) -> Run:
    """Drive a session and show how far it is on standard error."""
    label = f"{len(session.characters)} characters, {seconds:g} s"
    if quiet:
        return drive(session, control, seconds, realtime=realtime, open_loop=open_loop)
    with click.progressbar(
        length=round(seconds * 60.0), label=label, file=sys.stderr, update_min_steps=12
    ) as bar:
        return drive(
            session,
            control,
            seconds,
            realtime=realtime,
            open_loop=open_loop,
            watch=lambda frame: bar.update(1),
        )


def write_motion(run: Run, out: Path, name: str) -> list[Path]:
    """Write what each character did: `walk.bvh`, `walk-2.bvh`, `walk-3.bvh` and so on."""
    paths = []
    for number, character in enumerate(run.recording.characters, start=1):
        path = out if number == 1 else out.with_stem(f"{out.stem}-{number}")
        write_clip(path, run.recording.clip(character, name, run.rate_hz))
        paths.append(path)
    return paths


def as_object(
    opened: Opened, run: Run, files: Sequence[Path], settings: dict[str, Any]
) -> dict[str, Any]:
    """Return the settings and figures of a run as one object for programs."""
    return {
        "settings": {
            "version": __version__,
            "library_hash": opened.library.content_hash,
            "synthetic": opened.library.synthetic,
            "realtime": run.realtime,
            **settings,
        },
        "rows": [
            {
                "library": opened.library.name,
                "characters": len(run.recording.characters),
                "streams": 1,
                **run.figures(),
            }
        ],
        "files": [str(path) for path in files],
    }


def tell(opened: Opened, run: Run, files: Sequence[Path], *, way: str) -> None:
    """Print what came of a run.

    Args:
        opened: Of the session.
        run: The run.
        files: Files written.
        way: How frames came, for instance `over gRPC`.
    """
    info, figures = opened.library, run.figures()
    kind = "synthetic: generated, not captured" if info.synthetic else "captured"
    click.echo(f"library     {info.name} ({kind}; {info.clips} clips, {info.frames} frames)")
    click.echo(f"latency     {_latency(run, figures, way)}")
    if run.realtime:
        click.echo(f"late        {figures['late_pct']:.2f} % of {run.sent} frames")
    click.echo(
        f"transitions {run.transitions} ({figures['transitions_per_s']:.2f} a second and character)"
    )
    if run.share.refined or run.share.reasons:
        click.echo(f"refined     {_refined(run)}")
    click.echo(
        f"sliding     {figures['sliding_c_cm_s']:.2f} cm/s mean planar speed of planted toes, "
        f"{figures['skating_pct']:.1f} % above 10 cm/s"
    )
    for path in files:
        click.echo(f"wrote       {path}")


def _refined(run: Run) -> str:
    share = run.share
    fell_back = ", ".join(
        f"{count} {reason.name.lower().replace('_', ' ')}"
        for reason, count in sorted(share.reasons.items())
    )
    return (
        f"{share.percent:.0f} % of the {share.ended} transitions that the next one ended; "
        f"fell back: {fell_back or 'none'}"
    )


def _latency(run: Run, figures: dict[str, float], way: str) -> str:
    numbers = f"p50 {figures['p50_ms']:.2f} ms, p99 {figures['p99_ms']:.2f} ms {way}"
    if run.realtime:
        return f"{numbers}, from each control's scheduled time to its frame, at 60 frames/s"
    return f"{numbers}, round trips as fast as frames came: not at 60 frames/s"
