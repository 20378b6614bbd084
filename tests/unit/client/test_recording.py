"""Recordings: frames become clips at an even rate, whatever was dropped or paused."""

import numpy as np
import pytest

from stridewire._messages import Frame
from stridewire.motion import quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.contacts import to_mask
from stridewire.recording import Recording, toe_sliding

FLOAT32 = 1e-5
"""Clips in float64 pass through float32 frames."""


def frames_of(clip: Clip, ids: list[int]) -> list[Frame]:
    """Return the frames that a session would send for a clip, the same for each character."""
    count = len(ids)
    characters = np.array(ids, np.uint32)
    masks = to_mask(clip.contacts)
    root = np.concatenate([clip.pose.root_position, clip.pose.root_rotation], axis=1)

    def repeat(values: np.ndarray) -> np.ndarray:
        return np.repeat(values[None], count, axis=0).astype(np.float32)

    return [
        Frame(
            i + 1,
            i,
            5.0 + i / clip.frame_rate,
            0.0,
            characters,
            repeat(root[i]),
            np.zeros((count, 4)),
            repeat(clip.pose.hips[i]),
            repeat(clip.pose.rotations[i]),
            np.repeat(masks[i], count),
            np.zeros((count, 2, 3)),
            np.zeros(count, np.uint32),
        )
        for i in range(len(clip))
    ]


def record(clip: Clip, frames: list[Frame]) -> Recording:
    """Return a recording of frames."""
    recording = Recording(clip.skeleton)
    for frame in frames:
        recording.add(frame)
    return recording


def same_rotation(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return angles between rotations."""
    return np.abs(
        quaternion.to_scaled_axis(
            quaternion.absolute(quaternion.multiply(quaternion.conjugate(a), b))
        )
    )


def test_even_frames_are_the_clip(swaying_clip: Clip) -> None:
    """What was sent at an even rate comes back as it was, for each character."""
    recording = record(swaying_clip, frames_of(swaying_clip, [4, 7]))
    assert recording.characters == [4, 7]
    for character in (4, 7):
        got = recording.clip(character, "again")
        assert len(got) == len(swaying_clip)
        np.testing.assert_allclose(
            got.pose.root_position, swaying_clip.pose.root_position, atol=FLOAT32
        )
        np.testing.assert_allclose(got.pose.hips, swaying_clip.pose.hips, atol=FLOAT32)
        assert same_rotation(got.pose.rotations, swaying_clip.pose.rotations).max() < 1e-3
        np.testing.assert_array_equal(got.contacts, swaying_clip.contacts)


def test_dropped_frames_are_filled_in(swaying_clip: Clip) -> None:
    """Every third frame is missing: the clip has its length and stays near the motion."""
    frames = [f for i, f in enumerate(frames_of(swaying_clip, [0])) if i % 3 != 1]
    got = record(swaying_clip, frames).clip(0, "gaps")
    assert len(got) == len(swaying_clip)
    np.testing.assert_allclose(got.pose.root_position, swaying_clip.pose.root_position, atol=2e-3)
    assert same_rotation(got.pose.rotations, swaying_clip.pose.rotations).max() < 0.01


def test_a_pause_takes_no_time(swaying_clip: Clip) -> None:
    """Frames of the same moment count once."""
    frames = frames_of(swaying_clip, [0])
    got = record(swaying_clip, [*frames[:10], *[frames[9]] * 30, *frames[10:]]).clip(0, "paused")
    assert len(got) == len(swaying_clip)


def test_a_character_that_came_late_has_a_shorter_clip(swaying_clip: Clip) -> None:
    """Its clip begins with its first frame; a stranger has none; one frame is a clip."""
    early, late = frames_of(swaying_clip, [0]), frames_of(swaying_clip, [0, 1])
    recording = record(swaying_clip, early[:20] + late[20:])
    assert len(recording.clip(1, "late")) == len(swaying_clip) - 20
    with pytest.raises(LookupError, match="character 5"):
        recording.clip(5, "nobody")
    assert len(record(swaying_clip, early[:1]).clip(0, "one")) == 1


def test_sliding_is_the_planar_speed_of_planted_toes(swaying_clip: Clip) -> None:
    """A body that is carried stiffly at 0.3 m/s with one toe planted slides at 0.3 m/s."""
    frames = 31
    still = swaying_clip.cut(0, 1)
    pose = still.pose[np.zeros(frames, int)]
    pose.root_position[:, 0] = 0.3 * np.arange(frames) / 60.0
    contacts = np.zeros((frames, 4), bool)
    contacts[:, 1] = True
    clip = Clip("carried", still.skeleton, 60.0, pose, contacts)
    speeds = toe_sliding(clip)
    assert len(speeds) == frames - 1
    np.testing.assert_allclose(speeds, 0.3, atol=1e-9)
    contacts[:, 1] = False
    assert len(toe_sliding(clip)) == 0
