"""`stridewire blend`: postures between two moments of motion files."""

import json
from dataclasses import replace
from pathlib import Path

import click
import numpy as np

from stridewire._messages import BlendMethod
from stridewire.formats.writing import find_writer, write_clip
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.blending import Blended, Pair
from stridewire_engine.blending import blend as blend_pairs
from stridewire_engine.building.importing import import_file
from stridewire_engine.commands.joint_shares import joint_shares
from stridewire_engine.networks.blend import blend_network

_METHODS = {method.name.lower(): method for method in BlendMethod}
_FRAME_RATE = 30.0


@click.command()
@click.option("--start", required=True, metavar="FILE@SECONDS", help="Posture at weight 0.")
@click.option("--end", required=True, metavar="FILE@SECONDS", help="Posture at weight 1.")
@click.option(
    "--weights", default="0,0.25,0.5,0.75,1", show_default=True, help="Weights, 0 to 1, by commas."
)
@click.option("--method", type=click.Choice(list(_METHODS)), default="auto", show_default=True)
@click.option("--mask", multiple=True, metavar="JOINT=SHARE", help="Share that a joint takes.")
@click.option("--ground", default=0.0, show_default=True, help="Height of the ground, metres.")
@click.option(
    "--duration",
    type=click.FloatRange(0.0, 3600.0),
    help="Seconds between the postures; by default what lies between them in one file.",
)
@click.option(
    "--out",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="BVH, GLB or npz to write, a frame for each weight.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def blend(
    start: str,
    end: str,
    weights: str,
    method: str,
    mask: tuple[str, ...],
    ground: float,
    duration: float | None,
    out: Path,
    as_json: bool,
) -> None:
    """Write the postures between two postures of motion files.

    Both are brought onto the reference skeleton. An end from another file is moved to where the
    start stands.
    """
    find_writer(out)
    pair = _pair(start, end, duration)
    pair = replace(
        pair,
        weights=_weights(weights),
        shares=_shares(mask),
        method=_METHODS[method],
        ground=ground,
    )
    (blended,) = blend_pairs([pair], blend_network())
    write_clip(out, _clip(out.stem, blended))
    facts = {
        "out": str(out),
        "frames": len(pair.weights),
        "method": blended.method.name.lower(),
        "reason": blended.reason,
    }
    if as_json:
        click.echo(json.dumps(facts))
    else:
        why = f" ({blended.reason})" if blended.reason else ""
        click.echo(f"{out}: {len(pair.weights)} postures, {facts['method']}{why}")


def _pair(start: str, end: str, duration: float | None) -> Pair:
    (first, first_s), (last, last_s) = _moment("--start", start), _moment("--end", end)
    clips = {path: _read(path) for path in {first, last}}
    a = _sample(clips[first], "--start", first_s)
    b = _sample(clips[last], "--end", last_s)
    between = max(last_s - first_s, 0.0)
    if first != last:
        b = replace(b, root_position=a.root_position, root_rotation=a.root_rotation)
        between = 0.0
    none = np.ones(1)
    return Pair(a, b, none, none, duration=between if duration is None else duration)


def _moment(option: str, text: str) -> tuple[Path, float]:
    path, _, seconds = text.rpartition("@")
    try:
        if not path:
            raise ValueError
        return Path(path), float(seconds)
    except ValueError:
        raise click.BadParameter(
            f"{text!r}; expected FILE@SECONDS such as walk.bvh@1.5", param_hint=option
        ) from None


def _read(path: Path) -> Clip:
    clip = import_file(path).clip
    assert clip is not None
    return clip


def _sample(clip: Clip, option: str, seconds: float) -> Pose:
    if not 0.0 <= seconds <= clip.seconds:
        raise click.BadParameter(
            f"{seconds:g} s; {clip.source} lasts from 0 to {clip.seconds:.3f} s", param_hint=option
        )
    return clip.sample(seconds)


def _weights(text: str) -> Floats:
    try:
        weights = np.array([float(part) for part in text.split(",")])
    except ValueError:
        weights = np.array([np.nan])
    if not np.all((weights >= 0.0) & (weights <= 1.0)):
        raise click.BadParameter(
            f"{text!r}; expected numbers from 0 to 1 such as 0,0.5,1", param_hint="--weights"
        )
    return weights


def _shares(mask: tuple[str, ...]) -> Floats:
    shares = joint_shares(mask)
    return np.array([shares.get(name, 1.0) for name in REFERENCE.names])


def _clip(name: str, blended: Blended) -> Clip:
    nowhere = np.zeros((len(blended.pose.hips), 4), np.bool_)
    return Clip(name, REFERENCE, _FRAME_RATE, blended.pose, nowhere, source="stridewire blend")
