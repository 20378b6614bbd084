"""Plans for kernels: what the refiner's network reads of a transition, and what its answer means.

The counterpart of `refining.Refining` and of `networks.rmr.features` and `guidance`, for live plans
that are not imposed: eight frames that were shown, then those of the clip that was jumped to.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.compiled import kernel
from stridewire_engine.compiled.legs import leg_pose, turn_of
from stridewire_engine.compiled.moments import Clips, moment, nearest, root_step, turned
from stridewire_engine.compiled.stance import LegJoints, write
from stridewire_engine.compiled.turns import (
    Vector,
    conjugate,
    decayed,
    from_scaled_axis,
    multiply,
    rate,
    to_scaled_axis,
)

_HALFLIFE = 0.1
_STEP_SCALE, _FOOT_SCALE, _FADE, _LONG = 30.0, 5.0, 10.0, 60.0
_OFFSET_SCALE, _LABEL_LOGIT, _LOGIT_SCALE = 0.1, 3.0, 2.0
_ONSET = 8.0
_HIPS, _TOES = 4, 2


class Past(NamedTuple):
    """Columns of characters that a plan is made of, the jump done."""

    clip: Indices
    clip_time: Floats
    root_position: Vectors
    root_yaw: Floats
    root_offset: Floats
    offset_hips: Vectors
    offset_hips_velocity: Vectors
    offset_rotations: Vectors
    offset_angular_velocity: Vectors
    hip_drop: Floats
    legs_shown: Quaternions
    past_root: Floats
    past_shown: Vectors
    past_contacts: Flags


class Draft(NamedTuple):
    """Scratch of one plan of T frames, in the plan's frame."""

    points: Vectors
    """`(T, 8, 3)` root, hips, toes, ankles, toes of the clip."""
    yaw: Floats
    """`(T,)` of the root, from the frame's."""
    off: Vectors
    """`(L, 3)` by what the lower joints are off the new clip."""
    lower: Quaternions
    """`(1, L, 4)` their rotations."""


@kernel
def features(
    clips: Clips,
    legs: LegJoints,
    past: Past,
    rows: Indices,
    fading: Floats,
    draft: Draft,
    contacts: Flags,
    out: Floats,
) -> None:
    """Write what the network reads of M plans of T frames.

    Args:
        clips: Of the library.
        legs: Of the skeleton.
        past: Of the characters.
        rows: `(M,)` which of them.
        fading: `(K,)` seconds for which the root's velocity difference counts in coming frames.
        draft: Scratch.
        contacts: `(M, T, 2)` out: labels.
        out: `(M, T, 43)` out.
    """
    head = past.past_root.shape[1]
    for i in range(len(rows)):
        row = rows[i]
        yaw = past.past_root[row, head - 1, 3]
        x, z = past.past_root[row, head - 1, 0], past.past_root[row, head - 1, 2]
        _draft_past(past, row, draft, contacts[i], x, z, yaw)
        _turned_by(clips, legs, past, row, draft)
        for k in range(len(fading)):
            _draft_frame(
                clips, legs, past, row, head + k, k, fading[k], draft, contacts[i], x, z, yaw
            )
        for frame in range(out.shape[1]):
            _write(draft, contacts[i], frame, frame - head, out[i])


@kernel
def _enter(
    draft: Draft, frame: int, which: int, at: Vector, x: float, z: float, yaw: float
) -> None:
    """Write a point of the world in the plan's frame."""
    px, pz = turned(at[0] - x, at[2] - z, -yaw)
    draft.points[frame, which, 0] = px
    draft.points[frame, which, 1] = at[1]
    draft.points[frame, which, 2] = pz


@kernel
def _draft_past(
    past: Past, row: int, draft: Draft, contacts: Flags, x: float, z: float, yaw: float
) -> None:
    """Draft the frames that were shown; the network's ground is at 0."""
    level = past.root_position[row, 1]
    for frame in range(past.past_root.shape[1]):
        root, shown = past.past_root[row, frame], past.past_shown[row, frame]
        _enter(draft, frame, 0, (root[0], root[1] - level, root[2]), x, z, yaw)
        draft.yaw[frame] = root[3] - yaw
        _enter(draft, frame, 1, _above(shown, _HIPS, level), x, z, yaw)
        for side in range(2):
            toe = _above(shown, _TOES + side, level)
            _enter(draft, frame, 2 + side, toe, x, z, yaw)
            _enter(draft, frame, 4 + side, _above(shown, side, level), x, z, yaw)
            _enter(draft, frame, 6 + side, toe, x, z, yaw)
            contacts[frame, side] = past.past_contacts[row, frame, side]


@kernel
def _above(shown: Vectors, joint: int, level: float) -> Vector:
    return 1.0 * shown[joint, 0], shown[joint, 1] - level, 1.0 * shown[joint, 2]


@kernel
def _turned_by(clips: Clips, legs: LegJoints, past: Past, row: int, draft: Draft) -> None:
    """Find by what lower joints are off the new clip: legs as they were bent."""
    at, weight = moment(clips, past.clip[row], past.clip_time[row])
    bent = False
    for joint in range(past.legs_shown.shape[1]):
        for part in range(4):
            bent = bent or past.legs_shown[row, joint, part] != 0.0
    for joint in range(draft.off.shape[0]):
        for axis in range(3):
            draft.off[joint, axis] = past.offset_rotations[row, joint, axis]
    for side in range(2):
        joints = (legs.thigh[side], legs.shin[side], legs.foot[side])
        for part in range(3):
            joint = joints[part]
            _mix(clips, at, weight, joint, draft)
            own = turn_of(draft.lower, 0, joint)
            shown = turn_of(past.legs_shown, row, 2 * part + side)
            if not bent:
                offset = past.offset_rotations
                shown = multiply(
                    from_scaled_axis(
                        (
                            1.0 * offset[row, joint, 0],
                            1.0 * offset[row, joint, 1],
                            1.0 * offset[row, joint, 2],
                        )
                    ),
                    own,
                )
            off = to_scaled_axis(multiply(shown, conjugate(own)))
            for axis in range(3):
                draft.off[joint, axis] = off[axis]


@kernel
def _mix(clips: Clips, at: int, weight: float, joint: int, draft: Draft) -> None:
    """Write a joint's rotation between two rows of the library."""
    a, b = turn_of(clips.rotations, at, joint), turn_of(clips.rotations, at + 1, joint)
    other = weight if a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] >= 0.0 else -weight
    own = 1.0 - weight
    w, x, y, z = (
        own * a[0] + other * b[0],
        own * a[1] + other * b[1],
        own * a[2] + other * b[2],
        own * a[3] + other * b[3],
    )
    size = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
    write(draft.lower, 0, joint, (w * size, x * size, y * size, z * size))


@kernel
def _draft_frame(
    clips: Clips,
    legs: LegJoints,
    past: Past,
    row: int,
    frame: int,
    k: int,
    fading: float,
    draft: Draft,
    contacts: Flags,
    x: float,
    z: float,
    yaw: float,
) -> None:
    """Draft a coming frame: the clip on its own path, springs over the seam."""
    clip, time = past.clip[row], (k + 1) / clips.frame_rate
    now, weight = moment(clips, clip, past.clip_time[row])
    then, share = moment(clips, clip, past.clip_time[row] + time)
    way_x, way_z, turn = root_step(clips, clip, now, weight, then, share)
    offset, root_yaw = past.root_offset, past.root_yaw[row]
    way_x, way_z = way_x + offset[row, 0] * fading, way_z + offset[row, 1] * fading
    dx, dz = turned(way_x, way_z, root_yaw)
    root_x, root_z = past.root_position[row, 0] + dx, past.root_position[row, 2] + dz
    heading = root_yaw + turn + offset[row, 2] * fading
    _enter(draft, frame, 0, (root_x, 0.0, root_z), x, z, yaw)
    draft.yaw[frame] = heading - yaw
    hips = _sprung(clips, past, row, then, share, time, draft)
    # seen from the plan's frame: turned by what the root has turned, moved by where it is
    px, pz = draft.points[frame, 0, 0], draft.points[frame, 0, 2]
    _put(draft, frame, 1, hips, px, pz, heading - yaw)
    for side in range(2):
        leg = leg_pose(legs, side, hips, draft.lower, 0)
        _put(draft, frame, 2 + side, leg[3], px, pz, heading - yaw)
        _put(draft, frame, 4 + side, leg[2], px, pz, heading - yaw)
        track = clips.toe_tracks
        own = (
            track[then, side, 0] + share * (track[then + 1, side, 0] - track[then, side, 0]),
            track[then, side, 1] + share * (track[then + 1, side, 1] - track[then, side, 1]),
            track[then, side, 2] + share * (track[then + 1, side, 2] - track[then, side, 2]),
        )
        _put(draft, frame, 6 + side, own, px, pz, heading - yaw)
        contacts[frame, side] = clips.contacts[nearest(then, share), 2 * side + 1]


@kernel
def _sprung(
    clips: Clips, past: Past, row: int, at: int, weight: float, time: float, draft: Draft
) -> Vector:
    """Write rotations of the lower joints and return the hips, what they are off by sprung out."""
    y, e = rate(_HALFLIFE, time)
    for joint in range(draft.off.shape[0]):
        speed = past.offset_angular_velocity
        tx, _ = decayed(draft.off[joint, 0], speed[row, joint, 0], y, e, time)
        ty, _ = decayed(draft.off[joint, 1], speed[row, joint, 1], y, e, time)
        tz, _ = decayed(draft.off[joint, 2], speed[row, joint, 2], y, e, time)
        _mix(clips, at, weight, joint, draft)
        turn = multiply(from_scaled_axis((tx, ty, tz)), turn_of(draft.lower, 0, joint))
        write(draft.lower, 0, joint, turn)
    away, goes = past.offset_hips, past.offset_hips_velocity
    mx, _ = decayed(away[row, 0], goes[row, 0], y, e, time)
    my, _ = decayed(away[row, 1] - past.hip_drop[row], goes[row, 1], y, e, time)
    mz, _ = decayed(away[row, 2], goes[row, 2], y, e, time)
    hips = clips.hips
    return (
        hips[at, 0] + weight * (hips[at + 1, 0] - hips[at, 0]) + mx,
        hips[at, 1] + weight * (hips[at + 1, 1] - hips[at, 1]) + my,
        hips[at, 2] + weight * (hips[at + 1, 2] - hips[at, 2]) + mz,
    )


@kernel
def _put(
    draft: Draft, frame: int, which: int, local: Vector, x: float, z: float, yaw: float
) -> None:
    """Write a point of a root's frame in the plan's."""
    px, pz = turned(local[0], local[2], yaw)
    draft.points[frame, which, 0] = px + x
    draft.points[frame, which, 1] = local[1]
    draft.points[frame, which, 2] = pz + z


@kernel
def _write(draft: Draft, contacts: Flags, frame: int, since: int, out: Floats) -> None:
    """Write the numbers of a frame in the order of `features.inputs`."""
    points, row = draft.points, out[frame]
    row[0], row[1] = points[frame, 0, 0], points[frame, 0, 2]
    row[2], row[3] = math.sin(draft.yaw[frame]), math.cos(draft.yaw[frame])
    last = max(frame, 1)
    for axis in range(3):
        under = points[frame, 0, axis] if axis != 1 else 0.0
        row[4 + axis] = points[frame, 1, axis] - under
        for side in range(2):
            at = 3 * side + axis
            toe, clip = points[frame, 2 + side, axis], points[frame, 6 + side, axis]
            row[7 + at], row[13 + at] = toe - under, clip - under
            row[19 + at] = _STEP_SCALE * (
                points[last, 2 + side, axis] - points[last - 1, 2 + side, axis]
            )
            row[25 + at] = _STEP_SCALE * (
                points[last, 6 + side, axis] - points[last - 1, 6 + side, axis]
            )
            row[31 + at] = _FOOT_SCALE * (points[frame, 4 + side, axis] - toe)
    row[37], row[38] = contacts[frame, 0], contacts[frame, 1]
    fresh = since >= 0
    row[39] = math.exp(-since / _FADE) if fresh else 0.0
    row[40] = since / _LONG if fresh else 0.0
    row[41], row[42] = not fresh, 0.0


@kernel
def follow(
    spline: Floats,
    curves: Floats,
    logits: Floats,
    contacts: Flags,
    yaw: Floats,
    head: int,
    led: float,
    planted: Floats,
    offset: Vectors,
) -> None:
    """Write what is followed of the network's answer about M plans; see `guidance` and `followed`.

    Args:
        spline: `(T, S)` B-splines of S tokens.
        curves: `(M, S, 12)` control values.
        logits: `(M, S, 2 · T/S)`.
        contacts: `(M, T, 2)` labels.
        yaw: `(M,)` of the plans' frames.
        head: Frames before the seam.
        led: Share of the offsets that swings are led by.
        planted: `(M, T - head, 2)` out.
        offset: `(M, T - head, 2, 3)` out, in the world.
    """
    frames, tokens = spline.shape
    token = frames // tokens
    for i in range(len(yaw)):
        for k in range(frames - head):
            frame = head + k
            x = min(k / _ONSET, 1.0)
            scale = led * _OFFSET_SCALE * x * x * (3.0 - 2.0 * x)
            for side in range(2):
                vx, vy, vz = 0.0, 0.0, 0.0
                for s in range(tokens):
                    share = spline[frame, s]
                    if share != 0.0:
                        vx += share * curves[i, s, 3 * side]
                        vy += share * curves[i, s, 3 * side + 1]
                        vz += share * curves[i, s, 3 * side + 2]
                wx, wz = turned(vx, vz, yaw[i])
                offset[i, k, side, 0], offset[i, k, side, 2] = scale * wx, scale * wz
                offset[i, k, side, 1] = scale * vy
                label = contacts[i, frame, side]
                logit = _LOGIT_SCALE * logits[i, frame // token, 2 * (frame % token) + side]
                logit += _LABEL_LOGIT if label else -_LABEL_LOGIT
                planted[i, k, side] = 1.0 if label else 1.0 / (1.0 + math.exp(-logit))
