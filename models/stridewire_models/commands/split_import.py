"""Importing the clips of a split, with a progress bar."""

from pathlib import Path

import click

from stridewire.motion.clip import Clip
from stridewire_engine.evaluation.split_clips import import_clips, split_files

split_option = click.option(
    "--data",
    envvar="STRIDEWIRE_DATA",
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder with split.csv and the unpacked CMU trials; STRIDEWIRE_DATA by default.",
)
"""Where a training's people are."""


def clips_of(data: Path, split: str, quiet: bool, name: str = "cmu") -> list[Clip]:
    """Import the clips of a data set's split.

    Args:
        data: Folder that holds `split.csv` and the data sets.
        split: `train`, `validation` or `test`.
        quiet: Whether to show no progress.
        name: Of the data set.
    """
    files = split_files(data, name, split)
    with click.progressbar(
        import_clips(files), length=len(files), label=f"importing {split}", hidden=quiet
    ) as clips:
        return [clip for clip in clips if clip is not None]
