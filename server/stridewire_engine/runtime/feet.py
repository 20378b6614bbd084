"""Feet: planted toes stay where they are, by a soft lock and two-bone inverse kinematics.

The lock follows Holden's *Motion-Matching* (`contact_update`): at the begin of a contact the shown
toe is pinned; at its end, or where the motion has gone too far away, it is let go; both ways the
difference decays as a spring, so that nothing pops. A foot locks again only after the clip's
contact has ended.
"""

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire.motion.springs import decay_spring_damper_exact
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.stitchers.legs import (
    REACH,
    SOFT_REACH,
    LegPose,
    Legs,
    bend,
    leg_pose,
    raise_heels,
)
from stridewire_engine.stitchers.stance import LANDING_WAY

_WELL_MOVED = 0.02
"""Metres by which a lock moves a toe before its heel rises as softly as it may."""
_LOWEST_TOE = 0.5
"""A toe is never lower than so much of its height at rest."""


def plant(
    state: Characters,
    legs: Legs,
    hips: Vectors,
    rotations: Quaternions,
    contacts: Flags,
    stands: Flags,
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
        stands: `(N,)` whose feet the stitcher has planted already; only told of here.
        dt: `(N,)` seconds.
        settings: Half-life and distances.

    Returns:
        `(N, J, 4)` local rotations with the legs bent.
    """
    pose = leg_pose(legs, hips, rotations)
    toe = _to_world(state, pose.toe)
    shown_toe = _lock(state, toe, contacts[:, 1::2], stands, legs.toe_height, dt, settings)
    lowest = state.root_position[:, None, 1] + _LOWEST_TOE * legs.toe_height
    shown_toe[..., 1] = np.maximum(shown_toe[..., 1], lowest)
    shift = turn_to_root(shown_toe - toe, state.root_yaw).astype(np.float32)
    ankles, toes = pose.ankle, pose.toe
    free = np.flatnonzero(~stands)
    if len(free):
        rotations = rotations.copy()
        mine, way = LegPose(*(array[free] for array in pose)), shift[free]
        mine, target = raise_heels(mine, mine.toe + way, _reach(legs, mine, way))
        rotations[free], ankles[free] = bend(legs, mine, rotations[free], target)
        toes[free] = ankles[free] + (mine.toe - mine.ankle)
    _remember(state, np.concatenate([ankles, toes, hips[:, None]], axis=1), dt)
    _keep_for_stance(state, ~stands)
    return rotations


def _reach(legs: Legs, pose: LegPose, shift: Vectors) -> Floats:
    """Return how far `(N, 2)` legs may be stretched; those that are not moved stay as they are."""
    own = np.linalg.norm(pose.hip - pose.ankle, axis=-1)
    moved = np.minimum(np.linalg.norm(shift, axis=-1) / _WELL_MOVED, 1.0)
    return np.asarray(np.maximum(REACH * legs.length, own) + SOFT_REACH * (1.0 - moved))


def _keep_for_stance(state: Characters, rows: Flags) -> None:
    """Note what a stitcher that plants feet has to start from."""
    state.toe_shown[rows] = state.shown_world[rows, 2:4]
    for motion in (
        state.toe_gap_speed, state.toe_lift, state.toe_lift_speed, state.toe_step, state.hip_drop,
        state.hip_drop_speed,
    ):  # fmt: skip
        motion[rows] = 0.0
    velocity = turn_to_world(state.shown_velocity[:, 2:4], state.root_yaw)
    state.toe_speed[rows] = velocity[rows]


def _lock(
    state: Characters,
    toe: Vectors,
    planted: Flags,
    stands: Flags,
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
    anchor = np.where(state.locked[..., None], state.lock_point, toe)
    shown = anchor + offset
    shown = np.where(stands[:, None, None], toe, shown)

    far = np.linalg.norm(state.lock_point - toe, axis=-1) > settings.unlock_distance
    far &= ~stands[:, None]
    begins = planted & (~state.planted | first) & state.foot_lock[:, None]
    ends = state.locked & (~planted | far | ~state.foot_lock[:, None])
    point = shown.copy()
    # where a stitcher has the toe land, it stops where its speed dies
    point += np.where(stands[:, None, None], state.toe_speed * LANDING_WAY, 0.0)
    point[..., 1] = state.root_position[:, None, 1] + toe_height
    anchor = np.where(ends[..., None], toe, np.where(begins[..., None], point, 0.0))
    changed = (begins | ends)[..., None]
    free = ~stands[:, None, None]
    state.toe_offset[...] = np.where(free, np.where(changed, shown - anchor, offset), 0.0)
    # a foot that is let go starts from rest; one that lands stops dead, as shoes do
    at_rest = np.where(ends[..., None], offset_velocity - velocity, 0.0)
    state.toe_offset_velocity[...] = np.where(
        free, np.where(changed, at_rest, offset_velocity), 0.0
    )
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
    state.shown_velocity[...] = np.where(
        moved, turn_to_root(rate, state.root_yaw), state.shown_velocity
    )
    state.shown_local[...] = local
    state.shown_world[...] = world


def _to_world(state: Characters, local: Vectors) -> Vectors:
    """Take points `(N, K, 3)` in the root's frame to the world, in float64."""
    return turn_to_world(local, state.root_yaw) + state.root_position[:, None]
