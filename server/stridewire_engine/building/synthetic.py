"""The synthetic library: clips drawn from the gait model, out of nothing but a seed.

They are what the service runs on until it is given capture, and what tests run on; they carry exact
contacts. No frame of them is a captured one.
"""

from collections.abc import Iterator

import numpy as np

from stridewire.motion.clip import Clip
from stridewire_engine.building.gait.draw import draw_clip, reverse
from stridewire_engine.building.gait.model import GaitModel
from stridewire_engine.building.gait.script import Segment

CREDIT = (
    "Drawn by Stridewire from a gait model fitted on captured motion. The data used in this "
    "project was obtained from mocap.cs.cmu.edu. The database was created with funding from NSF "
    "EIA-0196217."
)
"""Credit line of every synthetic library."""

_Script = list[Segment]
_SHUFFLE = [
    Segment(3.0),
    Segment(0.8, turn=0.6),
    Segment(3.0),
    Segment(0.7, side=0.15),
    Segment(2.0),
    Segment(0.8, turn=-0.6),
    Segment(3.0),
]
_WALKS = (0.5, 0.8, 1.1, 1.4, 1.7)
_JOGS = (2.2, 2.6)
_RUNS = (3.0, 3.5, 4.0)
_WALK_CURVES = ((0.8, 0.9), (0.9, 1.6), (1.3, 0.35), (1.3, 0.7), (1.2, 1.1))
_RUN_CURVES = ((2.3, 0.5), (2.5, 0.8), (3.3, 0.3), (3.3, 0.6), (3.0, 0.2), (3.7, 0.4))


def synthetic_clips(seed: int = 0) -> list[Clip]:
    """Draw the clips of the synthetic library at 60 frames/s on the reference skeleton.

    Idle, walking and running at 0.5 to 4 m/s, curves, turns, starts, stops, changes of gait,
    backward and sideways; tags by what the script asks for.

    Args:
        seed: Same seed, same clips.
    """
    rng = np.random.default_rng(seed)
    model = GaitModel.shipped()
    clips = [draw_clip(model, name, script, rng) for name, script in _forward(rng)]
    return clips + [reverse(draw_clip(model, name, script, rng)) for name, script in _backward()]


def _forward(rng: np.random.Generator) -> Iterator[tuple[str, _Script]]:
    for number in (1, 2):
        yield f"idle-{number}", [Segment(12.0)]
    yield "idle-shuffle", _SHUFFLE
    yield from _steady()
    yield from _curves()
    yield from _changes()
    yield from _on_the_spot()
    for number in range(1, 7):
        yield f"stroll-{number}", _random_walk(rng)
    for number in range(1, 4):
        yield f"run-about-{number}", _random_run(rng)


def _steady() -> Iterator[tuple[str, _Script]]:
    for speed in (*_WALKS, *_JOGS, *_RUNS):
        gait = "walk" if speed in _WALKS else "run"
        yield f"{gait}-{speed}", [Segment(1.0), Segment(5.0, speed), Segment(2.5)]


def _curves() -> Iterator[tuple[str, _Script]]:
    for speed, turn in _WALK_CURVES:
        yield (
            f"walk-{speed}-s-{turn}",
            [
                Segment(1.0, speed),
                Segment(4.0, speed, turn),
                Segment(4.0, speed, -turn),
                Segment(1.0, speed),
            ],
        )
    for speed, turn in _RUN_CURVES:
        yield (
            f"run-{speed}-s-{turn}",
            [
                Segment(1.0, speed),
                Segment(3.5, speed, turn),
                Segment(1.0, speed),
                Segment(3.5, speed, -turn),
                Segment(1.0, speed),
            ],
        )
    for name, seconds in (("90", 0.8), ("180", 1.6)):
        for side, turn in (("left", 2.0), ("right", -2.0)):
            yield (
                f"walk-turn-{name}-{side}",
                [Segment(2.0, 1.3), Segment(seconds, 0.6, turn), Segment(2.5, 1.3)],
            )


def _changes() -> Iterator[tuple[str, _Script]]:
    for walk, run in ((1.2, 2.6), (1.4, 3.5)):
        yield (
            f"walk-{walk}-run-{run}",
            [Segment(2.5, walk), Segment(4.0, run), Segment(3.0, walk)],
        )
    for speed in (1.0, 1.4):
        yield (
            f"stop-and-go-{speed}",
            [
                Segment(1.5),
                Segment(2.0, speed),
                Segment(1.8),
                Segment(2.0, 0.8 * speed),
                Segment(1.8),
            ],
        )
    for speed, slow in ((1.3, 0.15), (2.5, 0.4)):
        for side, turn in (("left", 2.9), ("right", -2.9)):
            yield (
                f"about-turn-{speed}-{side}",
                [
                    Segment(2.0, speed),
                    Segment(0.6, slow),
                    Segment(1.1, slow, turn),
                    Segment(2.5, speed),
                ],
            )


def _on_the_spot() -> Iterator[tuple[str, _Script]]:
    for side, sign in (("left", 1.0), ("right", -1.0)):
        yield (
            f"turn-in-place-{side}",
            [
                Segment(1.0),
                Segment(1.0, turn=1.6 * sign),
                Segment(1.5),
                Segment(1.3, turn=3.3 * sign),
                Segment(1.5),
            ],
        )
        yield (
            f"turn-and-walk-{side}",
            [
                Segment(1.0),
                Segment(0.9, 0.3, 2.0 * sign),
                Segment(2.5, 1.2),
                Segment(0.9, 0.5, -2.0 * sign),
                Segment(1.5, 1.2),
                Segment(1.5),
            ],
        )
        yield (
            f"turn-back-and-walk-{side}",
            [Segment(1.0), Segment(1.2, 0.15, 2.7 * sign), Segment(2.5, 1.3), Segment(1.5)],
        )
        yield (
            f"sidestep-{side}",
            [Segment(1.0), Segment(5.0, side=0.6 * sign), Segment(1.5)],
        )


def _random_walk(rng: np.random.Generator) -> _Script:
    script = [Segment(1.0)]
    for _ in range(6):
        speed = rng.uniform(0.5, 1.7)
        script.append(
            Segment(rng.uniform(1.0, 2.5), speed, rng.uniform(-1.0, 1.0) * min(1.5, 1.4 / speed))
        )
    return [*script, Segment(2.0)]


def _random_run(rng: np.random.Generator) -> _Script:
    script = [Segment(1.0), Segment(1.0, 1.4)]
    for _ in range(5):
        speed = rng.uniform(2.2, 3.8)
        script.append(Segment(rng.uniform(1.2, 2.2), speed, rng.uniform(-1.0, 1.0) * 1.6 / speed))
    return [*script, Segment(1.5, 1.4), Segment(2.0)]


def _backward() -> Iterator[tuple[str, _Script]]:
    for speed in (0.5, 0.8, 1.1):
        yield f"backward-{speed}", [Segment(1.5), Segment(4.5, speed), Segment(1.5)]
    yield (
        "backward-curve",
        [Segment(1.0), Segment(3.5, 0.8, 0.7), Segment(3.5, 0.8, -0.7), Segment(1.5)],
    )
