"""Features: what a moment of a clip looks like under a schema.

Everything is measured in the root's frame: x to the left, y up, z ahead.
"""

from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Vectors
from stridewire.motion.clip import Clip, differences
from stridewire_engine.library import LibraryError
from stridewire_engine.matching.schema import Channel, ChannelKind, Schema

_EXTRAPOLATION_S = 0.1
"""The last so many seconds' velocity goes on behind a clip's end."""
_STOP_SPEED = 0.1
"""A clip that ends slower than this, in m/s, has come to rest and may be entered to its end."""


@dataclass(frozen=True)
class Normalisation:
    """Raw features to normalised ones and back."""

    mean: Floats
    """`(D,)` float64."""
    deviation: Floats
    """`(D,)` float64, one value a channel, repeated."""

    def apply(self, raw: Floats, columns: slice = slice(None)) -> Floats:
        """Normalise features `(..., D)`, or some columns of them, to float32."""
        return np.asarray((raw - self.mean[columns]) / self.deviation[columns], np.float32)

    def undo(self, features: Floats) -> Floats:
        """Return raw `(..., D)` features, float64."""
        return np.asarray(features * self.deviation + self.mean, np.float64)


def clip_features(schema: Schema, clip: Clip) -> Floats:
    """Return the raw features `(T, D)` of every frame, float64.

    Raises:
        SkeletonError: If the clip's skeleton lacks a joint of the schema.
    """
    pose = clip.pose.astype(np.float64)
    local, _ = kinematics.forward(clip.skeleton, pose.hips, pose.rotations)
    turn = pose.root_rotation[:, None]
    world = pose.root_position[:, None] + quaternion.rotate(turn, local)
    velocities = quaternion.rotate(
        quaternion.conjugate(turn), differences(world, 1.0 / clip.frame_rate)
    )
    yaw = np.unwrap(quaternion.to_yaw(pose.root_rotation))
    columns = []
    for channel in schema.channels:
        if channel.is_trajectory:
            columns.append(_trajectory(channel, pose.root_position, yaw, clip.frame_rate))
        else:
            joints = clip.skeleton.indices(channel.joints)
            source = local if channel.kind is ChannelKind.POSITION else velocities
            columns.append(source[:, joints].reshape(len(clip), -1))
    return np.concatenate(columns, axis=1)


def trajectory_features(channel: Channel, positions: Floats, yaws: Floats) -> Floats:
    """Return features `(N, 2K)` of roots in the future, as seen from the root now.

    Args:
        channel: A trajectory channel of K times.
        positions: `(N, K, 2)` x and z in the root's frame, metres.
        yaws: `(N, K)` relative to the root, radians.
    """
    if channel.kind is ChannelKind.TRAJECTORY_POSITION:
        return positions.reshape(len(positions), -1)
    return np.stack([np.sin(yaws), np.cos(yaws)], axis=-1).reshape(len(yaws), -1)


def normalisation(schema: Schema, raw: Floats) -> Normalisation:
    """Return mean and deviation of raw features `(F, D)`: one deviation a channel.

    Raises:
        LibraryError: If a channel does not vary at all; the message names it.
    """
    spread = raw.std(axis=0)
    by_channel = np.add.reduceat(spread, schema.starts) / np.array(
        [channel.dimensions for channel in schema.channels]
    )
    for channel, deviation in zip(schema.channels, by_channel, strict=True):
        if not deviation > 1e-6:
            raise LibraryError(
                f"channel {channel.name!r} is the same in every frame, so it cannot be compared; "
                "add clips that move, or leave the channel out of the schema"
            )
    return Normalisation(raw.mean(axis=0), by_channel[schema.channel_of])


def startable_frames(schema: Schema, clip: Clip) -> Flags:
    """Return `(T,)`: frames that a search may choose.

    Frames within the schema's horizon of the end do not know their future, so they are left out,
    unless the clip ends at rest, where staying put *is* the future; then only the last third of the
    horizon is.
    """
    margin = round(schema.horizon * clip.frame_rate)
    if _ends_at_rest(clip):
        margin //= 3
    flags = np.zeros(len(clip), np.bool_)
    flags[: max(len(clip) - margin, 0)] = True
    return flags


def _ends_at_rest(clip: Clip) -> bool:
    frames = min(len(clip) - 1, round(0.25 * clip.frame_rate))
    if frames < 1:
        return False
    way = clip.pose.root_position[-1] - clip.pose.root_position[-1 - frames]
    return bool(np.linalg.norm(way) < _STOP_SPEED * frames / clip.frame_rate)


def _trajectory(channel: Channel, position: Vectors, yaw: Floats, frame_rate: float) -> Floats:
    frames = len(position)
    last = min(frames - 1, max(1, round(_EXTRAPOLATION_S * frame_rate)))
    step = (position[-1] - position[-1 - last]) / max(last, 1)
    yaw_step = (yaw[-1] - yaw[-1 - last]) / max(last, 1)
    ahead = np.arange(frames)[:, None] + np.round(np.array(channel.times) * frame_rate).astype(int)
    inside = np.minimum(ahead, frames - 1)
    beyond = (ahead - inside)[..., None]
    offset = position[inside] + beyond * step - position[:, None]
    turn = yaw[inside] + beyond[..., 0] * yaw_step - yaw[:, None]
    sine, cosine = np.sin(yaw)[:, None], np.cos(yaw)[:, None]
    left = offset[..., 0] * cosine - offset[..., 2] * sine
    front = offset[..., 0] * sine + offset[..., 2] * cosine
    return trajectory_features(channel, np.stack([left, front], axis=-1), turn)
