"""`stridewire library build`: from motion files to a library."""

import shlex
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import click

from stridewire.formats.units import UNITS, parse_unit
from stridewire.motion.clip import Clip
from stridewire_engine.building.build import MatchingOptions, build_library
from stridewire_engine.building.importing import (
    FASTEST,
    SLOWEST,
    Outcome,
    import_files,
    motion_files,
)
from stridewire_engine.building.profiles import Profile, ProfileError, load_profile
from stridewire_engine.building.sidecars import SidecarError, Splits, read_splits
from stridewire_engine.building.tagging import only_tagged, without
from stridewire_engine.commands.library_info import show
from stridewire_engine.commands.matching_options import matching_options
from stridewire_engine.library import LibraryError

_FILE = click.Path(exists=True, dir_okay=False, path_type=Path)


@click.command()
@click.argument("inputs", nargs=-1, required=True, type=click.Path(exists=True, path_type=Path))
@click.option(
    "--out",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to write.",
)
@click.option("--name", help="Name of the library; the folder's by default.")
@click.option("--mirror/--no-mirror", default=True, show_default=True, help="Add mirrored copies.")
@click.option("--profile", "profiles", multiple=True, type=_FILE, help="Joint map to try first.")
@click.option("--rate", type=click.FloatRange(SLOWEST, FASTEST), help="True rate of all files.")
@click.option("--unit", help=f"Of all files ({', '.join(UNITS)}, or metres).")
@click.option("--split", "split", multiple=True, help="Take only files of it; needs --split-file.")
@click.option("--split-file", type=_FILE, help="CSV with the columns data, subject and split.")
@click.option("--tagged", multiple=True, metavar="TAG", help="Keep clips of nothing else.")
@click.option("--without", "cut", multiple=True, metavar="TAG", help="Cut this out of clips.")
@click.option("--jobs", default=2, show_default=True, type=click.IntRange(1, 64), help="Processes.")
@matching_options
@click.option("--licence", default="", help="Licence of the motion.")
@click.option("--credit", default="", help="Credit line of the motion.")
def build(
    inputs: tuple[Path, ...],
    out: Path,
    name: str | None,
    mirror: bool,
    profiles: tuple[Path, ...],
    rate: float | None,
    unit: str | None,
    split: tuple[str, ...],
    split_file: Path | None,
    tagged: tuple[str, ...],
    cut: tuple[str, ...],
    jobs: int,
    licence: str,
    credit: str,
    matching: MatchingOptions,
) -> None:
    """Build a library from motion files (BVH, AMC with its ASF) and folders of them.

    Files that cannot be used are named with the reason; they never stop the others. An index.csv
    beside the files (columns file, fps, subject, description) corrects frame rates and adds tags.
    """
    paths = _files(inputs, split, split_file)
    outcomes = import_files(
        paths,
        profiles=[_profile(path) for path in profiles],
        frame_rate=rate,
        metres_per_unit=_metres(unit),
        jobs=jobs,
    )
    clips = _import(outcomes, len(paths))
    if tagged:
        clips = [clip for clip in clips if only_tagged(clip, tagged)]
        click.echo(f"kept {len(clips)} clips of {', '.join(tagged)}")
    if cut:
        clips = [piece for clip in clips for piece in without(clip, cut)]
        click.echo(f"kept {len(clips)} clips without {', '.join(cut)}")
    if not clips:
        raise click.ClickException("no clip is left; the reasons are above")
    click.echo(f"writing {len(clips)} clips{' and their mirrored copies' if mirror else ''} …")
    try:
        library = build_library(
            clips,
            out,
            name=name or out.resolve().name,
            licence=licence,
            credit=credit,
            mirror=mirror,
            matching=matching,
            build_command=shlex.join(["stridewire", *sys.argv[1:]]),
        )
    except LibraryError as error:
        raise click.ClickException(str(error)) from None
    show(library)


def _files(inputs: Sequence[Path], split: tuple[str, ...], split_file: Path | None) -> list[Path]:
    if bool(split) != bool(split_file):
        raise click.UsageError("--split and --split-file go together")
    try:
        splits = _splits(split, split_file)
        paths = motion_files(inputs, split, splits)
    except (SidecarError, OSError) as error:
        raise click.ClickException(str(error)) from None
    if not paths:
        where = ", ".join(map(str, inputs))
        of = f" of split {' or '.join(split)}" if split else ""
        raise click.ClickException(f"no motion file{of} in {where}; expected .bvh or .amc files")
    return paths


def _splits(split: tuple[str, ...], split_file: Path | None) -> Splits | None:
    if split_file is None:
        return None
    splits = read_splits(split_file)
    if unknown := [name for name in split if name not in splits.names]:
        raise click.UsageError(
            f"--split {unknown[0]!r}; {split_file} has {', '.join(splits.names)}"
        )
    return splits


def _metres(unit: str | None) -> float | None:
    try:
        return parse_unit(unit) if unit else None
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--unit") from None


def _profile(path: Path) -> Profile:
    try:
        return load_profile(path)
    except (ProfileError, OSError) as error:
        raise click.ClickException(str(error)) from None


def _import(outcomes: Iterable[Outcome], files: int) -> list[Clip]:
    """Import with a progress bar; print a line for each file that is refused or odd."""
    clips, lines, units = [], [], Counter[str]()
    try:
        with click.progressbar(
            outcomes, length=files, label="importing", show_pos=True, file=sys.stderr
        ) as bar:
            for outcome in bar:
                if outcome.clip is None:
                    lines.append(f"refused: {outcome.problem}")
                    continue
                clips.append(outcome.clip)
                units[outcome.unit] += 1
                if outcome.notes:
                    lines.append(f"note: {outcome.path}: {'; '.join(outcome.notes)}")
    except SidecarError as error:
        raise click.ClickException(str(error)) from None
    for line in lines:
        click.echo(line, err=True)
    of = ", ".join(f"{count} in {unit}" for unit, count in units.most_common())
    click.echo(
        f"imported {len(clips)} of {files} files{f' ({of})' if of else ''}, "
        f"refused {files - len(clips)}"
    )
    return clips
