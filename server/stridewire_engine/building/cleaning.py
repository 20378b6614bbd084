"""Cleaning: from a retargeted motion to a clip on the ground, with a root and contacts."""

from dataclasses import replace

import numpy as np

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.clip import Clip, differences
from stridewire.motion.contacts import detect_contacts, rest_heights
from stridewire.motion.resample import resample_rotations, resample_values
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import REFERENCE

FRAME_RATE = 60.0
"""Frames per second of all clips of a library."""

_LEADING = 3
_JUMP = np.deg2rad(2.0)
_SPIKE = np.deg2rad(15.0)
_SPIKE_SPEED = np.deg2rad(1000.0)
_WIDEST_SPIKE = 3
_FLIP = np.deg2rad(90.0)
_WIDEST_FLIP_S = 0.25
_FROZEN = 1e-6
_GAP_S = 0.1
_SHORTEST_LAP_S, _LONGEST_LAP_S = 0.4, 20.0
_LAP_GAP = 0.02
_LAP_KICK = 1.5
_STILL = 0.15
_STEP = 0.1
_FLOOR_PERCENTILE = 25.0
_TOES = ("LeftToe", "RightToe")


def clean(
    name: str,
    hips: Vectors,
    rotations: Quaternions,
    frame_rate: float,
    source: str,
    floor: float | None = None,
) -> Clip:
    """Resample to 60 frames/s, set on the ground, split off the root and find contacts.

    Args:
        name: Of the clip.
        hips: `(T, 3)` in the world, metres.
        rotations: `(T, 22, 4)` local on the reference skeleton, the hips' in the world.
        frame_rate: Frames per second of the arrays.
        source: File that the motion came from.
        floor: Height of the ground in metres; found where None.
    """
    hips, rotations = _resampled(hips, rotations, frame_rate)
    positions, _ = kinematics.forward(REFERENCE, hips, rotations)
    drop = np.array([0.0, floor_height(positions) if floor is None else floor, 0.0])
    hips, positions = hips - drop, positions - drop
    pose = extract_root(REFERENCE, hips, rotations, FRAME_RATE).astype(np.float32)
    contacts = detect_contacts(REFERENCE, positions, FRAME_RATE)
    return Clip(name, REFERENCE, FRAME_RATE, pose, contacts, source=source)


def ground(hips: Vectors, rotations: Quaternions, frame_rate: float) -> float:
    """Return the height of the ground under a motion, metres, as `clean` finds it.

    Args:
        hips: `(T, 3)` in the world, metres.
        rotations: `(T, 22, 4)` local on the reference skeleton, the hips' in the world.
        frame_rate: Frames per second of the arrays.
    """
    hips, rotations = _resampled(hips, rotations, frame_rate)
    positions, _ = kinematics.forward(REFERENCE, hips, rotations)
    return floor_height(positions)


def _resampled(
    hips: Vectors, rotations: Quaternions, frame_rate: float
) -> tuple[Vectors, Quaternions]:
    if frame_rate == FRAME_RATE:
        return hips, rotations
    return (
        resample_values(hips, frame_rate, FRAME_RATE),
        resample_rotations(rotations, frame_rate, FRAME_RATE),
    )


def leading_pose(source: SourceMotion) -> int:
    """Return how many frames at the beginning are cut off from the motion by a jump.

    Many exporters put a rest pose first, some solvers start far away. A jump turns all joints by
    more than 2 degrees on average, or moves the root by more than a fifth of the longest bone, and
    three times as far as the motion does.
    """
    turns = _steps(source.rotations).mean(axis=-1)
    moves = np.linalg.norm(np.diff(source.root_positions, axis=0), axis=-1)
    if len(turns) < 2 * _LEADING:
        return 0
    longest = np.linalg.norm(source.skeleton.offsets[1:], axis=-1).max(initial=0.0)
    jump = np.zeros(_LEADING, bool)
    for steps, least in ((turns, _JUMP), (moves, 0.2 * longest)):
        usual = np.percentile(steps[_LEADING:], 95.0)
        jump |= steps[:_LEADING] > max(3.0 * usual, least, 1e-9)
    return int(np.flatnonzero(jump)[-1]) + 1 if jump.any() else 0


def mend_spikes(source: SourceMotion, frame_rate: float) -> tuple[SourceMotion, list[str]]:
    """Bridge joints that jump away and back; return a note of that.

    No joint turns away and back by 15 degrees, at 1000 degrees/s or more, within three frames, and
    none jumps by 90 degrees from frame to frame; solvers that flip a joint do, for up to 0.25 s.

    Args:
        source: As read.
        frame_rate: Frames per second.
    """
    rotations = source.rotations.copy()
    narrow = max(_SPIKE, _SPIKE_SPEED / frame_rate)
    mended = np.zeros(rotations.shape[:2], bool)
    widest = max(_WIDEST_SPIKE, round(_WIDEST_FLIP_S * frame_rate))
    steps = _steps(rotations)
    for width in range(1, min(widest, len(rotations) - 2) + 1):
        threshold = narrow if width <= _WIDEST_SPIKE else _FLIP
        before, after = rotations[: -width - 1], rotations[width + 1 :]
        jump = np.minimum(steps[: len(before)], steps[width:])
        if not (jump > threshold).any():
            continue
        spike = (jump > threshold) & (_angle(before, after) < 0.35 * jump)
        for frame, joint in np.argwhere(spike):
            weight = np.arange(1, width + 1) / (width + 1)
            a, b = rotations[frame, joint], rotations[frame + width + 1, joint]
            rotations[frame + 1 : frame + width + 1, joint] = quaternion.slerp(
                np.broadcast_to(a, (width, 4)), np.broadcast_to(b, (width, 4)), weight
            )
            mended[frame + 1 : frame + width + 1, joint] = True
        steps = _steps(rotations) if spike.any() else steps
    notes = _places(source, mended, "frame(s) with spikes were mended", frame_rate)
    left = "jump(s) of a joint by more than 90 degrees are left"
    notes += _places(source, steps > _FLIP, left, frame_rate)
    return (replace(source, rotations=rotations) if mended.any() else source), notes


def _places(source: SourceMotion, where: Flags, what: str, frame_rate: float) -> list[str]:
    """Say how many frames of `(T, J)` flags there are and where the first is."""
    if not where.any():
        return []
    frame, joint = np.argwhere(where)[0]
    count = int(where.any(axis=-1).sum())
    first = f"{frame / frame_rate:.2f} s in {source.skeleton.names[joint]}"
    return [f"{count} {what}, the first at {first}"]


def gaps(source: SourceMotion, frame_rate: float) -> list[str]:
    """Return a note where a motion is dead still for more than 0.1 s, as where markers are lost."""
    still = np.abs(np.diff(source.rotations, axis=0)).max(axis=(1, 2)) < _FROZEN
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(np.int8)))
    lengths = edges[1::2] - edges[::2]
    dead = edges[::2][lengths > _GAP_S * frame_rate]
    if not len(dead):
        return []
    return [f"{len(dead)} gap(s) without any motion, the first at {dead[0] / frame_rate:.2f} s"]


def find_loop(clip: Clip) -> Clip:
    """Return the clip marked as a loop if its last frame is its first pose again, one lap on.

    Joints must come back within 2 cm and 1.5 m/s (a foot's velocity changes by 1 m/s from frame to
    frame), and have moved in between.
    """
    positions, _ = kinematics.forward(clip.skeleton, clip.pose.hips, clip.pose.rotations)
    velocities = differences(positions, 1.0 / clip.frame_rate)
    apart = np.linalg.norm(positions[-1] - positions[0], axis=-1).max()
    faster = np.linalg.norm(velocities[-1] - velocities[0], axis=-1).max()
    moved = np.ptp(positions, axis=0).max()
    loops = (
        _SHORTEST_LAP_S <= clip.seconds <= _LONGEST_LAP_S
        and apart < _LAP_GAP
        and faster < _LAP_KICK
        and moved > 5.0 * _LAP_GAP
    )
    return replace(clip, loops=bool(loops))


def _steps(rotations: Quaternions) -> Floats:
    return _angle(rotations[1:], rotations[:-1])


def _angle(a: Quaternions, b: Quaternions) -> Floats:
    dots = np.abs(np.sum(a.astype(np.float64) * b, axis=-1))
    return np.asarray(2.0 * np.arccos(np.minimum(dots, 1.0)))


def floor_height(positions: Vectors) -> float:
    """Return the height of the ground, metres, as planted toes show it.

    A low percentile of the toes' heights while they are slow and low: the minimum would follow
    noise and toes pressed into the ground, the median steps onto boxes. In a run toes are never
    still, so the slowest tenth counts there.

    Args:
        positions: `(T, 22, 3)` at 60 frames/s on the reference skeleton.
    """
    toes = REFERENCE.indices(_TOES)
    height: Floats = positions[:, toes, 1] - rest_heights(REFERENCE, toes)
    speed = np.linalg.norm(differences(positions[:, toes], 1.0 / FRAME_RATE), axis=-1)
    slow = speed <= max(_STILL, float(np.percentile(speed, 10.0)))
    low = height <= np.percentile(height[slow], 10.0) + _STEP
    return float(np.percentile(height[slow & low], _FLOOR_PERCENTILE))
