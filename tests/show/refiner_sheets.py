"""Contact sheets of the refiner: springs above it, what the actor did below, to be looked at.

Pairs of test subjects under their own path; discs lie under the toes that the actor had planted.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from judge_results import QUOTED, library
from matplotlib.image import imread, imsave
from points import ROOT, Point

from stridewire.drawing import contact_sheet
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.evaluation.seam_methods import Method, plain_methods, refined
from stridewire_engine.evaluation.seams import Windows
from stridewire_engine.networks.rmr import shipped_refiner
from stridewire_engine.networks.rmr.pairs import PairMaker
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.networks.rmr.takes import Takes

FOLDER = ROOT / "build" / "show" / "refiner"
_STRIDE = 20
_EDGE = 12
_LEAST_AFTER = 25
"""Frames after a pair's first seam, so that there is something to see."""


def sheets() -> Iterator[Point]:
    """A walk out of step, walk to run, run to stop, a turn; those that do so the most."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    plain = plain_methods()
    methods = {
        "spring": plain["spring"],
        "refine": refined(shipped_refiner()),
        "actor": plain["truth"],
    }
    for name in QUOTED:
        windows = _windows(name)
        for kind, score in _scores(windows).items():
            best = int(np.argmax(score))
            if score[best] <= 0.0:
                yield Point(f"{kind}, {name}", "not among the pairs")
                continue
            path = FOLDER / f"{name}-{kind.replace(' ', '-')}.png"
            _draw(windows, best, methods, kind, path)
            yield Point(f"{kind}, {name}", f"{path.relative_to(ROOT)}, to be looked at")


def _windows(name: str) -> Windows:
    clips = library(name)
    takes = Takes.of(
        clips.clip(entry.name) for entry in clips.clips if not entry.name.endswith("-mirrored")
    )
    first = takes.windows(_STRIDE)
    first = first[takes.clip[first] < takes.originals]
    pairs = PairMaker(takes).make(first, np.random.default_rng(0))
    root, yaw = takes.root_path(pairs.truth)
    return Windows(takes, pairs, root, yaw)


def _scores(windows: Windows) -> Mapping[str, Floats]:
    """Return how much each pair `(N,)` is of each kind; 0 where it is none."""
    takes, pairs = windows.takes, windows.pairs
    speed = FRAME_RATE * np.linalg.norm(np.diff(windows.root[..., ::2], axis=1), axis=-1)
    begins, ends = speed[:, :_EDGE].mean(axis=1), speed[:, -_EDGE:].mean(axis=1)
    turned = np.abs(windows.yaw[:, -1] - windows.yaw[:, 0])
    after = np.cumsum(pairs.starts, axis=1) > 0
    differs = takes.contacts[pairs.rows] != takes.contacts[pairs.truth]
    out_of_step = (differs.any(axis=-1) & after).sum(axis=1) / after.sum(axis=1)
    walks = (begins > 0.8) & (ends > 0.8) & (begins < 1.9) & (ends < 1.9)
    room = after.sum(axis=1) >= _LEAST_AFTER
    return {
        "walk out of step": out_of_step * (walks & (turned < 0.3) & room),
        "walk to run": (ends - begins) * ((begins > 0.5) & (begins < 2.0) & (ends > 2.2) & room),
        "run to stop": (begins - ends) * ((begins > 2.0) & (ends < 1.0) & room),
        "turn": turned * ((begins > 0.5) & (ends > 0.5) & room),
    }


def _draw(
    windows: Windows, which: int, methods: Mapping[str, Method], kind: str, path: Path
) -> None:
    one = slice(which, which + 1)
    part = Windows(windows.takes, windows.pairs[one], windows.root[one], windows.yaw[one])
    seams = ", ".join(
        f"{frame / FRAME_RATE:.2f} s" for frame in np.flatnonzero(part.pairs.starts[0])
    )
    strips = []
    for name, method in methods.items():
        made = method(part)
        pose = Pose(part.root[0], quaternion.from_yaw(part.yaw[0]), made.hips[0], made.rotations[0])
        planted = np.zeros((len(part.yaw[0]), 4), bool)
        planted[:, 1::2] = windows.takes.contacts[part.pairs.truth[0]]
        contact_sheet(
            Clip(name, REFERENCE, FRAME_RATE, pose, planted),
            path,
            title=f"{kind}: {name}, seams at {seams}",
            columns=10,
            rows=1,
        )
        strips.append(imread(path))
    imsave(path, np.concatenate(strips))
