"""Drawing: one clip from a script."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip
from stridewire_engine.building.gait.body import Body, Person, body
from stridewire_engine.building.gait.cycle import HOLD_PHASES, Cycle, cycle
from stridewire_engine.building.gait.figure import make_clip
from stridewire_engine.building.gait.model import GaitModel
from stridewire_engine.building.gait.planting import Feet, plant
from stridewire_engine.building.gait.script import FRAME_RATE, Segment, Travel, travel
from stridewire_engine.building.tagging import tag

_MARGIN_S = 1.5
_SOURCE = "synthetic"
_TOE_HEIGHT = 0.02


def draw_clip(
    model: GaitModel, name: str, script: Sequence[Segment], rng: np.random.Generator
) -> Clip:
    """Draw one clip at 60 frames/s on the reference skeleton.

    Args:
        model: How people move.
        name: Of the clip.
        script: How the character travels.
        rng: Draws the person and what is left to chance.
    """
    path = travel(script, _MARGIN_S)
    person = Person.draw(model, rng)
    steps = cycle(model, path, person.rate, _first_phase(script, rng))
    moved = body(model, person, path, steps, rng)
    feet = plant(_in_world(moved, path, steps), steps.holding, _pivot(path), _TOE_HEIGHT)
    turn = quaternion.from_yaw(path.yaw)
    hips = path.position + quaternion.rotate(turn, moved.hips)
    rotations = moved.rotations.copy()
    rotations[:, 0] = quaternion.multiply(turn, rotations[:, 0])
    whole = make_clip(name, hips, rotations, feet, _SOURCE)
    margin = round(_MARGIN_S * FRAME_RATE)
    return tag(whole.cut(margin, len(whole) - margin), "")


def reverse(clip: Clip) -> Clip:
    """Play a clip from its end: what was a walk ahead becomes one backward."""
    pose = clip.pose[::-1]
    return tag(replace(clip, pose=pose, contacts=clip.contacts[::-1]), "")


def _first_phase(script: Sequence[Segment], rng: np.random.Generator) -> float:
    """Begin anywhere when moving; standing, so that the foot steps first that leads to the side."""
    first = script[0]
    if first.speed or first.turn or first.side:
        return float(rng.uniform())
    leads = next((s.side or s.turn for s in script if s.side or s.turn or s.speed), 0.0)
    return HOLD_PHASES[int(leads > 0.0) if leads else int(rng.integers(2))]


def _in_world(moved: Body, path: Travel, steps: Cycle) -> Feet:
    turn = quaternion.from_yaw(path.yaw)
    toe = path.position[:, None] + quaternion.rotate(turn[:, None], moved.toe)
    return Feet(toe, moved.yaw + path.yaw[:, None], moved.pitch, steps.planted)


def _pivot(path: Travel) -> Floats:
    """Let planted feet turn on the ball in sharp turns, as people's do."""
    return np.asarray(0.5 * np.clip((np.abs(path.turn) - 0.8) / 1.2, 0.0, 1.0))
