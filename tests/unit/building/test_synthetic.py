"""Synthetic clips: deterministic, planted, upright, tagged, and covering what they promise."""

import numpy as np
import pytest

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Vectors
from stridewire.motion.clip import Clip
from stridewire.motion.contacts import detect_contacts
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.synthetic import synthetic_clips

FEET = REFERENCE.indices(("LeftFoot", "LeftToe", "RightFoot", "RightToe"))
TOES = REFERENCE.indices(("LeftToe", "RightToe"))


@pytest.fixture(scope="module")
def clips() -> list[Clip]:
    """The default synthetic clips."""
    return synthetic_clips()


@pytest.fixture(scope="module")
def positions(clips: list[Clip]) -> list[Vectors]:
    """Joints in the world of each clip."""
    return [kinematics.forward_world(REFERENCE, clip.pose)[0] for clip in clips]


def _local(clip: Clip, vectors: Vectors) -> Vectors:
    back = quaternion.conjugate(clip.pose.root_rotation)[:, None]
    return quaternion.rotate(back, vectors)


def test_same_seed_same_clips(clips: list[Clip]) -> None:
    """The same seed gives the same bytes; another seed other motion."""
    again, other = synthetic_clips(0), synthetic_clips(1)
    for clip, same in zip(clips, again, strict=True):
        np.testing.assert_array_equal(clip.pose.rotations, same.pose.rotations)
        assert clip.tags == same.tags
    assert not np.array_equal(clips[0].pose.hips, other[0].pose.hips)


def test_every_drawn_clip_differs(clips: list[Clip]) -> None:
    """No two clips share their name or their frames."""
    assert len({clip.name for clip in clips}) == len(clips)
    assert len({clip.pose.rotations[60].tobytes() for clip in clips}) == len(clips)


def test_length_and_form(clips: list[Clip]) -> None:
    """Six to ten minutes of clips of 4 to 20 s, 60 frames/s, on the reference skeleton."""
    assert 360.0 < sum(clip.seconds for clip in clips) < 600.0
    for clip in clips:
        assert clip.skeleton == REFERENCE
        assert clip.frame_rate == 60.0
        assert 4.0 <= clip.seconds <= 20.0


def test_planted_toes_do_not_slide(clips: list[Clip], positions: list[Vectors]) -> None:
    """A toe in stance moves by less than 0.3 cm/s over the ground and stays at its rest height."""
    for clip, joints in zip(clips, positions, strict=True):
        toes = joints[:, TOES]
        planted = clip.contacts[:, [1, 3]]
        speed = np.linalg.norm(np.diff(toes, axis=0)[..., [0, 2]], axis=-1) * clip.frame_rate
        stays = planted[1:] & planted[:-1]
        assert speed[stays].mean() < 0.003, clip.name
        np.testing.assert_allclose(toes[planted][:, 1], 0.02, atol=0.003)


def test_nothing_sinks_or_squats(clips: list[Clip], positions: list[Vectors]) -> None:
    """Feet stay above the ground, the hips between 0.75 and 1.05 m, the head on top."""
    for clip, joints in zip(clips, positions, strict=True):
        assert joints[:, FEET, 1].min() > 0.015, clip.name
        assert joints[:, 0, 1].min() > 0.75, clip.name
        assert joints[:, 0, 1].max() < 1.05, clip.name
        assert joints[..., 1].max(axis=1).min() > 1.2, clip.name


def test_knees_bend_forward(clips: list[Clip], positions: list[Vectors]) -> None:
    """A bent knee lies in front of the line from hip to ankle."""
    for clip, joints in zip(clips, positions, strict=True):
        for hip, knee, ankle in ((1, 2, 3), (5, 6, 7)):
            middle = 0.5 * (joints[:, hip] + joints[:, ankle])
            ahead = _local(clip, (joints[:, knee] - middle)[:, None])[:, 0, 2]
            bent = np.linalg.norm(joints[:, hip] - joints[:, ankle], axis=-1) < 0.78
            assert np.all(ahead[bent] > 0.0), clip.name


def test_legs_do_not_cross(clips: list[Clip], positions: list[Vectors]) -> None:
    """The left ankle stays left of the right one, but in a few tight turns, as people's."""
    apart = np.concatenate(
        [
            _local(clip, joints[:, [3]] - joints[:, [7]])[:, 0, 0]
            for clip, joints in zip(clips, positions, strict=True)
        ]
    )
    assert np.mean(apart < 0.02) < 0.025
    assert apart.min() > -0.1


def test_recorded_contacts_agree_with_detected_ones(
    clips: list[Clip], positions: list[Vectors]
) -> None:
    """Contacts found by speed and height are nearly always the recorded ones."""
    found = [detect_contacts(REFERENCE, joints, 60.0) for joints in positions]
    toes = np.concatenate([f[:, [1, 3]] for f in found])
    recorded = np.concatenate([clip.contacts[:, [1, 3]] for clip in clips])
    assert np.mean(toes == recorded) > 0.95


def test_root_is_the_one_definition(clips: list[Clip]) -> None:
    """Extracting the root from the world motion again changes nothing but the clip's ends."""
    for clip in clips[::8]:
        hips, turn = clip.pose.world_hips
        rotations = clip.pose.rotations.copy()
        rotations[:, 0] = turn
        again = extract_root(REFERENCE, hips, rotations, clip.frame_rate)
        inner = slice(31, -31)
        np.testing.assert_allclose(
            again.root_position[inner], clip.pose.root_position[inner], atol=1e-6
        )


def test_covers_speeds_turns_and_tags(clips: list[Clip]) -> None:
    """Standing to 4 m/s, turns of 180 deg/s both ways, and every tag that a user would ask for."""
    speed = np.concatenate(
        [np.linalg.norm(np.gradient(c.pose.root_position, axis=0), axis=-1) * 60.0 for c in clips]
    )
    share, _ = np.histogram(speed, np.arange(0.0, 4.5, 0.5))
    assert np.all(share > 120)
    yaw = [np.unwrap(quaternion.to_yaw(c.pose.root_rotation)) for c in clips]
    turn = np.concatenate([np.gradient(y) * 60.0 for y in yaw])
    assert turn.max() > np.radians(170.0)
    assert turn.min() < -np.radians(170.0)
    tags = {tag.name for clip in clips for tag in clip.tags}
    expected = {"idle", "walk", "jog", "run", "turn", "turn-left", "turn-right", "start", "stop"}
    assert expected | {"backward", "sidestep"} <= tags


def test_tags_lie_within_their_clip(clips: list[Clip]) -> None:
    """Each span is of frames that the clip has."""
    for clip in clips:
        assert clip.tags
        assert all(0 <= tag.start < tag.end <= len(clip) for tag in clip.tags)


def test_backward_clips_travel_backward(clips: list[Clip]) -> None:
    """Where a clip is tagged backward the root moves against its heading."""
    for clip in (c for c in clips if c.name.startswith("backward")):
        velocity = np.gradient(clip.pose.root_position, axis=0) * 60.0
        ahead = _local(clip, velocity[:, None])[:, 0, 2]
        for tag in clip.tags:
            if tag.name == "backward":
                assert ahead[tag.start : tag.end].mean() < -0.2
