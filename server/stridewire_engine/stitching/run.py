"""Running a live stitcher over the chains of a plan: all chains at once, frame after frame."""

from typing import NamedTuple

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Indices, Quaternions, Vectors
from stridewire_engine.stitchers import (
    LegsAhead,
    Motion,
    Roots,
    Sample,
    Stitcher,
    StitchState,
)
from stridewire_engine.stitching.chains import Chains
from stridewire_engine.stitching.plan import Plan


class Shown(NamedTuple):
    """What a stitcher makes of C chains; frames beyond a chain's end mean nothing."""

    hips: Vectors
    """`(C, L, 3)`."""
    rotations: Quaternions
    """`(C, L, J, 4)`."""


def run(plan: Plan, stitcher: Stitcher, chains: Chains) -> Shown:
    """Let a stitcher hide the seams of the chains."""
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
            _jump(plan, stitcher, state, jumping, frames[jumping])
        state.stitch_time += dt
        sample = _sample(plan, stitcher, frames)
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
    plan: Plan, stitcher: Stitcher, state: StitchState, rows: Indices, frames: Indices
) -> None:
    """Hand over to the clips that begin at `frames`, as of the frame before."""
    part = state.take(rows)
    source = _motion(plan, frames - 1, frames - 2)
    target = _one_frame_before(_motion(plan, frames, frames + 1), 1.0 / plan.frame_rate)
    stitcher.begin(part, source, target, _roots(plan, frames - 1))
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


def _sample(plan: Plan, stitcher: Stitcher, frames: Indices) -> Sample:
    return Sample(
        plan.hips[frames],
        plan.rotations[frames],
        plan.contacts[frames],
        _roots(plan, frames),
        frames == 0,
        plan.legs,
        _ahead(plan, np.array(stitcher.looks_ahead), frames) if stitcher.looks_ahead else None,
    )


def _ahead(plan: Plan, times: Floats, frames: Indices) -> LegsAhead:
    """Return where the legs of the plan will be, in the frames of the roots as they are."""
    then = frames[:, None] + np.maximum(np.round(times * plan.frame_rate).astype(np.intp), 1)
    then = np.minimum(then, len(plan) - 1)
    roots = _roots(plan, frames)
    pose = plan.leg_pose
    hips, ankles, toes = (
        _seen_from(plan, roots, then, track) for track in (pose.hip, pose.ankle, pose.toe)
    )
    return LegsAhead(times, hips, ankles, toes, plan.contacts[then])


def _seen_from(plan: Plan, roots: Roots, then: Indices, track: Vectors) -> Vectors:
    """Take points `(N, K, 2, 3)` of later frames into the frames of the roots `(N,)`."""
    flat = then.reshape(-1)
    world = _roots(plan, flat).to_world(track[flat])
    return roots.to_root(world.reshape(len(then), -1, 3)).reshape(*then.shape, 2, 3)


def _toes(plan: Plan, frames: Indices) -> Vectors:
    return _roots(plan, frames).to_world(plan.leg_pose.toe[frames])


def _roots(plan: Plan, frames: Indices) -> Roots:
    return Roots(plan.root_position[frames], plan.root_yaw[frames])
