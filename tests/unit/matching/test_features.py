"""Features: what is measured, in which frame, and what may be chosen."""

import numpy as np
import pytest

from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.matching.features import clip_features, normalisation, startable_frames
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.matching.schema import Channel, ChannelKind, Schema, SchemaError

EXACT = 1e-9


def walking(speed: float, yaw_rate: float, frames: int = 181, yaw: float = 0.7) -> Clip:
    """Return a stiff figure gliding at a constant speed and turning rate."""
    time = np.arange(frames) / 60.0
    heading = yaw + yaw_rate * time
    step = speed / 60.0 * np.stack([np.sin(heading), 0.0 * time, np.cos(heading)], axis=-1)
    root = np.concatenate([np.zeros((1, 3)), np.cumsum(step[:-1], axis=0)])
    pose = Pose(
        root,
        quaternion.from_yaw(heading),
        np.tile([0.0, 0.95, 0.0], (frames, 1)),
        quaternion.identity(frames, len(REFERENCE), dtype=np.float64),
    )
    return Clip("glide", REFERENCE, 60.0, pose, np.zeros((frames, 4), np.bool_))


def column(features: np.ndarray, name: str) -> np.ndarray:
    """Return a channel's columns."""
    channel = next(c for c in LOCOMOTION.channels if c.name == name)
    return features[:, LOCOMOTION.slice(channel)]


def test_the_preset_has_the_classic_27_features() -> None:
    """Positions 6, velocities 9, trajectory 12."""
    assert LOCOMOTION.dimensions == 27
    assert [channel.dimensions for channel in LOCOMOTION.channels] == [6, 6, 3, 6, 6]


def test_a_glide_ahead_has_velocity_and_trajectory_along_z() -> None:
    """A figure gliding ahead moves along its own +Z whatever its heading in the world."""
    features = clip_features(LOCOMOTION, walking(1.2, 0.0))[60]
    assert np.allclose(features[12:15], [0.0, 0.0, 1.2], atol=EXACT)
    assert np.allclose(features[15:21], [0, 0.4, 0, 0.8, 0, 1.2], atol=EXACT)
    assert np.allclose(features[21:27], [0, 1] * 3, atol=EXACT)


def test_feet_are_measured_from_the_root() -> None:
    """Foot positions are those of forward kinematics without the root."""
    clip = walking(1.0, 0.5)
    local, _ = kinematics.forward(REFERENCE, clip.pose.hips, clip.pose.rotations)
    feet = column(clip_features(LOCOMOTION, clip), "foot-position")
    assert np.allclose(feet, local[:, [3, 7]].reshape(len(clip), -1), atol=EXACT)


def test_a_left_turn_is_a_positive_angle() -> None:
    """Turning about +Y shows as forward axes leaning to +X, the left."""
    directions = column(clip_features(LOCOMOTION, walking(1.0, 0.5)), "trajectory-direction")
    angles = np.arctan2(directions[30, 0::2], directions[30, 1::2])
    assert np.allclose(angles, 0.5 * np.array([20, 40, 60]) / 60, atol=1e-6)


def test_the_future_behind_the_end_goes_on_as_before() -> None:
    """Close to a clip's end the trajectory is continued, not clamped to a false stop."""
    features = clip_features(LOCOMOTION, walking(1.2, 0.0))
    assert np.allclose(features[-1], features[60], atol=1e-6)


def test_frames_without_a_known_future_are_not_startable() -> None:
    """The last horizon of a moving clip is left out; a clip that comes to rest keeps most of it."""
    moving, resting = walking(1.2, 0.0), walking(0.0, 0.0)
    assert startable_frames(LOCOMOTION, moving).sum() == len(moving) - 60
    assert startable_frames(LOCOMOTION, resting).sum() == len(resting) - 20


def test_normalised_features_have_one_deviation_a_channel(small_library: Library) -> None:
    """The mean of a channel's deviations is 1; its dimensions keep their proportions."""
    spread = small_library.features.std(axis=0)
    by_channel = [spread[LOCOMOTION.slice(c)].mean() for c in LOCOMOTION.channels]
    assert np.allclose(by_channel, 1.0, atol=1e-3)
    assert np.allclose(small_library.features.mean(axis=0), 0.0, atol=1e-3)


def test_a_channel_that_never_varies_is_an_error_that_names_it() -> None:
    """Zero deviation cannot be divided by."""
    with pytest.raises(LibraryError, match="foot-position"):
        normalisation(LOCOMOTION, clip_features(LOCOMOTION, walking(1.2, 0.4)))


def test_a_schema_survives_as_data() -> None:
    """Writing a schema to plain data and reading it back gives the same schema."""
    assert Schema.from_data(LOCOMOTION.to_data()) == LOCOMOTION


def test_a_schema_that_is_not_understood_is_refused() -> None:
    """An unknown kind of channel is an error of the library."""
    data = Schema("odd", (Channel("a", ChannelKind.POSITION, 1.0, ("Hips",)),)).to_data()
    data["channels"][0]["kind"] = "smell"
    with pytest.raises(SchemaError, match="smell"):
        Schema.from_data(data)
