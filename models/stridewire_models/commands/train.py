"""`stridewire train`: from captured motion to the weights that ship."""

import json
import time
from pathlib import Path

import click

from stridewire.motion.mirror import mirror_clip
from stridewire_models.commands.train_blend import blend
from stridewire_models.commands.train_rmr import rmr
from stridewire_models.commands.train_rmr_tables import rmr_tables
from stridewire_models.gait.fitting import fit
from stridewire_models.gait.measuring import Standing, Steps, measure_standing, measure_steps
from stridewire_models.gait.takes import Take, load_takes, take_files


@click.group()
def train() -> None:
    """Train the models that ship."""


train.add_command(blend)
train.add_command(rmr)
train.add_command(rmr_tables)


@train.command()
@click.option(
    "--data",
    envvar="STRIDEWIRE_DATA",
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder with the unpacked CMU trials; STRIDEWIRE_DATA by default.",
)
@click.option(
    "--out",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to write gait.npz and gait.json into.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def gait(data: Path, out: Path, as_json: bool) -> None:
    """Fit the gait model that synthetic libraries are drawn from (numpy and scipy only)."""
    start = time.monotonic()
    files = take_files(data)
    steps: list[Steps] = []
    standing: list[Standing] = []
    with click.progressbar(
        load_takes(files), length=len(files), label="importing", hidden=as_json
    ) as takes:
        for take in takes:
            _measure(take, steps, standing)
    model = fit(steps, standing)
    out.mkdir(parents=True, exist_ok=True)
    with (out / "gait.npz").open("wb") as file:
        model.save(file)
    facts = {
        "weights": str(out / "gait.npz"),
        "bytes": (out / "gait.npz").stat().st_size,
        "takes": len(files),
        "subjects": len({s.subject for s in steps}),
        # mirrored copies are counted with their originals
        "walk_steps": _count(steps, run=False) // 2,
        "run_steps": _count(steps, run=True) // 2,
        "standing_s": round(sum(len(s.rotations) for s in standing) / 120.0, 1),
        "seconds": round(time.monotonic() - start, 1),
    }
    (out / "gait.json").write_text(json.dumps(facts, indent=1) + "\n")
    click.echo(json.dumps(facts) if as_json else _sentence(facts))


def _measure(take: Take, steps: list[Steps], standing: list[Standing]) -> None:
    """Add what a take and its mirrored copy hold."""
    for clip in (take.clip, mirror_clip(take.clip)):
        walked, stood = measure_steps(clip, take.subject), measure_standing(clip, take.subject)
        if walked is not None:
            steps.append(walked)
        if stood is not None:
            standing.append(stood)


def _count(steps: list[Steps], run: bool) -> int:
    return sum(len(set(s.step[s.run == run].tolist())) for s in steps)


def _sentence(facts: dict[str, object]) -> str:
    return (
        "{weights}: {bytes} bytes from {walk_steps} steps of walking and {run_steps} of running "
        "by {subjects} subjects in {takes} takes, {seconds} s"
    ).format(**facts)
