"""Pictures of live output: a rig of somebody else's below the reference, at the same moments."""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from rig_figures import real_rigs

from stridewire import Client, Frame
from stridewire.drawing.camera import Camera
from stridewire.drawing.stick_figure import draw_moment
from stridewire.drawing.subject import Subject
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats
from stridewire.motion.sides import head_joint, joint_sides
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire.scripts import script
from stridewire_engine.rigs.rig import rig_of

matplotlib.use("Agg")
from matplotlib import pyplot as plt

_SECONDS = 6.0
_MOMENTS = 12
_TOES = ("LeftToe", "RightToe")


def draw(name: str, path: Path) -> None:
    """Draw each rig of the capture below the reference."""
    client = Client.in_process()
    subjects = [_subject(client, "reference", REFERENCE, None, name)]
    for rig, skeleton in real_rigs():
        subjects.append(_subject(client, rig, skeleton, skeleton, name))
    figure, axes = plt.subplots(len(subjects), _MOMENTS, figsize=(1.4 * _MOMENTS, 5.6))
    frames = np.linspace(60, 60.0 * _SECONDS - 1, _MOMENTS).astype(np.intp)
    camera = Camera.beside(subjects[0])
    for row, subject in zip(axes, subjects, strict=True):
        for axis, frame in zip(row, frames, strict=True):
            draw_moment(axis, subject, camera, int(frame))
        row[0].set_title(subject.name, fontsize=9, loc="left")
    figure.subplots_adjust(0, 0, 1, 0.96, 0, 0.02)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def _subject(
    client: Client, name: str, skeleton: Skeleton, output: Skeleton | None, gait: str
) -> Subject:
    rig = rig_of(skeleton)
    frames = _drive(client, output, rig.scale if output else 1.0, gait)
    root = np.array([frame.root[0] for frame in frames])
    hips, local = (np.array([getattr(f, k)[0] for f in frames]) for k in ("hips", "rotations"))
    joints, _ = kinematics.forward(skeleton, hips, local)
    turn = np.broadcast_to(root[:, None, 3:], (*joints.shape[:-1], 4))
    at = dict(zip(rig.parts, rig.joints.tolist(), strict=True))
    return Subject(
        name,
        60.0,
        skeleton.parents,
        joint_sides(skeleton.names),
        root[:, None, :3] + quaternion.rotate(turn, joints),
        root[:, :3],
        np.asarray(quaternion.to_yaw(root[:, 3:])),
        np.array([at[toe] for toe in _TOES]),
        ~np.isnan(_targets(frames)),
        head_joint(skeleton.names),
    )


def _targets(frames: list[Frame]) -> Floats:
    return np.array([frame.foot_targets[0, :, 0] for frame in frames])


def _drive(client: Client, output: Skeleton | None, scale: float, gait: str) -> list[Frame]:
    controls = script(gait).controls
    with client.open_session(1, output_skeleton=output, seed=2) as session:
        asked = [controls(number / 60.0, 1, 2) for number in range(round(60.0 * _SECONDS))]
        return [session.step(one.velocity * scale, one.facing) for one in asked]


if __name__ == "__main__":
    draw(sys.argv[1], Path(sys.argv[2]))
