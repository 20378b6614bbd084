"""The stitchers `stance` and `refine` for kernels: the whole way from sampled to shown poses.

The counterpart of `Stance.apply` with the legs ahead and the guide that it is given; everything is
done in place, character by character.
"""

import math
from typing import NamedTuple

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire_engine.compiled import footing, kernel
from stridewire_engine.compiled.footing import Steps, Toes
from stridewire_engine.compiled.legs import (
    add,
    bend,
    leg_pose,
    length,
    less,
    point,
    roll,
    turn_of,
)
from stridewire_engine.compiled.lookahead import Ahead, Plays, guided, lead, look_ahead, said
from stridewire_engine.compiled.moments import Clips
from stridewire_engine.compiled.turns import (
    Vector,
    decay,
    decayed,
    from_scaled_axis,
    multiply,
    rate,
    to_root,
    to_world,
)

BODY_HALFLIFE = 0.1
"""Of hips and joints, and of gaps that are looked ahead of."""
_DEEPEST_DROP, _DROP_HALFLIFE = 0.08, 0.1
_REACH = 0.985
_PLANTED = 0.5


class Body(NamedTuple):
    """Columns of characters that tell what is added to their poses, as in `StitchState`."""

    offset_hips: Vectors
    offset_hips_velocity: Vectors
    offset_rotations: Vectors
    offset_angular_velocity: Vectors
    body_halflife: Floats
    hip_drop: Floats
    hip_drop_speed: Floats
    legs_shown: Quaternions


class LegJoints(NamedTuple):
    """Joints of both legs, as in `stitchers.legs.Legs`."""

    thigh: Indices
    shin: Indices
    foot: Indices
    toe: Indices
    offsets: Floats
    toe_height: float
    length: float
    own_pace: Flags
    """`(J,)` joints whose springs are never slowed down: legs and toes."""


class Scene(NamedTuple):
    """What does not change from tick to tick, and scratch."""

    clips: Clips
    legs: LegJoints
    times: Floats
    """`(K,)` seconds ahead."""
    faded: Floats
    """`(K,)` seconds for which the root's velocity difference counts until then."""
    rates: Floats
    """`(K, 2)` of gaps and of the hips' offset until then, as `turns.rate` has them."""
    frame_rate: float
    """Of guides."""
    ahead: Ahead
    steps: Steps


@kernel
def stance(
    scene: Scene,
    body: Body,
    toes: Toes,
    plays: Plays,
    rows: Indices,
    follows: Flags,
    root_position: Vectors,
    root_yaw: Floats,
    begins: Flags,
    pull: Floats,
    contacts: Flags,
    dt: Floats,
    hips: Vectors,
    rotations: Quaternions,
) -> None:
    """Turn sampled poses into shown ones, in place.

    Args:
        scene: Library, legs, times ahead.
        body: Of all N characters.
        toes: Of them.
        plays: Of them.
        rows: `(M,)` which of them.
        follows: `(N,)` who follows a network where it said something.
        root_position: `(N, 3)`, already moved.
        root_yaw: `(N,)`.
        begins: `(N,)` who is new.
        pull: `(N, 3)` x, z, yaw a second that roots go beyond their clips.
        contacts: `(N, 2)` whether the clips have the toes planted now.
        dt: `(N,)` seconds.
        hips: `(N, 3)` as sampled; as shown after.
        rotations: `(N, J, 4)` as sampled; as shown after.
    """
    legs, steps, ahead, times = scene.legs, scene.steps, scene.ahead, scene.times
    for row in rows:
        passed = dt[row]
        sine, cosine = math.sin(root_yaw[row]), math.cos(root_yaw[row])
        root = root_position[row]
        look_ahead(ahead, scene.clips, plays, row, times, scene.faded, pull[row])
        led = follows[row] and guided(plays, row, scene.frame_rate)
        if led:
            lead(ahead, plays, row, times, scene.frame_rate, sine, cosine)
        _read_labels(scene, plays, contacts, row, led)
        footing.replant(toes, row, steps, ahead, times, not led, passed)
        _aim(scene, toes, plays, row, hips, rotations, root, led, begins[row], sine, cosine, passed)
        _spring(body, legs, row, passed, hips, rotations)
        for side in range(2):
            if not led:
                steps.planted[side] = 1.0 if steps.stands[side] else 0.0
            footing.step(toes, row, side, steps, ahead, times, root[1] + legs.toe_height, passed)
        drop = _drop(scene, body, toes, row, root, sine, cosine, passed)
        _bend(
            scene, body, toes, row, root, drop, sine, cosine, passed, begins[row], hips, rotations
        )
        hips[row, 1] -= drop


@kernel
def _read_labels(scene: Scene, plays: Plays, contacts: Flags, row: int, led: bool) -> None:
    """Note which toes stand, by the clip or by the network."""
    for side in range(2):
        label = contacts[row, side]
        scene.steps.stands[side] = label
        if led:
            planted, _, _, _ = said(plays, row, side, 0.0, label, scene.frame_rate)
            scene.steps.planted[side] = planted
            scene.steps.stands[side] = planted > _PLANTED


@kernel
def _aim(
    scene: Scene,
    toes: Toes,
    plays: Plays,
    row: int,
    hips: Vectors,
    rotations: Quaternions,
    root: Floats,
    led: bool,
    begins: bool,
    sine: float,
    cosine: float,
    dt: float,
) -> None:
    """Find the targets of both toes in the world: the clip's, or where the network leads."""
    at = (float(hips[row, 0]), float(hips[row, 1]), float(hips[row, 2]))
    for side in range(2):
        leg = leg_pose(scene.legs, side, at, rotations, row)
        x, y, z = to_world(leg[3], sine, cosine)
        if led:
            _, dx, dy, dz = said(plays, row, side, 0.0, False, scene.frame_rate)
            x, y, z = x + dx, y + dy, z + dz
        position = (x + root[0], y + root[1], z + root[2])
        footing.aim(toes, row, side, scene.steps, position, begins, dt)


@kernel
def _spring(
    body: Body, legs: LegJoints, row: int, dt: float, hips: Vectors, rotations: Quaternions
) -> None:
    """Let the offsets of hips and joints decay and add them to the pose."""
    usual_y, usual_e = rate(BODY_HALFLIFE, dt)
    y, e = usual_y, usual_e
    if body.body_halflife[row, 0] > BODY_HALFLIFE:
        y, e = rate(body.body_halflife[row, 0], dt)
    for axis in range(3):
        x, v = decayed(body.offset_hips[row, axis], body.offset_hips_velocity[row, axis], y, e, dt)
        body.offset_hips[row, axis], body.offset_hips_velocity[row, axis] = x, v
        hips[row, axis] += x
    offset, speed = body.offset_rotations, body.offset_angular_velocity
    for joint in range(rotations.shape[1]):
        y, e = usual_y, usual_e
        if body.body_halflife[row, 1 + joint] > BODY_HALFLIFE and not legs.own_pace[joint]:
            y, e = rate(body.body_halflife[row, 1 + joint], dt)
        for axis in range(3):
            x, v = decayed(offset[row, joint, axis], speed[row, joint, axis], y, e, dt)
            offset[row, joint, axis], speed[row, joint, axis] = x, v
        turn = from_scaled_axis(
            (
                float(offset[row, joint, 0]),
                float(offset[row, joint, 1]),
                float(offset[row, joint, 2]),
            )
        )
        write(rotations, row, joint, multiply(turn, turn_of(rotations, row, joint)))


@kernel
def write(
    rotations: Quaternions, row: int, joint: int, turn: tuple[float, float, float, float]
) -> None:
    """Write a rotation into `(N, J, 4)`."""
    for part in range(4):
        rotations[row, joint, part] = turn[part]


@kernel
def _drop(
    scene: Scene,
    body: Body,
    toes: Toes,
    row: int,
    root: Floats,
    sine: float,
    cosine: float,
    dt: float,
) -> float:
    """Return by how much the hips are lowered so that legs reach, now and soon."""
    wanted = 0.0
    for side in range(2):
        wanted = max(wanted, _need(scene, body, toes, row, side, root, sine, cosine))
    wanted = min(wanted, _DEEPEST_DROP)
    drop, speed = decay(body.hip_drop[row] - wanted, body.hip_drop_speed[row], _DROP_HALFLIFE, dt)
    body.hip_drop[row], body.hip_drop_speed[row] = drop + wanted, speed
    return float(body.hip_drop[row])


@kernel
def _need(
    scene: Scene,
    body: Body,
    toes: Toes,
    row: int,
    side: int,
    root: Floats,
    sine: float,
    cosine: float,
) -> float:
    """Return by how much the hips ought to be lower for a leg at the times ahead."""
    steps, ahead, times = scene.steps, scene.ahead, scene.times
    now = _seen(steps.toe[side, 0] - root[0], steps.toe[side, 1] - root[1],
                steps.toe[side, 2] - root[2], sine, cosine)  # fmt: skip
    gap, speed = toes.toe_gap, toes.toe_gap_speed
    gx, gy, gz = to_root(point(gap, row, side), sine, cosine)
    sx, sy, sz = to_root(point(speed, row, side), sine, cosine)
    needed, stays = 0.0, steps.stands[side]
    for k in range(len(times)):
        # a foothold lasts until the first time ahead at which the foot swings
        stays = stays and ahead.contacts[k, side]
        hip, ankle, toe = (
            point(ahead.hips, k, side), point(ahead.ankles, k, side), point(ahead.toes, k, side),
        )  # fmt: skip
        aim = now
        if not stays:
            y, e = scene.rates[k, 0], scene.rates[k, 1]
            cx, _ = decayed(gx, sx, y, e, times[k])
            cy, _ = decayed(gy, sy, y, e, times[k])
            cz, _ = decayed(gz, sz, y, e, times[k])
            aim = (toe[0] + cx, toe[1] + cy, toe[2] + cz)
        reach = max(_REACH * scene.legs.length, length(less(hip, ankle)))
        away = less(add(hip, _fading(scene, body, row, k)), add(aim, less(ankle, toe)))
        aside = math.hypot(away[0], away[2])
        needed = max(needed, away[1] - math.sqrt(max(reach**2 - aside**2, 0.0)))
    return needed


@kernel
def _fading(scene: Scene, body: Body, row: int, k: int) -> Vector:
    """Return what is left of the hips' offset at a time ahead."""
    y, e, time = scene.rates[k, 0], scene.rates[k, 1], scene.times[k]
    offset, speed = body.offset_hips, body.offset_hips_velocity
    dx, _ = decayed(offset[row, 0], speed[row, 0], y, e, time)
    dy, _ = decayed(offset[row, 1], speed[row, 1], y, e, time)
    dz, _ = decayed(offset[row, 2], speed[row, 2], y, e, time)
    return dx, dy, dz


@kernel
def _seen(x: float, y: float, z: float, sine: float, cosine: float) -> Vector:
    return to_root((x, y, z), sine, cosine)


@kernel
def _bend(
    scene: Scene,
    body: Body,
    toes: Toes,
    row: int,
    root: Floats,
    drop: float,
    sine: float,
    cosine: float,
    dt: float,
    begins: bool,
    hips: Vectors,
    rotations: Quaternions,
) -> None:
    """Bend both legs to their toes, note where those came to lie and how the legs are shown."""
    legs, steps = scene.legs, scene.steps
    low = (float(hips[row, 0]), float(hips[row, 1]) - drop, float(hips[row, 2]))
    pelvis = turn_of(rotations, row, 0)
    for side in range(2):
        leg = leg_pose(legs, side, low, rotations, row)
        toe = _seen(steps.toe[side, 0] - root[0], steps.toe[side, 1] - root[1],
                    steps.toe[side, 2] - root[2], sine, cosine)  # fmt: skip
        reach = max(_REACH * legs.length, length(less(leg[0], leg[2])))
        foot, from_toe = roll(leg, toe, reach)
        thigh, shin, turned, ankle = bend(leg, pelvis, foot, add(toe, from_toe))
        footing.remember(toes, row, side, steps, less(ankle, from_toe), root, sine, cosine)
        bent = (thigh, shin, turned)
        joints = (legs.thigh[side], legs.shin[side], legs.foot[side])
        for part in range(3):
            # where no time passes legs stay to the bit; they would move by what arithmetic rounds
            if dt == 0.0 and not begins:
                for i in range(4):
                    rotations[row, joints[part], i] = body.legs_shown[row, 2 * part + side, i]
            else:
                write(rotations, row, joints[part], bent[part])
                for i in range(4):
                    body.legs_shown[row, 2 * part + side, i] = rotations[row, joints[part], i]
