"""Drawing: one clip from a script, with the tags that the script implies."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags
from stridewire.motion.clip import Clip, Pose, TagSpan
from stridewire_engine.building.gait.cycle import HOLD_PHASES, Cycle, cycle
from stridewire_engine.building.gait.figure import make_clip
from stridewire_engine.building.gait.planting import Feet, plant, stances
from stridewire_engine.building.gait.procedural import TOE_HEIGHT, Body, Person, body
from stridewire_engine.building.gait.script import FRAME_RATE, Segment, Travel, travel

_MARGIN_S = 1.5
_SOURCE = "synthetic"


def draw_clip(name: str, script: Sequence[Segment], rng: np.random.Generator) -> Clip:
    """Draw one clip at 60 frames/s on the reference skeleton.

    Args:
        name: Of the clip.
        script: How the character travels.
        rng: Draws the person and what is left to chance.
    """
    path = travel(script, _MARGIN_S)
    steps = cycle(path, rng.uniform(0.96, 1.04), _first_phase(script, rng))
    moved = body(path, steps, Person.draw(rng), rng)
    feet = plant(_in_world(moved, path, steps), steps.holding, TOE_HEIGHT)
    turn = quaternion.from_yaw(path.yaw)
    hips = path.position + quaternion.rotate(turn, moved.hips)
    rotations = moved.rotations.copy()
    rotations[:, 0] = quaternion.multiply(turn, rotations[:, 0])
    whole = make_clip(name, hips, rotations, feet, _SOURCE)
    margin = round(_MARGIN_S * FRAME_RATE)
    return replace(whole, tags=tuple(_tags(path, steps))).cut(margin, len(whole) - margin)


def reverse(clip: Clip) -> Clip:
    """Play a clip backward: what was a walk ahead becomes one backward, starts become stops."""
    pose = clip.pose
    last = len(clip)
    swap = {"start": "stop", "stop": "start", "turn-left": "turn-right", "turn-right": "turn-left"}
    return replace(
        clip,
        pose=Pose(
            pose.root_position[::-1],
            pose.root_rotation[::-1],
            pose.hips[::-1],
            pose.rotations[::-1],
        ),
        contacts=clip.contacts[::-1],
        tags=tuple(
            TagSpan(
                "backward" if t.name == "walk" else swap.get(t.name, t.name),
                last - t.end,
                last - t.start,
            )
            for t in reversed(clip.tags)
        ),
    )


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


def _tags(path: Travel, steps: Cycle) -> Iterator[TagSpan]:
    """Yield spans of at least a quarter of a second."""
    speed, standing = path.speed, steps.stepping < 0.5
    sideways = ~standing & (np.abs(path.velocity[:, 0]) > 0.2)
    ahead = ~standing & ~sideways & (speed > 0.1)
    change = np.gradient(speed) * FRAME_RATE
    slow = speed < 1.0
    flags: dict[str, Flags] = {
        "idle": standing,
        "walk": ahead & (steps.run < 0.5),
        "jog": ahead & (steps.run >= 0.5) & (speed < 2.8),
        "run": ahead & (steps.run >= 0.5) & (speed >= 2.8),
        "sidestep": sideways,
        "turn": ~standing & (np.abs(path.turn) > 0.5),
        "turn-left": ~standing & (path.turn > 0.5),
        "turn-right": ~standing & (path.turn < -0.5),
        "start": _ramp(change > 0.5, slow),
        "stop": _ramp(change < -0.5, slow),
    }
    for name, flag in flags.items():
        for start, end in stances(flag):
            if end - start >= 0.25 * FRAME_RATE:
                yield TagSpan(name, start, end)


def _ramp(changing: Flags, slow: Flags) -> Flags:
    """Keep the spans of changing speed that touch slowness: starts and stops, not walk to run."""
    out = np.zeros(len(changing), bool)
    for start, end in stances(changing):
        out[start:end] = slow[start:end].any()
    return out
