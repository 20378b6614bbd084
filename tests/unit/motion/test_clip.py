"""Clips: sampling, cutting, refusals, rates of change."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.clip import Clip, ClipError, Pose, TagSpan, differences


def test_sampling_at_frame_times_gives_the_frames(swaying_clip: Clip) -> None:
    """Between frames is interpolated, on a frame nothing is."""
    sampled = swaying_clip.sample(np.arange(len(swaying_clip)) / 60.0)
    for field in ("root_position", "root_rotation", "hips", "rotations"):
        np.testing.assert_allclose(
            getattr(sampled, field), getattr(swaying_clip.pose, field), atol=1e-9
        )


def test_sampling_between_frames_blends_neighbours(swaying_clip: Clip) -> None:
    """A quarter of the way is a quarter of the way, by nlerp."""
    a, b = swaying_clip.pose[30], swaying_clip.pose[31]
    pose = swaying_clip.sample(30.25 / 60.0)
    np.testing.assert_allclose(pose.hips, 0.75 * a.hips + 0.25 * b.hips)
    expected = quaternion.nlerp(a.rotations, b.rotations, np.array(0.25))
    np.testing.assert_allclose(pose.rotations, expected)


def test_sampling_past_the_ends_gives_the_ends(swaying_clip: Clip) -> None:
    """Times are clamped to the clip, in any shape."""
    pose = swaying_clip.sample(np.array([[-1.0, 99.0]]))
    assert pose.rotations.shape == (1, 2, 22, 4)
    np.testing.assert_allclose(pose.hips[0, 0], swaying_clip.pose.hips[0])
    np.testing.assert_allclose(pose.hips[0, 1], swaying_clip.pose.hips[-1])


def test_a_clip_of_one_frame_can_be_sampled(swaying_clip: Clip) -> None:
    """One frame is a clip without length."""
    still = swaying_clip.cut(5, 6)
    assert still.seconds == 0.0
    np.testing.assert_allclose(still.sample(3.0).hips, swaying_clip.pose.hips[5])


def test_cut_moves_and_trims_tags(swaying_clip: Clip) -> None:
    """Tags keep naming the same frames; those outside are gone."""
    part = swaying_clip.cut(20, 90, "part")
    assert (part.name, len(part)) == ("part", 70)
    assert part.tags == (TagSpan("walk", 0, 70), TagSpan("turn-left", 0, 20))
    np.testing.assert_array_equal(part.contacts, swaying_clip.contacts[20:90])
    np.testing.assert_array_equal(part.pose.hips, swaying_clip.pose.hips[20:90])


def test_wrong_shapes_are_refused_by_name(swaying_clip: Clip) -> None:
    """The message names clip, array and both shapes."""
    pose = replace(swaying_clip.pose, hips=swaying_clip.pose.hips[:5])
    with pytest.raises(ClipError, match=r"'sway': hips has shape \(5, 3\); expected \(121, 3\)"):
        replace(swaying_clip, pose=pose)
    with pytest.raises(ClipError, match="contacts have shape"):
        replace(swaying_clip, contacts=swaying_clip.contacts[:, :2])


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(swaying_clip: Clip, bad: float) -> None:
    """NaN does not get into a library."""
    position = swaying_clip.pose.root_position.copy()
    position[7, 1] = bad
    with pytest.raises(ClipError, match="root_position is not finite"):
        replace(swaying_clip, pose=replace(swaying_clip.pose, root_position=position))


def test_no_frames_or_rate_are_refused(swaying_clip: Clip) -> None:
    """A clip has at least one frame and a positive rate."""
    with pytest.raises(ClipError, match="at least one frame"):
        swaying_clip.cut(5, 5)
    with pytest.raises(ClipError, match="positive rate"):
        replace(swaying_clip, frame_rate=0.0)


def test_concatenated_poses_are_the_parts_in_order(swaying_clip: Clip) -> None:
    """Splitting and joining changes nothing."""
    pose = swaying_clip.pose
    joined = Pose.concatenate([pose[:40], pose[40:]])
    np.testing.assert_array_equal(joined.rotations, pose.rotations)
    np.testing.assert_array_equal(joined.root_position, pose.root_position)


def test_differences_are_central_inside_and_one_sided_at_the_ends() -> None:
    """A parabola's rate is exact inside; the ends take their only neighbour."""
    t = np.arange(6) / 30.0
    rate = differences(t[:, None] ** 2, 1.0 / 30.0)[:, 0]
    np.testing.assert_allclose(rate[1:-1], 2.0 * t[1:-1])
    np.testing.assert_allclose(rate[[0, -1]], [1.0 / 30.0, 9.0 / 30.0])


def test_a_single_frame_does_not_move() -> None:
    """There is no velocity of one frame."""
    np.testing.assert_array_equal(differences(np.ones((1, 4, 3)), 1.0 / 60.0), np.zeros((1, 4, 3)))
