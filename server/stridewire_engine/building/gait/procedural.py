"""The procedural style: how a body moves at each phase, written down by hand.

Curves over the phase are knots joined by monotone cubics, so that nothing overshoots; their sizes
follow speed, turning and acceleration. The shapes are the textbook ones (Perry, *Gait Analysis*):
heel strike, foot flat, heel off at about half of the stance, toe off; pelvis highest in mid-stance
when walking and in flight when running.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.gait.cycle import Cycle, cadence
from stridewire_engine.building.gait.script import FRAME_RATE, Travel

TOE_HEIGHT = 0.02
"""Of a planted toe joint of the reference skeleton; metres."""

_GRAVITY = 9.81
# knots over a warped phase: 0 to 0.5 is the stance of the toe, 0.5 to 1 its swing
_WALK_PITCH = ((0, 0.22, 0.36, 0.5, 0.54, 0.72, 0.88, 0.95), (0, 0, 14, 52, 58, 10, -20, -18))
_RUN_PITCH = ((0, 0.18, 0.34, 0.5, 0.64, 0.8, 0.92), (0, 0, 20, 58, 92, 40, 0))
_WALK_LIFT = ((0, 0.5, 0.58, 0.68, 0.8, 0.9, 0.95), (0, 0, 0.05, 0.075, 0.035, 0.05, 0.04))
_RUN_LIFT = ((0, 0.5, 0.62, 0.72, 0.84, 0.93), (0, 0, 0.2, 0.26, 0.14, 0.05))


@dataclass(frozen=True)
class Body:
    """What a style says: a body above its feet, in the frame of the travelling heading."""

    hips: Vectors
    """`(T, 3)` metres."""
    rotations: Quaternions
    """`(T, J, 4)` local rotations, the legs at rest."""
    toe: Vectors
    """`(T, 2, 3)` left and right toe joint, not planted."""
    yaw: Floats
    """`(T, 2)` of the feet, radians."""
    pitch: Floats
    """`(T, 2)` of the feet, radians; positive with the heel up."""


@dataclass(frozen=True)
class Person:
    """How one walks."""

    arm: float = 1.0
    """Factor on the swing of the arms."""
    bounce: float = 1.0
    """Factor on the movements of the pelvis."""
    width: float = 0.095
    """From the middle to each foot, metres."""
    toe_out: float = 0.1
    """Feet turned out by this, radians."""
    stoop: float = 0.0
    """Leaning forward in the spine, radians."""

    @staticmethod
    def draw(rng: np.random.Generator) -> "Person":
        """Draw a person."""
        return Person(
            arm=rng.uniform(0.8, 1.25),
            bounce=rng.uniform(0.8, 1.2),
            width=rng.uniform(0.085, 0.11),
            toe_out=rng.uniform(0.04, 0.16),
            stoop=rng.uniform(-0.03, 0.06),
        )


def body(travel: Travel, cycle: Cycle, person: Person, rng: np.random.Generator) -> Body:
    """Move a body along its cycle."""
    drift = [_drift(len(travel.yaw), seconds, rng) for seconds in (1.6, 1.2, 1.0, 1.4)]
    standing = 1.0 - cycle.stepping
    hips = _hips(travel, cycle, person)
    hips[:, 0] += 0.02 * standing * drift[0]
    rotations = quaternion.identity(len(hips), len(REFERENCE), dtype=np.float64)
    _turn_trunk(rotations, travel, cycle, person, drift)
    _swing_arms(rotations, travel, cycle, person)
    toe, yaw, pitch = _feet(travel, cycle, person)
    return Body(hips, rotations, toe, yaw, pitch)


def _hips(travel: Travel, cycle: Cycle, person: Person) -> Vectors:
    speed, run, left = travel.speed, cycle.run, cycle.phase[:, 0]
    size = cycle.stepping * person.bounce * np.clip(0.35 + speed / 1.6, 0.0, 1.2)
    top = 0.5 * cycle.stance + 0.25 * run
    bounce = _mix(0.017, 0.038, run)
    height = _mix(0.936 - 0.012 * np.minimum(speed, 2.0), 0.892, run)
    sway = _mix(0.026, 0.008, run) * size
    hips = np.zeros((len(speed), 3))
    hips[:, 0] = sway * np.cos(2.0 * np.pi * (left - 0.5 * cycle.stance))
    hips[:, 1] = height + bounce * size * np.cos(4.0 * np.pi * (left - top))
    hips[:, 2] = -0.01 + 0.01 * run
    return hips


def _turn_trunk(
    rotations: Quaternions, travel: Travel, cycle: Cycle, person: Person, drift: list[Floats]
) -> None:
    """Set hips, spine, neck and head: pelvis with the leg, shoulders against it, head ahead."""
    run, left, size = cycle.run, cycle.phase[:, 0], cycle.stepping * person.bounce
    reach = np.clip(travel.speed / 1.4, 0.0, 1.3)
    wave = np.cos(2.0 * np.pi * left)
    pelvis_yaw = -_mix(0.085, 0.12, run) * size * reach * wave
    middle = np.cos(2.0 * np.pi * (left - 0.5 * cycle.stance))
    pelvis_roll = _mix(0.045, 0.06, run) * size * middle
    bank = -np.arctan(travel.velocity[:, 1] * travel.turn / _GRAVITY) * _mix(0.55, 0.8, run)
    lean = np.arctan(travel.acceleration / _GRAVITY) * 0.7 + _mix(0.02, 0.13, run)
    side = 0.05 * np.clip(travel.velocity[:, 0], -1.0, 1.0)
    standing = 1.0 - cycle.stepping
    breath = 0.012 * np.sin(2.0 * np.pi * 0.25 * np.arange(len(left)) / FRAME_RATE)
    shoulders = _mix(0.09, 0.17, run) * size * reach * wave * person.arm - pelvis_yaw
    look = np.clip(0.25 * travel.turn, -0.5, 0.5)
    spine = REFERENCE.indices(("Spine", "Spine1", "Spine2"))
    rotations[:, 0] = _euler(0.5 * lean, pelvis_yaw, pelvis_roll + 0.6 * bank - side)
    for joint in spine:
        rotations[:, joint] = _euler(
            (0.5 * lean + person.stoop + breath * (1.0 + standing)) / 3.0,
            (shoulders + 0.04 * standing * drift[1] + 0.3 * look) / 3.0,
            (-pelvis_roll + 0.2 * bank + 0.02 * standing * drift[2]) / 3.0,
        )
    nod = -0.8 * (lean + person.stoop) + 0.04 * standing * drift[3]
    for joint, share in ((REFERENCE.index("Neck"), 0.45), (REFERENCE.index("Head"), 0.55)):
        yaw = share * (-shoulders - pelvis_yaw + 0.7 * look + 0.18 * standing * drift[2])
        rotations[:, joint] = _euler(share * nod, yaw, -share * 0.7 * bank)


def _swing_arms(rotations: Quaternions, travel: Travel, cycle: Cycle, person: Person) -> None:
    """Hang the arms of the T-pose down and swing them against the legs."""
    run = cycle.run
    reach = cycle.stepping * np.clip(np.abs(travel.velocity[:, 1]) / 1.4, 0.15, 1.25) * person.arm
    for side, (name, out) in enumerate((("Left", 1.0), ("Right", -1.0))):
        wave = np.cos(2.0 * np.pi * (cycle.phase[:, side] + 0.02))
        swing = _mix(0.34, 0.62, run) * reach * wave + _mix(-0.03, 0.22, run)
        bend = (
            0.22
            + _mix(0.16 * np.minimum(reach, 1.0), 1.3, run)
            - _mix(0.16, 0.12, run) * (reach * wave)
        )
        hang = _mix(1.38, 1.25, run) - 0.05 * np.abs(travel.turn * cycle.stepping)
        hanging = quaternion.multiply(_euler(swing, 0.0, 0.0), _euler(0.0, 0.0, -out * hang))
        turned_in = _euler(_mix(0.25, 0.4, run), 0.0, 0.0)
        rotations[:, REFERENCE.index(f"{name}Arm")] = quaternion.multiply(hanging, turned_in)
        rotations[:, REFERENCE.index(f"{name}ForeArm")] = _euler(0.0, -out * bend, 0.0)
        rotations[:, REFERENCE.index(f"{name}Hand")] = _euler(0.0, -out * _mix(0.12, 0.2, run), 0.0)


def _feet(travel: Travel, cycle: Cycle, person: Person) -> tuple[Vectors, Floats, Floats]:
    speed, run = travel.speed, cycle.run
    seconds = cycle.stance / cadence(travel, run)
    sweep = 0.5 * travel.velocity * seconds[:, None]
    width = person.width + 0.075 * np.clip(np.abs(travel.velocity[:, 0]) / 0.3, 0.0, 1.0)
    width = width - 0.035 * run
    ahead = 0.125 - _mix(0.06, 0.05, run) * np.clip(speed, 0.0, 2.2)
    size = np.clip(0.3 + speed / 1.3, 0.0, 1.15)
    kick = np.clip(speed / 3.3, 0.55, 1.15)
    toe = np.zeros((len(speed), 2, 3))
    pitch = np.zeros((len(speed), 2))
    for side, out in enumerate((1.0, -1.0)):
        at = _warp(cycle.phase[:, side], cycle.stance)
        swept = _sweep(at)
        toe[:, side, 0] = out * width + sweep[:, 0] * swept
        toe[:, side, 2] = ahead + sweep[:, 1] * swept
        walk_lift = np.clip(0.55 + speed / 2.6, 0.0, 1.2) * _curve(_WALK_LIFT, at)
        toe[:, side, 1] = TOE_HEIGHT + _mix(walk_lift, kick * _curve(_RUN_LIFT, at), run)
        walk, running = size * _curve(_WALK_PITCH, at), kick * _curve(_RUN_PITCH, at)
        pitch[:, side] = np.radians(_mix(walk, running, run)) * cycle.stepping
    yaw = np.array([1.0, -1.0]) * (person.toe_out * (1.0 - 0.6 * run))[:, None]
    return toe, yaw, pitch


def _warp(phase: Floats, stance: Floats) -> Floats:
    """Map the stance to 0 … 0.5 and the swing to 0.5 … 1."""
    return np.asarray(
        np.where(
            phase < stance, 0.5 * phase / stance, 0.5 + 0.5 * (phase - stance) / (1.0 - stance)
        )
    )


def _sweep(at: Floats) -> Floats:
    """From 1 to -1 evenly over the stance and back over the swing, meeting with its speed."""
    x = 2.0 * at - 1.0
    slope = -1.0
    swing = 2.0 * (3.0 * x**2 - 2.0 * x**3) - 1.0 + slope * (x - 3.0 * x**2 + 2.0 * x**3)
    return np.asarray(np.where(at < 0.5, 1.0 - 4.0 * at, swing))


def _curve(knots: tuple[tuple[float, ...], tuple[float, ...]], at: Floats) -> Floats:
    """Evaluate a periodic curve through knots."""
    x, y = (np.asarray(values, float) for values in knots)
    turns = PchipInterpolator(np.concatenate([x - 1.0, x, x + 1.0]), np.tile(y, 3))
    return np.asarray(turns(at))


def _drift(frames: int, seconds: float, rng: np.random.Generator) -> Floats:
    """Return slow noise `(frames,)` of about unit size: what a standing body does."""
    knots = rng.normal(size=int(frames / FRAME_RATE / seconds) + 4)
    at = np.arange(frames) / FRAME_RATE / seconds
    return np.asarray(PchipInterpolator(np.arange(len(knots)), knots)(at))


def _mix(walk: Floats | float, run: Floats | float, weight: Floats) -> Floats:
    return np.asarray(walk + weight * (np.asarray(run) - walk))


def _euler(pitch: Floats | float, yaw: Floats | float, roll: Floats | float) -> Quaternions:
    """Turn by roll about z, then pitch about x, then yaw about y."""
    return quaternion.from_euler(np.stack(np.broadcast_arrays(yaw, pitch, roll), axis=-1), "yxz")
