"""Feet: planted toes stay where they are, by a soft lock and two-bone inverse kinematics.

The lock follows Holden's *Motion-Matching* (`contact_update`): at the begin of a contact the shown
toe is pinned; at its end, or where the motion has gone too far away, it is let go; both ways the
difference decays as a spring, so that nothing pops. A foot locks again only after the clip's
contact has ended.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.contacts import rest_heights
from stridewire.motion.skeleton import Skeleton
from stridewire.motion.springs import decay_spring_damper_exact
from stridewire.motion.two_bone_ik import two_bone_ik
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings

_SIDES = ("Left", "Right")
_LOWEST_TOE = 0.5
"""A toe is never lower than so much of its height at rest."""


class Legs(NamedTuple):
    """Joints of both legs of a skeleton and their offsets; arrays over left and right."""

    thigh: Indices
    shin: Indices
    foot: Indices
    toe: Indices
    offsets: Floats
    """`(4, 2, 3)` float32 rest offsets of thigh, shin, foot, toe."""
    toe_height: float
    """Height of a toe joint at rest, metres."""

    @classmethod
    def of(cls, skeleton: Skeleton) -> "Legs":
        """Find the legs of a skeleton in the reference's names."""
        joints = [
            skeleton.indices([f"{side}{part}" for side in _SIDES])
            for part in ("UpLeg", "Leg", "Foot", "Toe")
        ]
        offsets = np.stack([skeleton.offsets[joint] for joint in joints]).astype(np.float32)
        thigh, shin, foot, toe = joints
        height = float(rest_heights(skeleton, toe)[0])
        return cls(thigh, shin, foot, toe, offsets, height)


class _LegPose(NamedTuple):
    """Joints of both legs in the root's frame: positions `(N, 2, 3)`, rotations `(N, 2, 4)`."""

    hip: Vectors
    knee: Vectors
    ankle: Vectors
    toe: Vectors
    thigh: Quaternions
    shin: Quaternions
    foot: Quaternions


def plant(
    state: Characters,
    legs: Legs,
    hips: Vectors,
    rotations: Quaternions,
    contacts: Flags,
    dt: Floats,
    settings: TickSettings,
) -> Quaternions:
    """Lock planted toes in the world and bend the legs accordingly.

    Args:
        state: N rows, the root already moved; locks and what was shown are updated.
        legs: Of the skeleton.
        hips: `(N, 3)` relative to the root.
        rotations: `(N, J, 4)` local, stitched.
        contacts: `(N, 4)` of the clip now.
        dt: `(N,)` seconds.
        settings: Half-life and distances.

    Returns:
        `(N, J, 4)` local rotations with the legs bent.
    """
    pose = _leg_pose(legs, hips, rotations)
    toe = _to_world(state, pose.toe)
    shown_toe = _lock(state, toe, contacts[:, 1::2], legs.toe_height, dt, settings)
    lowest = state.root_position[:, None, 1] + _LOWEST_TOE * legs.toe_height
    shown_toe[..., 1] = np.maximum(shown_toe[..., 1], lowest)
    shift = _turn_to_root(state, shown_toe - toe).astype(np.float32)
    ahead = np.broadcast_to(np.array([0.0, 0.0, 1.0], np.float32), pose.ankle.shape)
    limb = two_bone_ik(
        pose.hip,
        pose.knee,
        pose.ankle,
        pose.thigh,
        pose.shin,
        pose.ankle + shift,
        quaternion.rotate(pose.shin, ahead),
    )
    toes = limb.end + (pose.toe - pose.ankle)
    _remember(state, np.concatenate([limb.end, toes, hips[:, None]], axis=1), dt)
    bent = rotations.copy()
    pelvis = rotations[:, :1]
    bent[:, legs.thigh] = quaternion.multiply(quaternion.conjugate(pelvis), limb.upper)
    bent[:, legs.shin] = quaternion.multiply(quaternion.conjugate(limb.upper), limb.lower)
    bent[:, legs.foot] = quaternion.multiply(quaternion.conjugate(limb.lower), pose.foot)
    return bent


def _leg_pose(legs: Legs, hips: Vectors, rotations: Quaternions) -> _LegPose:
    pelvis = rotations[:, :1]
    thigh = quaternion.multiply(pelvis, rotations[:, legs.thigh])
    shin = quaternion.multiply(thigh, rotations[:, legs.shin])
    foot = quaternion.multiply(shin, rotations[:, legs.foot])
    hip = hips[:, None] + quaternion.rotate(pelvis, legs.offsets[0])
    knee = hip + quaternion.rotate(thigh, legs.offsets[1])
    ankle = knee + quaternion.rotate(shin, legs.offsets[2])
    toe = ankle + quaternion.rotate(foot, legs.offsets[3])
    return _LegPose(hip, knee, ankle, toe, thigh, shin, foot)


def _lock(
    state: Characters,
    toe: Vectors,
    planted: Flags,
    toe_height: float,
    dt: Floats,
    settings: TickSettings,
) -> Vectors:
    """Update the locks and return where the toes `(N, 2, 3)` are shown, in the world."""
    passed = dt[:, None, None]
    velocity = np.where(passed > 0.0, (toe - state.toe) / np.maximum(passed, 1e-6), 0.0)
    first = (state.time <= dt)[:, None]
    velocity = np.where(first[..., None], 0.0, velocity).astype(np.float32)
    offset, offset_velocity = decay_spring_damper_exact(
        state.toe_offset, state.toe_offset_velocity, settings.foot_halflife, passed
    )
    shown = np.where(state.locked[..., None], state.lock_point, toe) + offset

    far = np.linalg.norm(state.lock_point - toe, axis=-1) > settings.unlock_distance
    begins = planted & (~state.planted | first) & state.foot_lock[:, None]
    ends = state.locked & (~planted | far | ~state.foot_lock[:, None])
    point = shown.copy()
    point[..., 1] = state.root_position[:, None, 1] + toe_height
    anchor = np.where(ends[..., None], toe, np.where(begins[..., None], point, 0.0))
    changed = (begins | ends)[..., None]
    state.toe_offset[...] = np.where(changed, shown - anchor, offset)
    # a foot that is let go starts from rest; one that lands stops dead, as shoes do
    at_rest = np.where(ends[..., None], offset_velocity - velocity, 0.0)
    state.toe_offset_velocity[...] = np.where(changed, at_rest, offset_velocity)
    state.lock_point[...] = np.where(begins[..., None], point, state.lock_point)
    state.locked[...] = (state.locked | begins) & ~ends
    state.planted[...] = planted
    state.toe[...] = toe
    return np.asarray(shown)


def _remember(state: Characters, local: Vectors, dt: Floats) -> None:
    """Note where `SHOWN_JOINTS` are shown and how fast they move, for the next query."""
    world = _to_world(state, local)
    moved = (dt > 0.0)[:, None, None]
    rate = (world - state.shown_world) / np.maximum(dt, 1e-6)[:, None, None]
    rate = np.where((state.time <= dt)[:, None, None], 0.0, rate)
    state.shown_velocity[...] = np.where(moved, _turn_to_root(state, rate), state.shown_velocity)
    state.shown_local[...] = local
    state.shown_world[...] = world


def _to_world(state: Characters, local: Vectors) -> Vectors:
    """Take points `(N, K, 3)` in the root's frame to the world, in float64."""
    sine, cosine = np.sin(state.root_yaw)[:, None], np.cos(state.root_yaw)[:, None]
    x, y, z = np.moveaxis(local, -1, 0)
    turned = np.stack([x * cosine + z * sine, y + 0.0 * sine, z * cosine - x * sine], axis=-1)
    return turned + state.root_position[:, None]


def _turn_to_root(state: Characters, v: Vectors) -> Vectors:
    sine, cosine = np.sin(state.root_yaw)[:, None], np.cos(state.root_yaw)[:, None]
    x, y, z = np.moveaxis(v, -1, 0)
    return np.stack([x * cosine - z * sine, y, x * sine + z * cosine], axis=-1)
