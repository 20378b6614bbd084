"""The body above its feet: the gait model along a script, a person's ways and a moment's noise.

The model knows people who walk and run ahead. Standing is their mean pose with slow drift; turning
on the spot and stepping sideways, which nobody in the training data does, are made from slow
walking by taking the fore-and-aft reach out and putting a sideways one in.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter1d

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.gait.cycle import Cycle
from stridewire_engine.building.gait.model import (
    CHANNELS,
    JOINTS,
    PERSON_HARMONICS,
    Gait,
    GaitModel,
    decode,
    design,
    harmonics,
)
from stridewire_engine.building.gait.script import FRAME_RATE, Travel

_FEET = slice(3 * JOINTS + 3, CHANNELS)
_SIDE_TO_SIDE = np.arange(_FEET.start, CHANNELS, 3)
_LIFT = _SIDE_TO_SIDE + 1
_FORE_AND_AFT = _SIDE_TO_SIDE + 2
_FULL_SPEED = 0.55
_LEAST_GAIT = 0.35
_MOMENT_S = {"walk": 0.11, "run": 0.09}
_LARGEST_DEVIATION = 1.3
# what the training data holds, m/s^2
_SIDEWAYS = {"walk": 1.5, "run": 3.5}
_ACCELERATION = {"walk": (-1.2, 1.05), "run": (-1.6, 2.5)}
_TALLER = 0.02
# seconds between goals of what drifts while standing
_DRIFT_S = {"weight": 1.7, "lean": 0.9, "trunk": 1.3, "nod": 0.8, "look": 1.2, "sway": 0.3}
_WIDER = 0.08
_CLEARANCE, _TURN_CLEARANCE, _MIDDLE_S = 0.035, 0.015, 0.4


@dataclass(frozen=True)
class Body:
    """A body above feet that are not planted yet, relative to the path of travel."""

    hips: Vectors
    """`(T, 3)` metres."""
    rotations: Quaternions
    """`(T, J, 4)` local rotations."""
    toe: Vectors
    """`(T, 2, 3)` left and right toe joint."""
    yaw: Floats
    """`(T, 2)` of the feet, radians."""
    pitch: Floats
    """`(T, 2)` of the feet, radians; positive with the heel up."""


@dataclass(frozen=True)
class Person:
    """How one moves: deviations from the model's average."""

    walk: Floats
    """`(5, C)` over harmonics 0 to 2."""
    run: Floats
    """`(5, C)` likewise."""
    rate: float
    """Factor on the cadence."""

    @staticmethod
    def draw(model: GaitModel, rng: np.random.Generator) -> "Person":
        """Draw a person."""
        walk, run = (
            np.tensordot(_deviates(len(gait.persons), rng), gait.persons, axes=1)
            for gait in (model.walk, model.run)
        )
        return Person(walk, run, float(np.exp(0.03 * _deviates(1, rng)[0])))


def body(
    model: GaitModel, person: Person, travel: Travel, cycle: Cycle, rng: np.random.Generator
) -> Body:
    """Move a body along its cycle."""
    walk = _gait(model.walk, "walk", person.walk, travel, cycle, rng)
    run = _gait(model.run, "run", person.run, travel, cycle, rng)
    stand: Floats = model.standing + person.walk[:1]
    # standing people straighten their knees more than the average of poses does
    stand[:, 3 * JOINTS + 1] += _TALLER
    channels: Floats = walk + cycle.run[:, None] * (run - walk)
    channels = _slow_down(channels, stand, travel)
    channels = stand + cycle.stepping[:, None] * (channels - stand)
    _step_aside(channels, travel, cycle)
    _keep_apart(channels, travel)
    rotations, ends = decode(channels, model.base)
    hips = ends[:, 0]
    _drift(hips, rotations, 1.0 - cycle.stepping, rng)
    yaw, pitch = _foot_angles(rotations, ends)
    return Body(hips, rotations, ends[:, [2, 4]], yaw, pitch)


def _gait(
    gait: Gait, name: str, person: Floats, travel: Travel, cycle: Cycle, rng: np.random.Generator
) -> Floats:
    """Return the channels `(T, C)` of one gait."""
    phase = cycle.model_phase
    speed = np.clip(travel.speed, gait.slowest, gait.fastest) - gait.centre
    sideways = np.clip(travel.speed * travel.turn, -_SIDEWAYS[name], _SIDEWAYS[name])
    acceleration = np.clip(travel.acceleration, *_ACCELERATION[name])
    channels = design(phase, speed, sideways, acceleration) @ gait.coefficients
    channels += harmonics(phase, PERSON_HARMONICS) @ person
    noise = rng.normal(size=(len(phase), len(gait.moments)))
    noise = gaussian_filter1d(noise, _MOMENT_S[name] * FRAME_RATE, axis=0, mode="wrap")
    moment = (noise / noise.std(axis=0)) @ gait.moments
    # noise would shake planted feet
    moment[:, _FEET] = 0.0
    return np.asarray(channels + moment)


def _slow_down(channels: Floats, stand: Floats, travel: Travel) -> Floats:
    """Below the slowest captured walk fade the gait towards standing.

    The reach of the feet goes with the speed; their lift fades least, or they would shuffle.
    """
    share = np.clip(np.abs(travel.velocity[:, 1]) / _FULL_SPEED, 0.0, 1.0)[:, None]
    weight = np.broadcast_to(_LEAST_GAIT + (1.0 - _LEAST_GAIT) * share, channels.shape).copy()
    weight[:, _LIFT] = np.sqrt(weight[:, _LIFT])
    weight[:, _FORE_AND_AFT] = share
    return stand + weight * (channels - stand)


def _step_aside(channels: Floats, travel: Travel, cycle: Cycle) -> None:
    """Let both feet sweep sideways, wide enough apart not to cross."""
    sideways = travel.velocity[:, 0]
    size = 0.5 * sideways * cycle.stance_seconds
    wide = _WIDER * np.clip(np.abs(sideways) / 0.3, 0.0, 1.0)
    for side, out in enumerate((1.0, -1.0)):
        shift = size * _sweep(cycle.phase[:, side], cycle.stance) + out * wide
        for column in _SIDE_TO_SIDE[2 * side : 2 * side + 2]:
            channels[:, column] += shift


def _keep_apart(channels: Floats, travel: Travel) -> None:
    """Keep feet off the line between them; more so in turns, where plants come to lie askew."""
    middle = channels[:, _SIDE_TO_SIDE].mean(axis=1)
    middle = gaussian_filter1d(middle, _MIDDLE_S * FRAME_RATE, mode="nearest")[:, None]
    wanted = _CLEARANCE + _TURN_CLEARANCE * np.minimum(np.abs(travel.turn), 2.0)
    for out, columns in ((1.0, _SIDE_TO_SIDE[:2]), (-1.0, _SIDE_TO_SIDE[2:])):
        lack = wanted[:, None] - out * (channels[:, columns] - middle)
        # a soft maximum with zero
        channels[:, columns] += out * 0.5 * (lack + np.hypot(lack, 0.015))


def _sweep(phase: Floats, stance: Floats) -> Floats:
    """From 1 to -1 evenly over the stance and smoothly back over the swing."""
    x = np.clip((phase - stance) / (1.0 - stance), 0.0, 1.0)
    return np.asarray(
        np.where(phase < stance, 1.0 - 2.0 * phase / stance, 2.0 * x * x * (3 - 2 * x) - 1.0)
    )


def _drift(
    hips: Vectors, rotations: Quaternions, standing: Floats, rng: np.random.Generator
) -> None:
    """Shift weight, breathe and look about while standing."""
    noise = {name: standing * _slow_noise(len(hips), s, rng) for name, s in _DRIFT_S.items()}
    hips[:, 0] += 0.022 * noise["weight"] + 0.0015 * noise["sway"]
    hips[:, 2] += 0.006 * noise["lean"]
    hips[:, 1] -= 0.004 * noise["weight"] ** 2
    breath = 0.015 * standing * np.sin(2.0 * np.pi * 0.25 * np.arange(len(hips)) / FRAME_RATE)
    turns: dict[str, tuple[Floats | float, ...]] = {
        "Hips": (0.0, 0.02 * noise["trunk"], 0.03 * noise["weight"]),
        "Spine": (breath, 0.03 * noise["trunk"], -0.025 * noise["weight"]),
        "Spine2": (-0.6 * breath, 0.03 * noise["trunk"], -0.01 * noise["weight"]),
        "Neck": (0.03 * noise["nod"], 0.06 * noise["look"], 0.0),
        "Head": (0.04 * noise["nod"], 0.09 * noise["look"], 0.0),
        "LeftArm": (0.03 * noise["lean"], 0.0, 0.02 * noise["trunk"]),
        "RightArm": (0.03 * noise["nod"], 0.0, 0.02 * noise["trunk"]),
    }
    for name, angles in turns.items():
        turn = quaternion.from_scaled_axis(np.stack(np.broadcast_arrays(*angles), axis=-1))
        joint = REFERENCE.index(name)
        rotations[:, joint] = quaternion.multiply(turn, rotations[:, joint])


def _slow_noise(frames: int, seconds: float, rng: np.random.Generator) -> Floats:
    """Return noise `(frames,)` of about unit size with a new goal every few seconds."""
    knots = rng.normal(size=int(frames / FRAME_RATE / seconds) + 4)
    at = np.arange(frames) / FRAME_RATE / seconds
    return np.asarray(PchipInterpolator(np.arange(len(knots)), knots)(at))


def _foot_angles(rotations: Quaternions, ends: Vectors) -> tuple[Floats, Floats]:
    """Return yaw and pitch `(T, 2)` of the feet: yaw as rotated, pitch from ankle and toe."""
    yaw, pitch = np.empty((2, len(ends), 2))
    rest = np.arctan2(*-REFERENCE.offsets[REFERENCE.index("LeftToe"), [1, 2]] * (1.0, -1.0))
    for side, name in enumerate(("Left", "Right")):
        turn = rotations[:, 0]
        for joint in REFERENCE.indices((f"{name}UpLeg", f"{name}Leg", f"{name}Foot")):
            turn = quaternion.multiply(turn, rotations[:, joint])
        yaw[:, side] = _heading(turn)
        sole = ends[:, 2 + 2 * side] - ends[:, 1 + 2 * side]
        ahead = sole[:, 0] * np.sin(yaw[:, side]) + sole[:, 2] * np.cos(yaw[:, side])
        pitch[:, side] = np.arctan2(-sole[:, 1], ahead) - rest
    return yaw, pitch


def _heading(turn: Quaternions) -> Floats:
    """Return the yaw `(T,)` of a foot, of its upper side's normal where it points down."""
    frames = len(turn)
    forward = quaternion.rotate(turn, np.broadcast_to([0.0, 0.0, 1.0], (frames, 3)))
    up = quaternion.rotate(turn, np.broadcast_to([0.0, 1.0, 0.0], (frames, 3)))
    flat = forward - up * np.minimum(forward[:, 1:2], 0.0)
    return np.arctan2(flat[:, 0], flat[:, 2])


def _deviates(count: int, rng: np.random.Generator) -> Floats:
    return np.clip(rng.normal(size=count), -_LARGEST_DEVIATION, _LARGEST_DEVIATION)
