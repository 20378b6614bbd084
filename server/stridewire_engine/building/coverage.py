"""What a library covers, by speed and turning rate, and how clean its clips are."""

from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, differences
from stridewire.motion.contacts import rest_heights
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE
from stridewire_engine.building.tagging import local_velocity, yaw_rate
from stridewire_engine.library import Library

SPEEDS = (0.0, 0.25, 1.0, 1.5, 2.0, 3.2, np.inf)
"""Edges of the classes of speed; m/s."""
TURNS = (-np.inf, -135.0, -45.0, -15.0, 15.0, 45.0, 135.0, np.inf)
"""Edges of the classes of turning rate; degrees/s, positive to the left."""

WANTED_S = {
    "idle": 20.0,
    "walk": 60.0,
    "jog": 20.0,
    "run": 20.0,
    "start": 10.0,
    "stop": 10.0,
    "turn-left": 20.0,
    "turn-right": 20.0,
    "backward": 10.0,
    "sidestep-left": 10.0,
    "sidestep-right": 10.0,
}
"""Seconds of each tag with which a character can be steered; less leads to repeats and slips."""

_KNEES = ("LeftLeg", "RightLeg", "LeftForeArm", "RightForeArm")
_OVERSTRETCHED = np.deg2rad(15.0)
_OVERBENT = np.deg2rad(165.0)


@dataclass(frozen=True)
class ClipQuality:
    """How clean one clip is."""

    name: str
    source: str
    seconds: float
    speed: float
    """Mean speed over the ground; m/s."""
    noise: float
    """Median jerk of the hands and feet in the character's frame; m/s^3."""
    floor_cm: float
    """Median height of planted toes over the ground."""
    sliding_cm_s: float
    """Mean speed over the ground of planted toes."""
    contact_share: float
    """Share of frames in which a toe is planted, mean of both."""
    out_of_range: float
    """Share of frames with a knee or elbow bent the wrong way or too far."""

    @property
    def problems(self) -> tuple[str, ...]:
        """What a person should look at."""
        found = []
        # fast motion jerks and creeps without being noisy
        if self.noise > 250.0 + 120.0 * self.speed:
            found.append("noisy")
        if abs(self.floor_cm) > 2.0:
            found.append("off the ground")
        if self.sliding_cm_s > max(10.0, 6.0 * self.speed):
            found.append("planted feet slide")
        if self.contact_share < 0.05:
            found.append("feet never planted (in place, in the air, or wrong units)")
        if self.out_of_range > 0.02:
            found.append("knees or elbows out of range")
        return tuple(found)


@dataclass(frozen=True)
class Report:
    """Coverage and quality of a library."""

    minutes: Floats
    """`(speeds, turns)` minutes in each class."""
    seconds_by_tag: dict[str, float]
    clips: tuple[ClipQuality, ...]

    @property
    def wanted(self) -> tuple[tuple[str, float, float], ...]:
        """Tags with too little: name, seconds held, seconds wanted."""
        held = self.seconds_by_tag
        return tuple(
            (tag, held.get(tag, 0.0), wanted)
            for tag, wanted in WANTED_S.items()
            if held.get(tag, 0.0) < wanted
        )


def examine(library: Library) -> Report:
    """Measure coverage, mirrored copies included, and the quality of the clips without them."""
    minutes = np.zeros((len(SPEEDS) - 1, len(TURNS) - 1))
    quality = []
    for entry in library.clips:
        clip = library.clip(entry.name)
        speed = np.linalg.norm(local_velocity(clip.pose, clip.frame_rate), axis=-1)
        turning = np.rad2deg(yaw_rate(clip.pose, clip.frame_rate))
        counts, _, _ = np.histogram2d(speed, turning, bins=(np.array(SPEEDS), np.array(TURNS)))
        minutes += counts / clip.frame_rate / 60.0
        if not entry.name.endswith("-mirrored"):
            quality.append(clip_quality(clip))
    return Report(minutes, library.seconds_by_tag(), tuple(quality))


def clip_quality(clip: Clip) -> ClipQuality:
    """Measure one clip on the reference skeleton."""
    pose = clip.pose.astype(np.float64)
    world, _ = kinematics.forward_world(REFERENCE, pose)
    local, _ = kinematics.forward(REFERENCE, pose.hips, pose.rotations)
    dt = 1.0 / clip.frame_rate
    ends = REFERENCE.indices(("LeftHand", "RightHand", "LeftFoot", "RightFoot"))
    jerk = differences(differences(differences(local[:, ends], dt), dt), dt)
    toes = REFERENCE.indices(CONTACT_JOINTS)[[1, 3]]
    planted = clip.contacts[:, [1, 3]]
    speed = np.linalg.norm(differences(world[:, toes], dt)[..., [0, 2]], axis=-1)
    height = world[:, toes, 1] - rest_heights(REFERENCE, toes)
    some = bool(planted.any())
    return ClipQuality(
        name=clip.name,
        source=clip.source,
        seconds=clip.seconds,
        speed=float(np.linalg.norm(differences(pose.root_position, dt), axis=-1).mean()),
        noise=float(np.median(np.linalg.norm(jerk, axis=-1))),
        floor_cm=100.0 * float(np.median(height[planted])) if some else 0.0,
        sliding_cm_s=100.0 * float(speed[planted].mean()) if some else 0.0,
        contact_share=float(planted.mean()),
        out_of_range=float(_out_of_range(clip).mean()),
    )


def _out_of_range(clip: Clip) -> Floats:
    """Return `(T,)` 1 where a knee or elbow bends backwards or further than joints go."""
    joints = REFERENCE.indices(_KNEES)
    turn = quaternion.to_scaled_axis(clip.pose.rotations[:, joints].astype(np.float64))
    bent = np.linalg.norm(turn, axis=-1)
    # knees bend about +X of the thigh; the other way is a fault
    backwards = (turn[:, :2, 0] < -_OVERSTRETCHED).any(axis=-1)
    return np.asarray((backwards | (bent > _OVERBENT).any(axis=-1)).astype(np.float64))
