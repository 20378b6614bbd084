"""What is drawn: sides, units, axes, feet and headings, taken or guessed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stridewire.drawing import Subject
from stridewire.drawing.camera import Camera
from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.sides import joint_sides
from stridewire.motion.skeleton import REFERENCE, Skeleton


@pytest.fixture
def source(swaying_clip: Clip) -> Callable[..., SourceMotion]:
    """Return a maker of the swaying clip as a file in some unit, Y up or Z up."""

    def make(unit: float = 0.01, z_up: bool = False) -> SourceMotion:
        hips, turn = swaying_clip.pose.world_hips
        rotations = swaying_clip.pose.rotations.copy()
        rotations[:, 0] = turn
        if z_up:
            tip = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.pi / 2)
            hips = quaternion.rotate(np.broadcast_to(tip, (len(hips), 4)), hips)
            rotations[:, 0] = quaternion.multiply(tip, rotations[:, 0])
        skeleton = Skeleton(REFERENCE.names, REFERENCE.parents, REFERENCE.offsets / unit)
        return SourceMotion(Path("sway.bvh"), skeleton, {}, 60.0, hips / unit, rotations)

    return make


@pytest.mark.parametrize(
    ("names", "sides"),
    [
        (("Hips", "LeftLeg", "RightLeg", "Spine"), [0, 1, -1, 0]),
        (("root", "lfemur", "rfemur", "lowerback"), [0, 1, -1, 0]),
        (("Model_Hips", "Model_LeftUpLeg", "Model_RightUpLeg", "Neck"), [0, 1, -1, 0]),
        (("Bip01", "Bip01 L Thigh", "Bip01 R Thigh", "Bip01 Pelvis"), [0, 1, -1, 0]),
        (("hip", "l_leg", "r_leg", "left_only"), [0, 1, -1, 0]),
    ],
)
def test_sides_are_told_by_names_that_come_in_pairs(
    names: tuple[str, ...], sides: list[int]
) -> None:
    """Many exporters' names; a name that merely begins with l is no left joint."""
    assert joint_sides(names).tolist() == sides


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.0254])
@pytest.mark.parametrize("z_up", [False, True])
def test_files_come_out_in_metres_upright(
    source: Callable[..., SourceMotion], swaying_clip: Clip, unit: float, z_up: bool
) -> None:
    """Any unit and either axis give the clip's joints, but for the ground's height."""
    subject = Subject.of_source(source(unit, z_up))
    expected, _ = kinematics.forward_world(REFERENCE, swaying_clip.pose)
    lift = (subject.positions - expected)[..., 1]
    np.testing.assert_allclose(lift, lift[0, 0], atol=1e-9)
    np.testing.assert_allclose(subject.positions[..., [0, 2]], expected[..., [0, 2]], atol=1e-9)
    assert abs(subject.positions[..., 1].min()) < 0.1


def test_guesses_agree_with_what_the_clip_knows(
    source: Callable[..., SourceMotion], swaying_clip: Clip
) -> None:
    """Feet, heading and the way of a file are those of the clip it was made of."""
    guessed, known = Subject.of_source(source()), Subject.of_clip(swaying_clip)
    left, right = (REFERENCE.names[foot] for foot in guessed.feet)
    assert left in ("LeftFoot", "LeftToe")
    assert right in ("RightFoot", "RightToe")
    assert guessed.planted.shape == (121, 2)
    assert np.abs(guessed.root - known.root).max() < 0.2
    # hips lead and lag the smoothed root by the sway of 0.4 rad
    turn = np.angle(np.exp(1j * (guessed.heading - known.heading)))
    assert np.abs(turn).max() < 0.6
    assert guessed.seconds == known.seconds == 2.0


def test_a_file_without_a_rate_needs_one(source: Callable[..., SourceMotion]) -> None:
    """AMC does not say; the caller must."""
    silent = replace(source(), frame_rate=None)
    with pytest.raises(ValueError, match=r"sway\.bvh does not say its frame rate"):
        Subject.of_source(silent)
    assert Subject.of_source(silent, 120.0).seconds == 1.0


def test_planted_feet_are_low_and_slow() -> None:
    """A foot that is lifted or slides is not planted."""
    chain = Skeleton(
        ("Hips", "LeftFoot", "RightFoot"),
        (-1, 0, 0),
        np.array([[0.0, 1.0, 0.0], [0.1, -1.0, 0.0], [-0.1, -1.0, 0.0]]),
    )
    moves = np.tile(chain.offsets, (90, 1, 1))
    moves[30:60, 1, 1] += 0.3
    moves[60:, 1, 2] += np.arange(30) / 60.0
    still = quaternion.identity(90, 3, dtype=np.float64)
    hips = np.tile([0.0, 1.0, 0.0], (90, 1))
    subject = Subject.of_source(SourceMotion(Path("a"), chain, {}, 60.0, hips, still, moves, 1.0))
    assert subject.planted[:29, 0].all()
    assert not subject.planted[31:, 0].any()
    assert subject.planted[:, 1].all()


def test_a_span_keeps_its_frames_and_an_empty_one_is_refused(swaying_clip: Clip) -> None:
    """Half a second is 31 frames at 60 a second; a span behind the end names the length."""
    subject = Subject.of_clip(swaying_clip)
    half = subject.between(1.0, 1.5)
    np.testing.assert_array_equal(half.positions, subject.positions[60:91])
    with pytest.raises(ValueError, match=r"sway lasts 2\.00 s"):
        subject.between(3.0, 4.0)


def test_the_camera_sees_walkers_go_right_and_left_limbs_nearer_or_farther(
    swaying_clip: Clip,
) -> None:
    """Whatever way a subject walks, the picture shows it going right and coming nearer."""
    subject = Subject.of_clip(swaying_clip)
    for yaw in (0.0, 1.0, 2.5, -2.0):
        turn = quaternion.from_yaw(np.full(121, yaw))
        turned = replace(subject, root=quaternion.rotate(turn, subject.root))
        points, depth = Camera.beside(turned).project(turned.root, turned.root[0])
        assert points[-1, 0] > points[0, 0] + 0.5
        assert depth[-1] < depth[0]


def test_the_picture_has_height_up_and_metres_at_the_target() -> None:
    """A metre at the camera's target is a unit of the picture, along the ground and nearly up."""
    camera = Camera(0.4)
    target = np.array([0.0, 0.85, 0.0])
    points, _ = camera.project(
        np.stack([target, target + camera.right, target + np.array([0.0, 0.1, 0.0])]), np.zeros(3)
    )
    np.testing.assert_allclose(points[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(points[1], [1.0, 0.0], atol=1e-12)
    assert 0.09 < points[2, 1] < 0.1
