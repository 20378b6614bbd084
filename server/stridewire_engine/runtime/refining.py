"""Refining: asking the network about transitions, and remembering what it said.

What it is asked about is a plan: the last frames that were shown, and the coming ones of the clip
that was jumped to, springs over the seam. Frames that were sent never change; what the network
says fades out at the plan's end. A clip on its own path has the labels that count, so that the
network adds to them and leads swings but half of its way. Turns of feet are left alone: the next
transition would drop them within a frame, which jerks knees.
"""

import numpy as np

from stridewire._messages import FallbackReason
from stridewire.motion import quaternion
from stridewire.motion.array_types import Flags, Floats, Indices, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire_engine import compiled
from stridewire_engine.library import Library
from stridewire_engine.networks.rmr import Guidance, Plans, Refiner
from stridewire_engine.networks.rmr.plans import FRAME_RATE, WINDOW
from stridewire_engine.runtime import sampling
from stridewire_engine.runtime.characters import GUIDED_FRAMES, PAST_FRAMES, Characters
from stridewire_engine.runtime.drafting import LED, Answer, Drafts
from stridewire_engine.runtime.lookahead import LegTracks
from stridewire_engine.stitchers import Guide, Roots, Sample
from stridewire_engine.stitchers.footing import decay
from stridewire_engine.stitchers.legs import LegPose, Legs, leg_pose

_LOWER = 9
"""The reference's first joints: hips and legs."""
_HALFLIFE = 0.1
_FADE_OUT = 12
_LN2 = float(np.log(2.0))
_EVEN = 0.02
_TELEPORT = 1.0
"""A root that goes so many metres in a frame was set elsewhere."""
_PLANTED = 0.5
_FEET, _TOES, _HIPS = [0, 1], [2, 3], 4
_TIMES = (np.arange(GUIDED_FRAMES) + 1) / FRAME_RATE
_NO_FALLBACK = 0


class Refining:
    """What a tick needs to refine transitions over one library."""

    def __init__(
        self, library: Library, tracks: LegTracks, legs: Legs, refiner: Refiner, halflife: float
    ) -> None:
        """Take what does not change.

        Args:
            library: On the reference skeleton.
            tracks: Of its legs.
            legs: Of its skeleton.
            refiner: The network.
            halflife: Of the damper of the root's velocity difference at a jump.
        """
        self._library, self._tracks, self._legs = library, tracks, legs
        self._refiner, self._halflife = refiner, halflife
        self._drafts = Drafts(library, tracks, legs, refiner, halflife)

    def plan(self, state: Characters, which: Indices, most: int) -> None:
        """Ask about characters that have just jumped; their guides and fallbacks are set.

        Args:
            state: All rows of the tick.
            which: `(M,)` those that are stitched by `refine`, set to their new moments.
            most: So many are asked about at most.
        """
        fallback = np.where(
            state.past_uneven[which], FallbackReason.OTHER_RATE, FallbackReason.TOO_FEW_FRAMES
        )
        known = np.flatnonzero(state.past_frames[which] >= PAST_FRAMES)
        fallback[known[most:]] = FallbackReason.BUSY
        known = known[:most]
        if len(known):
            mine = which[known]
            said = self._drafts.ask(state, mine) if compiled.ENABLED else self._ask(state, mine)
            near = said.distance <= self._refiner.furthest
            fallback[known] = np.where(near, _NO_FALLBACK, FallbackReason.UNLIKE_TRAINING)
            chosen = mine[near]
            state.guide_frames[chosen] = GUIDED_FRAMES
            state.guide_planted[chosen] = said.planted[near]
            state.guide_offset[chosen] = said.toe_offset[near]
        state.fallback[which] = fallback

    def _ask(self, state: Characters, which: Indices) -> Answer:
        """Ask the network about characters `(M,)` whose past is known."""
        plans, coming = self._plans(state.borrow(which)), slice(PAST_FRAMES, None)
        said = followed(plans, self._refiner.refine(plans))
        return Answer(said.planted[:, coming], said.toe_offset[:, coming], said.distance)

    def _plans(self, rows: Characters) -> Plans:
        count = len(rows)
        now = sampling.moments(self._library, rows.clip, rows.clip_time)
        clip = np.repeat(rows.clip, GUIDED_FRAMES)
        then = sampling.moments(self._library, clip, (rows.clip_time[:, None] + _TIMES).ravel())
        roots = self._roots(rows, now.repeated(GUIDED_FRAMES), then)
        hips, pose = self._sprung(rows, now, then)
        toes, weight = self._tracks.toes, then.weight[:, None, None]
        own = toes[then.rows] + weight * (toes[then.rows + 1] - toes[then.rows])

        def placed(local: Vectors) -> Vectors:
            return roots.to_world(local).reshape(count, GUIDED_FRAMES, *local.shape[1:])

        # the network's ground is at 0
        level = rows.root_position[:, 1, None, None] * np.array([0.0, 1.0, 0.0])
        root, past = rows.past_root[..., :3] - level, rows.past_shown - level[:, None]
        contacts = self._library.contacts[then.nearest][:, 1::2]
        return Plans(
            np.concatenate([root, roots.position.reshape(count, -1, 3)], axis=1),
            np.concatenate([rows.past_root[..., 3], roots.yaw.reshape(count, -1)], axis=1),
            np.concatenate([past[:, :, _HIPS], placed(hips[:, None])[:, :, 0]], axis=1),
            np.concatenate([past[:, :, _TOES], placed(pose.toe)], axis=1),
            np.concatenate([past[:, :, _FEET], placed(pose.ankle)], axis=1),
            np.concatenate([past[:, :, _TOES], placed(own)], axis=1),
            np.concatenate([rows.past_contacts, contacts.reshape(count, -1, 2)], axis=1),
            np.full((count, WINDOW), PAST_FRAMES),
            np.zeros(count, np.bool_),
        )

    def _roots(self, rows: Characters, now: sampling.Moments, then: sampling.Moments) -> Roots:
        """Return where the roots will be `(M K,)`, on the ground at 0."""
        motion = sampling.root_delta(self._library, now, then).reshape(len(rows), -1, 3)
        fading = -np.expm1(-_LN2 * _TIMES / self._halflife) * (self._halflife / _LN2)
        motion = motion + rows.root_offset[:, None] * fading[:, None]
        way = np.stack([motion[..., 0], 0.0 * motion[..., 0], motion[..., 1]], axis=-1)
        flat = rows.root_position[:, None] * np.array([1.0, 0.0, 1.0])
        position = flat + turn_to_world(way, rows.root_yaw)
        yaw = rows.root_yaw[:, None] + motion[..., 2]
        return Roots(position.reshape(-1, 3), yaw.reshape(-1))

    def _sprung(
        self, rows: Characters, now: sampling.Moments, then: sampling.Moments
    ) -> tuple[Vectors, LegPose]:
        """Return hips `(M K, 3)` and legs of the coming frames, springs over the seam."""
        hips, rotations = sampling.sample_pose(self._library, then, _LOWER)
        away = rows.offset_hips - np.stack(
            [0.0 * rows.hip_drop, rows.hip_drop, 0.0 * rows.hip_drop], -1
        )
        halflife = np.full((1, 1, 1), _HALFLIFE, np.float32)
        passed = _TIMES[None, :, None].astype(np.float32)
        move, _ = decay(away[:, None], rows.offset_hips_velocity[:, None], halflife, passed)
        turn, _ = decay(
            self._turned_by(rows, now)[:, None],
            rows.offset_angular_velocity[:, None, :_LOWER],
            halflife[..., None],
            passed[..., None],
        )
        hips = hips + move.reshape(-1, 3)
        turned = quaternion.from_scaled_axis(turn.reshape(-1, _LOWER, 3))
        lower = quaternion.multiply(turned, rotations)
        return hips, leg_pose(self._legs, hips, lower)

    def _turned_by(self, rows: Characters, now: sampling.Moments) -> Vectors:
        """Return by what lower joints `(M, L, 3)` are off the new clip: legs as they were bent."""
        _, rotations = sampling.sample_pose(self._library, now, _LOWER)
        legs = self._legs
        body = quaternion.multiply(
            quaternion.from_scaled_axis(rows.offset_rotations[:, legs.joints]),
            rotations[:, legs.joints],
        )
        bent = np.any(rows.legs_shown, axis=(1, 2))[:, None, None]
        shown = np.where(bent, rows.legs_shown, body)
        back = quaternion.conjugate(rotations[:, legs.joints])
        off = rows.offset_rotations[:, :_LOWER].copy()
        off[:, legs.joints] = quaternion.to_scaled_axis(
            quaternion.absolute(quaternion.multiply(shown, back))
        )
        return off


def followed(plans: Plans, said: Guidance) -> Guidance:
    """Return what is followed of what the network said about clips on their own path."""
    planted = np.maximum(said.planted, plans.contacts)
    return said._replace(planted=planted, toe_offset=LED * said.toe_offset)


def remember(state: Characters, contacts: Flags, dt: Floats) -> None:
    """Keep what was shown in the last frames, as long as they are a sixtieth of a second apart.

    Args:
        state: N rows, feet planted.
        contacts: `(N, 4)` of the clips.
        dt: `(N,)` seconds.
    """
    passed = dt > 0.0
    far = np.abs(state.past_root[:, -1, :3] - state.root_position).max(axis=1) > _TELEPORT
    even = np.abs(dt * FRAME_RATE - 1.0) < _EVEN
    count = np.where(even & ~far, np.minimum(state.past_frames + 1, PAST_FRAMES), 1)
    state.past_frames[...] = np.where(passed, count, state.past_frames)
    state.past_uneven[...] = np.where(passed & (far | ~even), ~even, state.past_uneven)
    root = np.concatenate([state.root_position, state.root_yaw[:, None]], axis=1)
    for kept, new in (
        (state.past_root, root),
        (state.past_shown, state.shown_world),
        (state.past_contacts, contacts[:, 1::2]),
    ):
        kept[passed, :-1] = kept[passed, 1:]
        kept[passed, -1] = new[passed]


def guided(state: Characters) -> Flags:
    """Tell who `(N,)` is guided now."""
    shown = _frame(state, np.zeros(1))[:, 0]
    return np.asarray((shown >= 0) & (shown < state.guide_frames))


def refined_frames(state: Characters) -> Indices:
    """Return for how many frames `(N,)` feet were guided since the last transition."""
    shown = _frame(state, np.zeros(1))[:, 0] + 1
    return np.minimum(shown, state.guide_frames)


def guide(state: Characters, sample: Sample) -> Sample:
    """Return the sample with the guide of those who have one; what others are shown is the same.

    Args:
        state: N rows.
        sample: Of them, with the legs ahead.
    """
    now = _said(state, np.zeros(1), sample.contacts[:, None])
    yaw = sample.roots.yaw
    told = Guide(
        now.planted[:, 0],
        turn_to_root(now.toe_offset[:, 0], yaw),
        None,
        guided(state),
    )
    ahead = sample.ahead
    if ahead is not None:
        then = _said(state, ahead.times, ahead.contacts)
        led = turn_to_root(then.toe_offset.reshape(len(yaw), -1, 3), yaw).reshape(ahead.toes.shape)
        ahead = ahead._replace(
            ankles=ahead.ankles + led, toes=ahead.toes + led, contacts=then.planted > _PLANTED
        )
    return sample._replace(contacts=told.planted > _PLANTED, guide=told, ahead=ahead)


def _said(state: Characters, times: Floats, labels: Flags) -> Guide:
    """Return what the network said `(N, K, …)` of times ahead; it fades into the labels."""
    frame = _frame(state, times)
    x = np.clip((GUIDED_FRAMES - frame) / (_FADE_OUT + 1.0), 0.0, 1.0)
    x *= guided(state)[:, None]
    share = (x * x * (3.0 - 2.0 * x))[..., None]
    rows = np.arange(len(frame))[:, None]
    at = np.clip(frame, 0, GUIDED_FRAMES - 1)
    offset = share[..., None] * state.guide_offset[rows, at]
    planted = share * state.guide_planted[rows, at] + (1.0 - share) * labels
    return Guide(planted, offset, None)


def _frame(state: Characters, times: Floats) -> Indices:
    """Return the frame `(N, K)` of the guide at times ahead."""
    since = np.minimum(state.stitch_time, 1e3).astype(np.float64)
    return np.asarray(np.round((since[:, None] + times) * FRAME_RATE).astype(np.intp) - 1)
