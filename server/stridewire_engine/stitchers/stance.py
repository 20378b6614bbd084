"""The stitcher `stance`: planted feet keep their footholds through a transition.

The body is inertialized by springs. Toes stand where they stand while the clip's labels say so and
close what they are off by in their next swing (`footing`); legs bend accordingly; the hips drop,
looking ahead, and heels rise where legs would be too short; a foot that closes a gap is lifted a
little. A foot that stands off its place is put right by a step of its own (`replanting`).
"""

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire.motion.springs import damper_exact, spring_damper_exact
from stridewire_engine.stitchers import footing, offsets, replanting
from stridewire_engine.stitchers.footing import Toes
from stridewire_engine.stitchers.legs import (
    REACH,
    Legs,
    bend,
    leg_pose,
    raise_heels,
    turn_feet,
)
from stridewire_engine.stitchers.stitcher import (
    LegsAhead,
    Motion,
    Roots,
    Sample,
    StitchState,
)

_LN2 = float(np.log(2.0))
_BODY_HALFLIFE = 0.1
_LANDING_HALFLIFE = 0.0125
LANDING_WAY = _LANDING_HALFLIFE / float(np.log(2.0))
"""A toe that lands comes to rest so many metres further for each m/s."""
_SWING_ONSET = 0.04
_BRAKE_FROM_S, _BRAKE_S = 0.13, 0.1
_BRAKE_HALFLIFE = 0.06
_STRONGEST_PULL = 50.0
"""Towards the clip's toe, m/s²."""
_STRONGEST_FALL = 60.0
"""Towards the height of the clip's toe, m/s²."""
_STRONGEST_HIPS, _STRONGEST_TURN = 8.0, 25.0
"""Towards the clip's hips and joints, m/s² and rad/s²; wide offsets take longer."""
_SWING_SHORTEST, _SWING_LONGEST = 0.06, 0.4
_HEIGHT_HALFLIFE = 0.035
_DEEPEST_DROP = 0.08
_DROP_HALFLIFE = 0.1
_LIFT_BY_SPEED, _HIGHEST_LIFT = 0.03, 0.05
_LIFT_HALFLIFE = 0.08
_HOVER = 0.005
"""A toe that stands is at most so many metres higher than at rest."""
_LANDING_SOON_S = 0.1


class Stance:
    """Springs for the body, footing for the feet."""

    name = "stance"
    settled_s = 2.81 * _BODY_HALFLIFE
    keeps_root_velocity = True
    plants_feet = True
    always_reaches = False
    """Whether hips drop and heels rise for feet that are guided, too."""
    looks_ahead: tuple[float, ...] = (2 / 60, 4 / 60, 7 / 60, 11 / 60, 16 / 60)

    def begin(self, state: StitchState, source: Motion, target: Motion, roots: Roots) -> None:
        """Take the offsets over; toes stay where they are, only what they are off by changes."""
        offsets.hand_over(state, source, target)
        state.toe_gap[...] = state.toe_shown - roots.to_world(target.toes)
        state.toe_gap_speed += turn_to_world(source.toes_velocity - target.toes_velocity, roots.yaw)
        state.toe_swing[...] = 0.0
        state.toe_step[...] = 0.0
        state.body_halflife[:, 0] = _gentle_halflife(state.offset_hips, _STRONGEST_HIPS)
        state.body_halflife[:, 1:] = _gentle_halflife(state.offset_rotations, _STRONGEST_TURN)

    def apply(self, state: StitchState, sample: Sample, dt: Floats) -> tuple[Vectors, Quaternions]:
        """Spring the body on, move the toes, bend the legs."""
        _decay_body(state, sample.legs, dt)
        hips, rotations = offsets.add(state, sample)
        if sample.guide is None or sample.guide.guided is not None:
            sample = replanting.lift_feet(state, sample, dt)
        clip = leg_pose(sample.legs, sample.hips, sample.rotations)
        led = clip.toe if sample.guide is None else clip.toe + sample.guide.toe_offset
        target = self._target(state, sample, led, dt)
        toes = self._step(state, sample, target, dt)
        body = leg_pose(sample.legs, hips, rotations)
        shown = sample.roots.to_root(toes.position).astype(np.float32)
        if sample.guide is not None and sample.guide.foot_turn is not None:
            body = turn_feet(sample.legs, body, sample.guide.foot_turn)
        if sample.guide is None or self.always_reaches:
            drop = _drop(state, sample.ahead, sample, toes, dt)
            body = body.lowered(drop)
            own = np.linalg.norm(body.hip - body.ankle, axis=-1)
            body, ankles = raise_heels(body, shown, np.maximum(REACH * sample.legs.length, own))
        else:
            # a guide leads feet where legs reach; drops and raised heels would but jerk knees
            drop = _drop(state, None, sample, toes, dt)
            body = body.lowered(drop)
            ankles = shown + (body.ankle - body.toe)
        bent, ankles = bend(sample.legs, body, rotations, ankles)
        self._remember(state, sample, target, toes, ankles + (body.toe - body.ankle))
        # where no time passes legs stay to the bit; they would move by what arithmetic rounds
        still = np.ix_(np.flatnonzero((dt == 0.0) & ~sample.begins), sample.legs.joints)
        bent[still] = state.legs_shown[still[0][:, 0]]
        state.legs_shown[...] = bent[:, sample.legs.joints]
        hips = hips.copy()
        hips[:, 1] -= drop
        return hips, bent

    def _target(self, state: StitchState, sample: Sample, toe: Vectors, dt: Floats) -> Toes:
        """Return where the clip's toes are under the shown root, and how they move."""
        position = sample.roots.to_world(toe)
        fresh = sample.begins[:, None, None]
        before = np.where(fresh, position, state.toe_shown - state.toe_gap)
        passed = dt[:, None, None]
        moved = (position - before) / np.maximum(passed, 1e-6)
        velocity = np.where(passed > 0.0, moved, state.toe_speed - state.toe_gap_speed)
        state.toe_shown[...] = np.where(fresh, position, state.toe_shown)
        return Toes(position, velocity)

    def _step(self, state: StitchState, sample: Sample, target: Toes, dt: Floats) -> Toes:
        planted = _planted(sample)
        speed = np.hypot(target.velocity[..., 0], target.velocity[..., 2])
        halflife = footing.swing_halflife(speed, _SWING_SHORTEST, _SWING_LONGEST)
        state.toe_swing[...] = damper_exact(
            state.toe_swing, 1.0 - planted, _SWING_ONSET, dt[:, None]
        )
        halflife = np.where(state.toe_step > 0.0, replanting.STEP_HALFLIFE, halflife)
        halflife = np.maximum(halflife, _gentle_halflife(state.toe_gap, _STRONGEST_PULL))
        halflife = halflife / np.maximum(state.toe_swing, 0.1)
        settled = self._settled(sample)
        halflife = halflife + settled * (_BRAKE_HALFLIFE - halflife)
        moved = footing.step(
            Toes(state.toe_shown, state.toe_speed),
            state.toe_gap,
            state.toe_gap_speed,
            target,
            planted,
            halflife,
            settled,
            _LANDING_HALFLIFE,
            dt,
        )
        off = state.toe_gap[..., 1] - state.toe_lift
        height, rise = footing.decay(
            off,
            state.toe_gap_speed[..., 1] - state.toe_lift_speed,
            np.maximum(_HEIGHT_HALFLIFE, _gentle_halflife(off[..., None], _STRONGEST_FALL)),
            dt[:, None],
        )
        self._lift(state, sample, target, dt)
        moved.position[..., 1] = target.position[..., 1] + height + state.toe_lift
        moved.velocity[..., 1] = target.velocity[..., 1] + rise + state.toe_lift_speed
        return moved

    def _settled(self, sample: Sample) -> Floats:
        """Return to which share `(N, 2)` a swing is over, since the toe lands soon."""
        if sample.ahead is None:
            return np.zeros(sample.contacts.shape)
        times = np.where(sample.ahead.contacts, sample.ahead.times[:, None], np.inf)
        return np.asarray(np.clip((_BRAKE_FROM_S - times.min(axis=1)) / _BRAKE_S, 0.0, 1.0))

    def _lift(self, state: StitchState, sample: Sample, target: Toes, dt: Floats) -> None:
        """Raise toes that close a gap fast and do not land soon; lower those that stand high."""
        closing = np.hypot(state.toe_gap_speed[..., 0], state.toe_gap_speed[..., 2])
        down = sample.contacts
        if sample.ahead is not None:
            soon = sample.ahead.times <= _LANDING_SOON_S
            down = down | sample.ahead.contacts[:, soon].any(axis=1)
        lift = np.where(down, 0.0, np.minimum(_LIFT_BY_SPEED * closing, _HIGHEST_LIFT))
        ground = sample.roots.position[:, None, 1] + sample.legs.toe_height
        above = np.maximum(target.position[..., 1] - ground - _HOVER, 0.0)
        wanted = np.where(sample.contacts, -above, lift)
        state.toe_lift[...], state.toe_lift_speed[...] = spring_damper_exact(
            state.toe_lift, state.toe_lift_speed, wanted, _LIFT_HALFLIFE, dt[:, None]
        )

    def _remember(
        self, state: StitchState, sample: Sample, target: Toes, toes: Toes, reached: Vectors
    ) -> None:
        """Note where the toes really came to lie; a leg that is too short drags its foot along."""
        shown = sample.roots.to_world(reached)
        state.toe_shown[...] = shown
        state.toe_speed[...] = toes.velocity
        state.toe_gap[...] = shown - target.position
        state.toe_gap_speed[...] = toes.velocity - target.velocity


def _planted(sample: Sample) -> Floats:
    """Return to which share `(N, 2)` toes stand: as guided, else as labels and own steps say."""
    labels, guide = sample.contacts.astype(np.float64), sample.guide
    if guide is None:
        return labels
    if guide.guided is None:
        return guide.planted
    return np.where(guide.guided[:, None], guide.planted, labels)


def leave(state: StitchState, source: Motion, legs: Legs, rows: Flags) -> None:
    """Turn what was done to hips and legs into offsets, for whoever hides the next transition.

    Args:
        state: Of characters that are about to jump; changed in place.
        source: What they were playing.
        legs: Of the skeleton.
        rows: `(N,)` for which of them.
    """
    state.offset_hips[rows, 1] -= state.hip_drop[rows]
    shown = state.legs_shown[rows]
    back = quaternion.conjugate(source.rotations[rows][:, legs.joints])
    which = np.ix_(np.flatnonzero(rows), legs.joints)
    state.offset_rotations[which] = quaternion.to_scaled_axis(quaternion.multiply(shown, back))
    state.offset_angular_velocity[which] = 0.0


def _decay_body(state: StitchState, legs: Legs, dt: Floats) -> None:
    halflife = np.maximum(state.body_halflife, _BODY_HALFLIFE)[..., None]
    # feet have a pace of their own, and legs that turn slower than they move jerk their knees
    halflife[:, 1 + np.append(legs.joints, legs.toe)] = _BODY_HALFLIFE
    state.offset_hips[...], state.offset_hips_velocity[...] = footing.decay(
        state.offset_hips, state.offset_hips_velocity, halflife[:, 0], dt[:, None]
    )
    state.offset_rotations[...], state.offset_angular_velocity[...] = footing.decay(
        state.offset_rotations, state.offset_angular_velocity, halflife[:, 1:], dt[:, None, None]
    )


def _gentle_halflife(offset: Vectors, strongest: float) -> Floats:
    """Return seconds `(...)` in which offsets `(..., 3)` decay without pulling harder."""
    size = np.sqrt(np.sum(offset * offset, axis=-1))
    return np.asarray(2.0 * _LN2 * np.sqrt(size / strongest))


def _drop(
    state: StitchState, ahead: LegsAhead | None, sample: Sample, toes: Toes, dt: Floats
) -> Floats:
    """Return by how much the hips `(N,)` are lowered so that legs reach, now and soon."""
    wanted = np.zeros(len(dt))
    if ahead is not None:
        need = _need(state, sample, ahead, toes)
        wanted = np.minimum(need.max(axis=(1, 2)), _DEEPEST_DROP)
    drop, speed = spring_damper_exact(
        state.hip_drop, state.hip_drop_speed, wanted, _DROP_HALFLIFE, dt
    )
    state.hip_drop[...], state.hip_drop_speed[...] = drop, speed
    return state.hip_drop.copy()


def _need(state: StitchState, sample: Sample, ahead: LegsAhead, toes: Toes) -> Floats:
    """Return by how much hips `(N, K, 2)` ought to be lower at the times ahead."""
    now = sample.roots.to_root(toes.position)[:, None]
    gap = turn_to_root(state.toe_gap, sample.roots.yaw)[:, None]
    gap_speed = turn_to_root(state.toe_gap_speed, sample.roots.yaw)[:, None]
    time = ahead.times[None, :, None, None]
    halflife = np.full((1, 1, 1, 1), 0.1)
    closed, _ = footing.decay(gap, gap_speed, halflife, time)
    swinging = ahead.toes + closed
    # a foothold lasts until the first time ahead at which the foot swings
    stays = np.logical_and.accumulate(ahead.contacts, axis=1) & sample.contacts[:, None]
    toe = np.where(stays[..., None], now, swinging)
    ankle = toe + (ahead.ankles - ahead.toes)
    fade, _ = footing.decay(
        state.offset_hips[:, None], state.offset_hips_velocity[:, None],
        np.full((1, 1, 1), _BODY_HALFLIFE), ahead.times[None, :, None],
    )  # fmt: skip
    hip = ahead.hips + fade[:, :, None]
    own = np.linalg.norm(ahead.hips - ahead.ankles, axis=-1)
    reach = np.maximum(REACH * sample.legs.length, own)
    away = hip - ankle
    aside = np.hypot(away[..., 0], away[..., 2])
    highest = np.sqrt(np.maximum(reach**2 - aside**2, 0.0))
    return np.asarray(np.maximum(away[..., 1] - highest, 0.0))
