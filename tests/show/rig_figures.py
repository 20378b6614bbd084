"""How well a rig of somebody else's is posed live: directions of limbs, sliding of planted feet."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from capture import capture

from stridewire import Client, Frame
from stridewire.formats.reading import read_motion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire.scripts import script
from stridewire_engine.rigs.rig import rig_of

RIGS = {
    "Mixamo": ("exporters/odd/mixamo_turn_left90_25j.bvh", 0.01),
    "CMU": ("cmu/*/02_01.amc", 2.54 / 0.45 / 100.0),
}
"""Files whose skeletons are taken, and metres in their unit."""

_LIMBS = [
    (side + a, side + b)
    for side in ("Left", "Right")
    for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"), ("Arm", "ForeArm"), ("ForeArm", "Hand"))
]
_TOES = ("LeftToe", "RightToe")
_SECONDS = 15.0
_CHARACTERS = 4


@dataclass(frozen=True)
class Figures:
    """Of one rig."""

    scale: float
    mean_deg: float
    p95_deg: float
    max_deg: float
    within_pct: float
    """Share of limbs and frames within a degree."""
    slide_cm_s: float
    reference_slide_cm_s: float


def real_rigs() -> Iterator[tuple[str, Skeleton]]:
    """Yield the skeletons of the capture's files, in metres."""
    for name, (pattern, metres) in RIGS.items():
        path = next(capture().glob(pattern))
        skeleton = read_motion(path).skeleton
        offsets = skeleton.offsets * metres
        offsets[0] = 0.0  # files repeat the first frame's place here
        yield name, Skeleton(skeleton.names, skeleton.parents, offsets)


def measure(client: Client, skeleton: Skeleton) -> Figures:
    """Drive characters on a rig and on the reference by the same script, in the rig's size."""
    rig = rig_of(skeleton)
    theirs, ours = _drive(client, skeleton, rig.scale), _drive(client, None, 1.0)
    at = dict(zip(rig.parts, rig.joints.tolist(), strict=True))
    there, here = _positions(theirs, skeleton), _positions(ours, REFERENCE)
    cosines = np.sum(
        _bones(there, [(at[a], at[b]) for a, b in _LIMBS])
        * _bones(here, [(REFERENCE.index(a), REFERENCE.index(b)) for a, b in _LIMBS]),
        axis=-1,
    )
    apart = np.rad2deg(np.arccos(np.clip(cosines, -1.0, 1.0)))
    return Figures(
        rig.scale,
        float(apart.mean()),
        float(np.percentile(apart, 95)),
        float(apart.max()),
        100.0 * float(np.mean(apart <= 1.0)),
        _slide(there[:, :, [at[toe] for toe in _TOES]], theirs),
        _slide(here[:, :, REFERENCE.indices(_TOES)], ours),
    )


def _drive(client: Client, skeleton: Skeleton | None, scale: float) -> list[Frame]:
    controls = script("random-stick").controls
    frames = []
    with client.open_session(_CHARACTERS, output_skeleton=skeleton, seed=1) as session:
        for number in range(round(60.0 * _SECONDS)):
            asked = controls(number / 60.0, _CHARACTERS, 1)
            frames.append(session.step(asked.velocity * scale, asked.facing))
    return frames


def _positions(frames: list[Frame], skeleton: Skeleton) -> Vectors:
    """Return where joints are in the world, `(T, N, J, 3)`."""
    hips, local, root = (
        np.array([getattr(frame, name) for frame in frames])
        for name in ("hips", "rotations", "root")
    )
    joints, _ = kinematics.forward(skeleton, hips, local)
    turn = np.broadcast_to(root[:, :, None, 3:], (*joints.shape[:-1], 4))
    return root[:, :, None, :3] + quaternion.rotate(turn, joints)


def _bones(joints: Vectors, pairs: list[tuple[int, int]]) -> Vectors:
    ways = np.stack([joints[..., b, :] - joints[..., a, :] for a, b in pairs], axis=-2)
    return np.asarray(ways / np.linalg.norm(ways, axis=-1, keepdims=True))


def _slide(toes: Vectors, frames: list[Frame]) -> float:
    """Return the mean planar speed of locked toes; cm/s."""
    locked: Floats = ~np.isnan([frame.foot_targets[..., 0] for frame in frames])
    speed = np.linalg.norm(np.diff(toes[..., (0, 2)], axis=0), axis=-1) * 60.0
    return 100.0 * float(speed[locked[1:] & locked[:-1]].mean())
