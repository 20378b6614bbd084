"""`stridewire stitch`: one natural motion out of several motion files."""

import json
import re
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click
import numpy as np

from stridewire._messages import MotionFigures, RootPath, StitchQuery, StitchReport
from stridewire.formats.bvh_writing import write_bvh
from stridewire.motion.clip import Clip, Pose
from stridewire_engine.building.importing import import_file
from stridewire_engine.commands.joint_shares import joint_shares
from stridewire_engine.commands.stitch_sheets import draw_seams
from stridewire_engine.stitching import SHORTEST_S, Stitching, method_names, stitching

_DEFAULTS = StitchQuery(())
_SPAN = re.compile(r"(.+)@([\d.]+)-([\d.]+)")
_ROWS = {
    "sliding_c_cm_s": "sliding of planted toes, cm/s",
    "sliding_a_cm_s": "sliding of toes near the ground, cm/s",
    "toe_jerk": "jerk of toes, m/s³",
    "knee_jerk": "jerk of knees, m/s³",
    "seam_step_cm_s": "step of a toe's velocity at a seam, cm/s",
}


@click.command()
@click.argument("clips", metavar="FILE[@START-END]", nargs=-1, required=True)
@click.option(
    "--out", required=True, type=click.Path(dir_okay=False, path_type=Path), help="BVH to write."
)
@click.option(
    "--stitcher",
    type=click.Choice(method_names()),
    default=_DEFAULTS.stitcher,
    show_default=True,
    help="What hides the seams.",
)
@click.option(
    "--window",
    default=_DEFAULTS.window_s,
    show_default=True,
    help="Seconds after a seam in which poses may change.",
)
@click.option(
    "--shift",
    type=float,
    help="Seconds between the network's windows; 0.5, or a shorter window.",
)
@click.option(
    "--passes", default=_DEFAULTS.passes, show_default=True, help="Passes of the network."
)
@click.option(
    "--search-seam",
    default=_DEFAULTS.search_frames,
    show_default=True,
    help="Frames that may be left out at each end of a clip for a better seam.",
)
@click.option(
    "--strength",
    default=_DEFAULTS.strength,
    show_default=True,
    help="Share of the correction, 0 to 1.",
)
@click.option("--mask", multiple=True, metavar="JOINT=SHARE", help="Share that a joint takes.")
@click.option("--from", "start", default=0.0, help="Seconds before which nothing is changed.")
@click.option("--to", "end", default=0.0, help="Seconds after which nothing is changed.")
@click.option(
    "--path",
    "path_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="CSV with rows of seconds, x, z and, if wanted, yaw: where the root is to go.",
)
@click.option(
    "--sheets",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder for contact sheets of each seam, before and after.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def stitch(
    clips: tuple[str, ...],
    out: Path,
    stitcher: str,
    window: float,
    shift: float | None,
    passes: int,
    search_seam: int,
    strength: float,
    mask: tuple[str, ...],
    start: float,
    end: float,
    path_file: Path | None,
    sheets: Path | None,
    as_json: bool,
) -> None:
    """Make one natural motion of motion files, in their order.

    Each is brought onto the reference skeleton at 60 frames/s and set to go on where the one before
    ends. The same files and options give the same motion.
    """
    query = StitchQuery(
        clips,  # type: ignore[arg-type]
        stitcher,
        window,
        shift,
        passes,
        search_seam,
        strength,
        joint_shares(mask),
        start,
        end,
        None if path_file is None else _path(path_file),
    )
    made = stitching(clips, [_read(text) for text in clips], query)
    report = _run(made)
    clip = _clip(out.stem, made)
    write_bvh(out, clip)
    pictures = [] if sheets is None else draw_seams(made, clip, sheets)
    if as_json:
        click.echo(json.dumps(_facts(out, made, report, pictures)))
    else:
        _show(out, made, report, pictures)


def _read(text: str) -> Clip:
    span = None if Path(text).exists() else _SPAN.fullmatch(text)
    clip = import_file(Path(span[1] if span else text), shortest_s=SHORTEST_S).clip
    assert clip is not None
    if span is None:
        return clip
    first_s, last_s = float(span[2]), float(span[3])
    if not first_s < last_s <= clip.seconds + 1e-6:
        raise click.BadParameter(
            f"{text!r}; {span[1]} lasts from 0 to {clip.seconds:.3f} s", param_hint="FILE@START-END"
        )
    return clip.cut(round(first_s * clip.frame_rate), round(last_s * clip.frame_rate) + 1)


def _path(file: Path) -> RootPath:
    try:
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    except ValueError as error:
        raise click.BadParameter(f"{file}: {error}", param_hint="--path") from error
    if rows.shape[1] not in (3, 4):
        raise click.BadParameter(
            f"{file} has {rows.shape[1]} columns; expected seconds, x, z and, if wanted, yaw",
            param_hint="--path",
        )
    return RootPath(rows[:, 1:3], rows[:, 0], rows[:, 3] if rows.shape[1] == 4 else None)


def _run(made: Stitching) -> StitchReport:
    """Stitch, telling on a terminal how far it has come."""
    hidden = not sys.stderr.isatty()
    length = len(made.plan)
    with click.progressbar(
        length=length, label="" if hidden else "stitching", file=sys.stderr, hidden=hidden
    ) as bar:
        for part in made.parts():
            if isinstance(part, Pose):
                bar.update(len(part.hips))
    assert isinstance(part, StitchReport)
    return part


def _clip(name: str, made: Stitching) -> Clip:
    plan = made.plan
    contacts = np.repeat(plan.contacts, 2, axis=1)
    return Clip(
        name, plan.skeleton, plan.frame_rate, made.motion(), contacts, source="stridewire stitch"
    )


def _facts(
    out: Path, made: Stitching, report: StitchReport, pictures: list[Path]
) -> dict[str, Any]:
    return {
        "out": str(out),
        "frames": len(made.plan),
        "frame_rate_hz": made.plan.frame_rate,
        **asdict(report),
        "pictures": [str(picture) for picture in pictures],
    }


def _show(out: Path, made: Stitching, report: StitchReport, pictures: list[Path]) -> None:
    frames, rate = len(made.plan), made.plan.frame_rate
    click.echo(
        f"{out}: {frames} frames, {frames / rate:.1f} s, {len(report.seams)} seam(s), "
        f"{report.changed_frames} frames changed"
    )
    for seam in report.seams:
        why = f" ({seam.reason})" if seam.reason else ""
        cut = f", {seam.cut_before} + {seam.cut_after} frames left out"
        click.echo(
            f"  seam at {seam.frame / rate:.2f} s: {seam.method}{why}"
            f"{cut if seam.cut_before or seam.cut_after else ''}"
        )
    click.echo(f"{'':44}{'before':>9}{'after':>9}{'elsewhere':>11}")
    columns = [report.before, report.after, report.elsewhere]
    for name, label in _ROWS.items():
        values = [_value(figures, name) for figures in columns]
        click.echo(f"{label:44}{values[0]:>9}{values[1]:>9}{values[2]:>11}")
    for picture in pictures:
        click.echo(f"drew {picture}")


def _value(figures: MotionFigures, name: str) -> str:
    return f"{getattr(figures, name):.1f}"
