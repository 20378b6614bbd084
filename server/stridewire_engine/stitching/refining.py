"""Refining: what the network says about the windows of a plan, laid over each other.

Windows of a second follow each other from just before a seam, overlapping. Where they do, their
answers are cross-faded; where the last one ends, its answer fades out and the clips' own steps
hold. The network reads what springs make of the plan, or, in a further pass, its own result.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.networks.rmr import Plans, Refiner, seams_of
from stridewire_engine.networks.rmr.plans import TOKEN, WINDOW
from stridewire_engine.stitchers import STITCHERS, Roots
from stridewire_engine.stitchers.legs import leg_pose
from stridewire_engine.stitchers.stance import Stance
from stridewire_engine.stitching.chains import Chains
from stridewire_engine.stitching.plan import Plan
from stridewire_engine.stitching.run import Guides, Shown, run

_HEAD = 8
"""Frames of a window before its first seam."""
_FADE_OUT = 12
"""Within so many frames at the end of the last window its answer fades out."""


class Refined(NamedTuple):
    """What the network says about C chains."""

    guides: Guides
    """For every frame of the plan."""
    distance: Floats
    """`(C,)` of the window of each chain that is most unlike the training data."""


class _Windows(NamedTuple):
    """W windows of T frames."""

    frames: Indices
    """`(W, T)` of the plan."""
    chain: Indices
    """`(W,)` which chain each belongs to."""


def refine(plan: Plan, chains: Chains, refiner: Refiner, shift: int, passes: int) -> Refined:
    """Ask the network about chains.

    Args:
        plan: On the reference skeleton at 60 frames/s.
        chains: With a seam each.
        refiner: The network.
        shift: Frames from window to window.
        passes: How often it is asked, each time about what came of its last answer.
    """
    windows = _windows(plan, chains, shift)
    spring = next(stitcher for stitcher in STITCHERS if stitcher.name == "spring")
    made = run(plan, spring, chains)
    for number in range(passes):
        refined = _ask(plan, chains, windows, refiner, made)
        if number + 1 < passes:
            made = run(plan, Stance(), chains, refined.guides)
    return refined


def _windows(plan: Plan, chains: Chains, shift: int) -> _Windows:
    """Return windows that hold a seam after their first frame."""
    length = min(WINDOW, len(plan) // TOKEN * TOKEN)
    starts: list[int] = []
    owners: list[int] = []
    for chain, (first, end) in enumerate(zip(chains.starts, chains.ends, strict=True)):
        seams = plan.seams[(plan.seams >= first) & (plan.seams < end)]
        for start in _starts(seams, int(end), shift, length):
            starts.append(min(start, len(plan) - length))
            owners.append(chain)
    return _Windows(np.array(starts)[:, None] + np.arange(length), np.array(owners))


def _starts(seams: Indices, end: int, shift: int, length: int) -> Iterator[int]:
    if not len(seams):
        return
    start = max(int(seams[0]) - _HEAD, 0)
    while start < end:
        inside = seams[(seams > start) & (seams < start + length)]
        if len(inside):
            yield start
            start += shift
        else:
            later = seams[seams > start]
            if not len(later):
                return
            start = int(later[0]) - _HEAD


def _ask(plan: Plan, chains: Chains, windows: _Windows, refiner: Refiner, made: Shown) -> Refined:
    guidance = refiner.refine(_plans(plan, chains, windows, made))
    weight = _weights(plan, windows)
    total = np.zeros(len(plan))
    np.add.at(total, windows.frames, weight)
    share = _reach(windows, weight, len(plan))
    over = np.maximum(total, 1e-9)

    def laid(values: Floats) -> Floats:
        out = np.zeros((len(plan), *values.shape[2:]))
        np.add.at(
            out, windows.frames, weight.reshape(*weight.shape, *(1,) * (values.ndim - 2)) * values
        )
        return out / over.reshape(-1, *(1,) * (values.ndim - 2))

    planted = share[:, None] * laid(guidance.planted) + (1.0 - share[:, None]) * plan.contacts
    guides = Guides(
        planted,
        share[:, None, None] * laid(guidance.toe_offset),
        share[:, None, None] * laid(guidance.foot_turn),
    )
    distance = np.zeros(len(chains))
    np.maximum.at(distance, windows.chain, guidance.distance)
    return Refined(guides, distance)


def _weights(plan: Plan, windows: _Windows) -> Floats:
    """Return what each frame of each window counts `(W, T)`: least at its ends."""
    length = windows.frames.shape[1]
    x = (np.arange(length) + 0.5) / length
    bump = np.sin(np.pi * x) ** 2
    # before its first seam a window says nothing
    after = np.maximum.accumulate(_is_seam(plan, windows.frames), axis=1)
    return np.asarray(bump * after)


def _reach(windows: _Windows, weight: Floats, frames: int) -> Floats:
    """Return to what share the network is heard in each frame `(frames,)`."""
    heard = np.zeros(frames, np.bool_)
    heard[windows.frames[weight > 0.0]] = True
    index = np.arange(frames)
    # frames that are left until it falls silent
    silent = np.where(~heard, index, frames + _FADE_OUT)
    left = np.minimum.accumulate(silent[::-1])[::-1] - index
    x = np.clip(left / (_FADE_OUT + 1), 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))


def _plans(plan: Plan, chains: Chains, windows: _Windows, made: Shown) -> Plans:
    frames = windows.frames
    hips, rotations = _shown(plan, chains, windows, made)
    count, length = frames.shape
    flat = frames.reshape(-1)
    roots = Roots(plan.root_position[flat], plan.root_yaw[flat])
    pose = leg_pose(plan.legs, hips, rotations)

    def placed(local: Vectors) -> Vectors:
        return roots.to_world(local).reshape(count, length, *local.shape[1:])

    starts = _is_seam(plan, frames)
    return Plans(
        plan.root_position[frames],
        plan.root_yaw[frames],
        placed(hips[:, None])[:, :, 0],
        placed(pose.toe),
        placed(pose.ankle),
        placed(plan.leg_pose.toe[flat]),
        plan.contacts[frames],
        seams_of(starts),
        np.full(count, plan.imposed),
    )


def _shown(
    plan: Plan, chains: Chains, windows: _Windows, made: Shown
) -> tuple[Vectors, Quaternions]:
    """Return what is shown in the windows so far `(W T, …)`: made in chains, planned elsewhere."""
    own = windows.chain[:, None]
    at = windows.frames - chains.starts[own]
    inside = ((at >= 0) & (windows.frames < chains.ends[own])).reshape(-1)
    flat = windows.frames.reshape(-1)
    hips, rotations = plan.hips[flat], plan.rotations[flat]
    chain = np.broadcast_to(own, at.shape).reshape(-1)[inside]
    step = at.reshape(-1)[inside]
    hips[inside], rotations[inside] = made.hips[chain, step], made.rotations[chain, step]
    return hips, rotations


def _is_seam(plan: Plan, frames: Indices) -> Flags:
    """Tell where windows `(W, T)` have seams, but for their first frames."""
    flags = np.zeros(len(plan), np.bool_)
    flags[plan.seams] = True
    found = flags[frames]
    found[:, 0] = False
    return np.asarray(found)
