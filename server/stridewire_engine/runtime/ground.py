"""Ground: what was made on a flat floor is laid on the ground that the caller tells of.

Everything before this stage happens on a level floor at the height of the root. Here the root rises
to the ground under it, each foot to the ground under its own, feet tilt with the ground while they
are near it, and the hips sink where a leg would be too short; springs smooth what comes in steps.
"""

from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire.motion.springs import decay_spring_damper_exact, spring_damper_exact
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.stitchers.legs import LegPose, Legs, bend, leg_pose, raise_heels, turn_feet

_HALFLIFE = 0.08
"""Spring of steps in height and of changes of slope; walking up a slope is neither."""
_SINK_HALFLIFE = 0.1
_REACH = 0.985
_DEEPEST = 0.4
_TILT_BELOW = 0.15
"""Feet tilt while their toes are less than so many metres above the floor, the more the nearer."""


class Laid(NamedTuple):
    """What N characters show on their ground."""

    lift: Floats
    """`(N,)` metres that the root is higher."""
    rise: Floats
    """`(N, 2)` metres that the ground under each foot is higher than the floor."""
    hips: Vectors
    """`(N, 3)` relative to the root."""
    rotations: Quaternions
    """`(N, J, 4)` local."""


def lay(state: Characters, legs: Legs, hips: Vectors, rotations: Quaternions, dt: Floats) -> Laid:
    """Lay poses on the ground.

    Args:
        state: N characters that were told of their ground; its smoothing is advanced.
        legs: Of the skeleton.
        hips: `(N, 3)` relative to the root, on the floor.
        rotations: `(N, J, 4)` local.
        dt: `(N,)` seconds.
    """
    pose = leg_pose(legs, hips, rotations)
    _smooth(state, pose, dt)
    lift, rise = state.terrain[:, 0], state.terrain[:, 1:3]
    shift = np.zeros(pose.toe.shape)
    shift[..., 1] = rise - lift[:, None]
    turned = turn_feet(legs, pose, _tilt(state, pose, legs))
    # feet turn about their toes, not their ankles
    toes = pose.toe + shift
    ankles = toes + turned.ankle - turned.toe
    sink = _sink(state, legs, pose, ankles, dt)
    reach = np.maximum(_REACH * legs.length, np.linalg.norm(pose.hip - pose.ankle, axis=-1))
    low = turned.lowered(sink.astype(np.float32))
    low, near = raise_heels(low, toes.astype(np.float32), reach.astype(np.float32))
    bent, _ = bend(legs, low, rotations, near)
    hips = hips.copy()
    hips[:, 1] -= sink
    return Laid(lift.copy(), rise.copy(), hips, bent)


def _smooth(state: Characters, pose: LegPose, dt: Floats) -> None:
    """Follow the ground that was told of; what does not lie on its slopes decays as a spring."""
    toes = (turn_to_world(pose.toe, state.root_yaw) + state.root_position[:, None])[..., [0, 2]]
    points = np.concatenate([state.root_position[:, None, ::2], toes], axis=1)
    goal, slopes = _told(state, points)
    fresh = (~state.on_ground | (state.time <= dt))[:, None]
    moved = np.sum(slopes * (points - state.ground_points), axis=-1)
    carried = state.terrain + np.pad(moved, ((0, 0), (0, 4)))
    error: Floats = np.where(fresh, 0.0, carried - goal)
    speed: Floats = np.where(fresh, 0.0, state.terrain_speed)
    error, speed = decay_spring_damper_exact(error, speed, _HALFLIFE, dt[:, None])
    state.terrain[...], state.terrain_speed[...] = goal + error, speed
    state.ground_points[...], state.on_ground[...] = points, True


def _told(state: Characters, points: Floats) -> tuple[Floats, Floats]:
    """Return what was told of the ground at points `(N, 3, 2)`: of root and toes.

    Returns:
        `(N, 7)` root and feet above the floor, slopes along x and z under each foot; and `(N, 3,
        2)` the slopes under root and feet.
    """
    told = state.ground_told_at
    plain = state.ground_slope[:, None]
    slope = np.where(np.isnan(state.foot_slopes), plain, state.foot_slopes)
    plane = state.ground_height[:, None] + np.sum(plain * (points - told[:, :1]), axis=-1)
    # a foot that stands half on a step stands on its higher half
    heel = state.foot_heights[:, ::2] + np.sum(slope * (points[:, 1:] - told[:, 1:3]), axis=-1)
    toe = state.foot_heights[:, 1::2] + np.sum(slope * (points[:, 1:] - told[:, 3:]), axis=-1)
    own = np.maximum(toe, heel)
    feet = np.where(np.isnan(own), plane[:, 1:], own)
    heights = np.concatenate([plane[:, :1], feet], axis=1) - state.root_position[:, 1:2]
    return (
        np.concatenate([heights, slope.reshape(-1, 4)], axis=1),
        np.concatenate([plain, slope], axis=1),
    )


def _tilt(state: Characters, pose: LegPose, legs: Legs) -> Vectors:
    """Return rotation vectors `(N, 2, 3)` in the root's frame that lay feet on their slopes."""
    slope = state.terrain[:, 3:].reshape(-1, 2, 2)
    steep = np.sqrt(np.sum(slope * slope, axis=-1, keepdims=True))
    angle = np.arctan(steep) / np.maximum(steep, 1e-9)
    # from straight up to the normal (-sx, 1, -sz): about (-sz, 0, sx)
    axis = np.stack([-slope[..., 1], 0.0 * slope[..., 0], slope[..., 0]], axis=-1)
    near = 1.0 - np.clip((pose.toe[..., 1:2] - legs.toe_height) / _TILT_BELOW, 0.0, 1.0)
    share = near * near * (3.0 - 2.0 * near)
    return turn_to_root(axis * angle * share, state.root_yaw)


def _sink(state: Characters, legs: Legs, pose: LegPose, ankles: Vectors, dt: Floats) -> Floats:
    """Return by how much the hips `(N,)` are lowered so that both legs reach."""
    reach = np.maximum(_REACH * legs.length, np.linalg.norm(pose.hip - pose.ankle, axis=-1))
    away = pose.hip - ankles
    aside = np.hypot(away[..., 0], away[..., 2])
    highest = np.sqrt(np.maximum(reach**2 - aside**2, 0.0))
    need = np.clip((away[..., 1] - highest).max(axis=1), 0.0, _DEEPEST)
    fresh = state.time <= dt
    sink = np.where(fresh, need, state.ground_sink)
    state.ground_sink[...], state.ground_sink_speed[...] = spring_damper_exact(
        sink, np.where(fresh, 0.0, state.ground_sink_speed), need, _SINK_HALFLIFE, dt
    )
    return state.ground_sink.copy()
