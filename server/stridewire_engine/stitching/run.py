"""Running a live stitcher over the chains of a plan: all chains at once, frame after frame."""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Indices, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root
from stridewire_engine.stitchers import (
    Guide,
    LegsAhead,
    Motion,
    Roots,
    Sample,
    Stitcher,
    StitchState,
)
from stridewire_engine.stitching.chains import Chains
from stridewire_engine.stitching.plan import Plan

_PLANTED = 0.5


class Shown(NamedTuple):
    """What a stitcher makes of C chains; frames beyond a chain's end mean nothing."""

    hips: Vectors
    """`(C, L, 3)`."""
    rotations: Quaternions
    """`(C, L, J, 4)`."""


class Guides(NamedTuple):
    """How feet are to go instead of as the clips' do, for each frame of a plan, in the world."""

    planted: Floats
    """`(T, 2)` share from 0, swinging, to 1, planted."""
    toe_offset: Vectors
    """`(T, 2, 3)` metres to add to the clips' toes."""
    foot_turn: Vectors
    """`(T, 2, 3)` rotation vectors."""


def run(plan: Plan, stitcher: Stitcher, chains: Chains, guides: Guides | None = None) -> Shown:
    """Let a stitcher hide the seams of the chains.

    Args:
        plan: The clips laid end to end.
        stitcher: Any; one that plants feet where there are guides.
        chains: Some of the plan's.
        guides: For every frame of the plan.
    """
    count, longest = len(chains), int((chains.ends - chains.starts).max())
    joints = len(plan.skeleton)
    state = StitchState.fresh(count, joints)
    _enter(plan, state, chains.starts)
    made = Shown(
        np.empty((count, longest, 3), np.float32), np.empty((count, longest, joints, 4), np.float32)
    )
    dt = np.full(count, 1.0 / plan.frame_rate, np.float32)
    is_seam = np.zeros(len(plan) + 1, np.bool_)
    is_seam[plan.seams] = True
    for step in range(longest):
        at = chains.starts + step
        frames = np.minimum(at, chains.ends - 1)
        jumping = np.flatnonzero(is_seam[frames] & (at < chains.ends))
        if len(jumping):
            _jump(plan, stitcher, state, jumping, frames[jumping], guides)
        state.stitch_time += dt
        sample = _sample(plan, stitcher, frames, guides)
        made.hips[:, step], made.rotations[:, step] = stitcher.apply(state, sample, dt)
    return made


def _enter(plan: Plan, state: StitchState, starts: Indices) -> None:
    """Note where the toes are, and how fast, in the frames before the chains."""
    before = np.maximum(starts - 1, 0)
    toes = _toes(plan, before)
    state.toe_shown[...] = toes
    state.toe_speed[...] = (toes - _toes(plan, np.maximum(before - 1, 0))) * plan.frame_rate
    state.legs_shown[...] = plan.rotations[before][:, plan.legs.joints]
    # nothing is hidden in a chain that begins without a seam
    state.stitch_time[...] = np.inf


def _jump(
    plan: Plan,
    stitcher: Stitcher,
    state: StitchState,
    rows: Indices,
    frames: Indices,
    guides: Guides | None,
) -> None:
    """Hand over to the clips that begin at `frames`, as of the frame before."""
    part = state.take(rows)
    source = _motion(plan, frames - 1, frames - 2)
    target = _one_frame_before(_motion(plan, frames, frames + 1), 1.0 / plan.frame_rate)
    roots = _roots(plan, frames - 1)
    if guides is not None:
        led = turn_to_root(guides.toe_offset[frames - 1], roots.yaw)
        target = target._replace(toes=target.toes + led)
    stitcher.begin(part, source, target, roots)
    part.stitch_time[...] = 0.0
    state.put(rows, part)


def _motion(plan: Plan, frames: Indices, others: Indices) -> Motion:
    """Return poses and their rates of change, by the frame before or after."""
    rate = np.float32(plan.frame_rate) * np.sign(others - frames).astype(np.float32)[:, None]
    hips, rotations = plan.hips[frames], plan.rotations[frames]
    toes = plan.leg_pose.toe
    step = quaternion.multiply(plan.rotations[others], quaternion.conjugate(rotations))
    return Motion(
        hips,
        rotations,
        (plan.hips[others] - hips) * rate,
        quaternion.to_scaled_axis(quaternion.absolute(step)) * rate[..., None],
        toes[frames],
        (toes[others] - toes[frames]) * rate[..., None],
    )


def _one_frame_before(motion: Motion, dt: float) -> Motion:
    """Return where a motion comes from, going back along its rates."""
    back = quaternion.from_scaled_axis(-motion.angular_velocity * np.float32(dt))
    return motion._replace(
        hips=motion.hips - motion.hips_velocity * np.float32(dt),
        rotations=quaternion.multiply(back, motion.rotations),
        toes=motion.toes - motion.toes_velocity * np.float32(dt),
    )


def _sample(plan: Plan, stitcher: Stitcher, frames: Indices, guides: Guides | None) -> Sample:
    ahead = None
    if stitcher.looks_ahead:
        ahead = _ahead(plan, np.array(stitcher.looks_ahead), frames, guides)
    sample = Sample(
        plan.hips[frames],
        plan.rotations[frames],
        plan.contacts[frames],
        _roots(plan, frames),
        frames == 0,
        plan.legs,
        ahead,
    )
    if guides is None:
        return sample
    yaw = sample.roots.yaw
    guide = Guide(
        guides.planted[frames],
        turn_to_root(guides.toe_offset[frames], yaw),
        turn_to_root(guides.foot_turn[frames], yaw),
    )
    return sample._replace(contacts=guide.planted > _PLANTED, guide=guide)


def _ahead(plan: Plan, times: Floats, frames: Indices, guides: Guides | None) -> LegsAhead:
    """Return where the legs of the plan will be, in the frames of the roots as they are."""
    then = frames[:, None] + np.maximum(np.round(times * plan.frame_rate).astype(np.intp), 1)
    then = np.minimum(then, len(plan) - 1)
    roots = _roots(plan, frames)
    pose = plan.leg_pose
    hips, ankles, toes = (
        _seen_from(plan, roots, then, track) for track in (pose.hip, pose.ankle, pose.toe)
    )
    if guides is None:
        return LegsAhead(times, hips, ankles, toes, plan.contacts[then])
    count = len(frames)
    led = turn_to_root(guides.toe_offset[then].reshape(count, -1, 3), roots.yaw)
    led = led.reshape(toes.shape)
    return LegsAhead(times, hips, ankles + led, toes + led, guides.planted[then] > _PLANTED)


def _seen_from(plan: Plan, roots: Roots, then: Indices, track: Vectors) -> Vectors:
    """Take points `(N, K, 2, 3)` of later frames into the frames of the roots `(N,)`."""
    flat = then.reshape(-1)
    world = _roots(plan, flat).to_world(track[flat])
    return roots.to_root(world.reshape(len(then), -1, 3)).reshape(*then.shape, 2, 3)


def _toes(plan: Plan, frames: Indices) -> Vectors:
    return _roots(plan, frames).to_world(plan.leg_pose.toe[frames])


def _roots(plan: Plan, frames: Indices) -> Roots:
    return Roots(plan.root_position[frames], plan.root_yaw[frames])
