"""Features: what a moment of a clip looks like under a schema.

Everything is measured in the root's frame: x to the left, y up, z ahead.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.clip import Clip, differences
from stridewire_engine.library import LibraryError
from stridewire_engine.matching.schema import Channel, ChannelKind, Schema, SchemaError

_EXTRAPOLATION_S = 0.1
"""The last so many seconds' velocity goes on behind a clip's end."""
_STOP_SPEED = 0.1
"""A clip that ends slower than this, in m/s, has come to rest and may be entered to its end."""
_REST_S = 0.75
"""And has been so slow for so many seconds, so that whoever enters it can stay in it."""


@dataclass(frozen=True)
class Normalisation:
    """Raw features to normalised ones and back."""

    mean: Floats
    """`(D,)` float64."""
    deviation: Floats
    """`(D,)` float64, one value a channel, repeated."""

    def apply(self, raw: Floats, columns: slice | Indices = slice(None)) -> Floats:
        """Normalise features `(..., D)`, or some columns of them, to float32."""
        return np.asarray((raw - self.mean[columns]) / self.deviation[columns], np.float32)

    def undo(self, features: Floats) -> Floats:
        """Return raw `(..., D)` features, float64."""
        return np.asarray(features * self.deviation + self.mean, np.float64)


def clip_features(
    schema: Schema, clip: Clip, custom: Mapping[str, Callable[[Clip], Floats]] | None = None
) -> Floats:
    """Return the raw features `(T, D)` of every frame, float64.

    Args:
        schema: What is measured.
        clip: Where.
        custom: For each custom channel by name, what gives its numbers `(T, size)`.

    Raises:
        SkeletonError: If the clip's skeleton lacks a joint of the schema.
        SchemaError: If a custom channel has no source or another size.
    """
    pose = clip.pose.astype(np.float64)
    local, turned = kinematics.forward(clip.skeleton, pose.hips, pose.rotations)
    turn = pose.root_rotation[:, None]
    world = pose.root_position[:, None] + quaternion.rotate(turn, local)
    velocities = quaternion.rotate(
        quaternion.conjugate(turn), differences(world, 1.0 / clip.frame_rate)
    )
    yaw = np.unwrap(quaternion.to_yaw(pose.root_rotation))
    columns = []
    for channel in schema.channels:
        if channel.is_trajectory:
            columns.append(_trajectory(channel, clip, pose.root_position, yaw))
        elif channel.kind is ChannelKind.CUSTOM:
            columns.append(_custom(channel, clip, custom))
        else:
            source = {
                ChannelKind.POSITION: local,
                ChannelKind.VELOCITY: velocities,
                ChannelKind.HEADING: _headings(turned),
                ChannelKind.HEIGHT: world[..., 1:2],
            }[channel.kind]
            joints = clip.skeleton.indices(channel.joints)
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
    if clip.loops:
        margin = 1
    elif _ends_at_rest(clip):
        margin //= 3
    flags = np.zeros(len(clip), np.bool_)
    flags[: max(len(clip) - margin, 0)] = True
    return flags


def _custom(
    channel: Channel, clip: Clip, custom: Mapping[str, Callable[[Clip], Floats]] | None
) -> Floats:
    if not custom or channel.name not in custom:
        raise SchemaError(
            f"custom channel {channel.name!r} has no source; give one to build_library(custom=...)"
        )
    values = np.asarray(custom[channel.name](clip), np.float64)
    if values.shape != (len(clip), channel.size):
        raise SchemaError(
            f"custom channel {channel.name!r} gave {values.shape} for clip {clip.name!r}; "
            f"expected {(len(clip), channel.size)}"
        )
    return values


def _headings(rotations: Quaternions) -> Floats:
    """Return the forward axes of joints `(T, J, 4)` on the ground, `(T, J, 2)`, unit."""
    yaw = quaternion.to_yaw(rotations)
    return np.stack([np.sin(yaw), np.cos(yaw)], axis=-1)


def _ends_at_rest(clip: Clip) -> bool:
    frames = min(len(clip) - 1, round(_REST_S * clip.frame_rate))
    if frames < 1:
        return False
    way = clip.pose.root_position[-1] - clip.pose.root_position[-1 - frames]
    return bool(np.linalg.norm(way) < _STOP_SPEED * frames / clip.frame_rate)


def _trajectory(channel: Channel, clip: Clip, position: Vectors, yaw: Floats) -> Floats:
    """Return where the root will be and was, seen from the root, for each frame of a clip."""
    ahead = np.round(np.array(channel.times) * clip.frame_rate).astype(int)
    at = np.arange(len(clip))[:, None] + ahead
    positions, yaws = (_lapped if clip.loops else _extrapolated)(at, position, yaw, clip.frame_rate)
    offset = positions - position[:, None]
    sine, cosine = np.sin(yaw)[:, None], np.cos(yaw)[:, None]
    left = offset[..., 0] * cosine - offset[..., 2] * sine
    front = offset[..., 0] * sine + offset[..., 2] * cosine
    return trajectory_features(channel, np.stack([left, front], axis=-1), yaws - yaw[:, None])


def _extrapolated(
    at: Indices, position: Vectors, yaw: Floats, frame_rate: float
) -> tuple[Vectors, Floats]:
    """Return roots at frames `(T, K)`; outside the clip it goes on as in its outermost moments."""
    frames = len(position)
    span = min(frames - 1, max(1, round(_EXTRAPOLATION_S * frame_rate)))
    inside = np.clip(at, 0, frames - 1)
    beyond = at - inside
    first = np.where(beyond < 0, 0, frames - 1 - span)
    step = (position[first + span] - position[first]) / max(span, 1)
    turn = (yaw[first + span] - yaw[first]) / max(span, 1)
    return position[inside] + beyond[..., None] * step, yaw[inside] + beyond * turn


def _lapped(
    at: Indices, position: Vectors, yaw: Floats, frame_rate: float
) -> tuple[Vectors, Floats]:
    """Return roots at frames `(T, K)` of a loop: the same way again from where a lap ends."""
    lap = len(position) - 1
    laps, inside = np.divmod(at, lap)
    positions, yaws = position[inside], yaw[inside]
    turn = yaw[-1] - yaw[0]
    for count in range(1, int(np.abs(laps).max(initial=0)) + 1):
        later, earlier = laps >= count, laps <= -count
        positions = np.where(
            later[..., None], _moved(positions, position[0], position[-1], turn), positions
        )
        positions = np.where(
            earlier[..., None], _moved(positions, position[-1], position[0], -turn), positions
        )
        yaws = yaws + turn * later - turn * earlier
    return positions, yaws


def _moved(points: Vectors, origin: Vectors, target: Vectors, turn: float) -> Vectors:
    """Take points along from one origin to another one, turned by so many radians."""
    rotation = quaternion.from_yaw(np.full(points.shape[:-1], turn))
    return target + quaternion.rotate(rotation, points - origin)
