"""The parts of the synthetic generator: scripts, cycles, planting, and the model's file."""

import io
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.gait.cycle import HOLD_PHASES, cycle
from stridewire_engine.building.gait.draw import draw_clip, reverse
from stridewire_engine.building.gait.model import (
    CHANNELS,
    GaitModel,
    GaitModelError,
    decode,
    design,
    encode,
)
from stridewire_engine.building.gait.planting import Feet, plant, stances
from stridewire_engine.building.gait.script import ACCELERATION, Segment, travel

MODEL = GaitModel.shipped()
START_WALK_STOP = [Segment(1.0), Segment(4.0, 1.3), Segment(3.0)]


@given(
    speeds=st.lists(st.floats(0.0, 4.0), min_size=1, max_size=4),
    turn=st.floats(-3.0, 3.0),
)
def test_travel_never_accelerates_faster_than_people(speeds: list[float], turn: float) -> None:
    """Whatever the script asks for, speed changes by at most the limit."""
    path = travel([Segment(1.0, speed, turn) for speed in speeds])
    assert np.abs(np.diff(path.speed)).max() * 60.0 <= ACCELERATION + 1e-6
    assert np.abs(path.turn).max() <= abs(turn) + 1e-9


def test_travel_of_a_steady_turn_is_a_circle() -> None:
    """The radius is speed over turning rate."""
    path = travel([Segment(8.0, 1.2, 0.8)])
    centre = np.array([1.2 / 0.8, 0.0, 0.0])
    radius = np.linalg.norm(path.position - centre, axis=-1)
    np.testing.assert_allclose(radius, 1.2 / 0.8, rtol=1e-3)


def test_a_standing_character_holds_its_phase_with_both_feet_down() -> None:
    """Before the first and after the last step the phase rests where both toes are planted."""
    path = travel(START_WALK_STOP)
    steps = cycle(MODEL, path, rate=1.0, start=HOLD_PHASES[0])
    assert steps.holding[0]
    assert steps.holding[-1]
    assert not steps.holding[200]
    assert np.all(steps.planted[steps.holding])
    assert float(steps.phase[-1, 0]) in HOLD_PHASES


def test_running_has_flight_and_walking_has_none() -> None:
    """At 3.5 m/s there are frames with no toe planted; at 1 m/s hardly any."""
    airborne = []
    for speed in (1.0, 3.5):
        steps = cycle(MODEL, travel([Segment(6.0, speed)]), rate=1.0, start=0.0)
        airborne.append(np.mean(~steps.planted.any(axis=1)))
    assert airborne[0] < 0.05
    assert airborne[1] > 0.4


def test_cadence_grows_with_speed_as_people_s_does() -> None:
    """Two steps a cycle: 1.2 to 1.8 steps/s at 0.8 m/s, 2 to 2.5 at 1.8, 2.7 to 3.1 at 3.5."""
    for speed, low, high in ((0.8, 1.2, 1.8), (1.8, 2.0, 2.5), (3.5, 2.7, 3.1)):
        gait = MODEL.run if speed > 2.0 else MODEL.walk
        steps_per_second = 2.0 * gait.cadence_at(np.array([speed]), np.zeros(1))[0]
        assert low < steps_per_second < high


def _sliding_feet(frames: int = 120) -> Feet:
    rng = np.random.default_rng(3)
    toe = np.cumsum(rng.normal(0.0, 0.002, (frames, 2, 3)), axis=0)
    toe[..., 1] += 0.05
    planted = (np.arange(frames)[:, None] // 20 + [0, 1]) % 2 == 0
    angles = 0.1 * rng.normal(size=(2, frames, 2))
    return Feet(toe, np.cumsum(0.02 * angles[0], axis=0), angles[1], planted)


def test_planted_toes_stay_where_they_would_be_on_average() -> None:
    """In each stance the toe rests at the mean of the unpinned one, at the height asked for."""
    feet = _sliding_feet()
    none = np.zeros(120)
    pinned = plant(feet, none.astype(bool), none, height=0.02)
    for side in range(2):
        for start, end in stances(feet.planted[:, side]):
            place = feet.toe[start:end, side].mean(axis=0)
            place[1] = 0.02
            np.testing.assert_allclose(
                pinned.toe[start:end, side], np.broadcast_to(place, (end - start, 3)), atol=1e-12
            )
    assert np.all(pinned.toe[..., 1] >= 0.02)
    assert np.all(pinned.pitch[feet.planted] >= 0.0)


def test_swings_join_their_plants() -> None:
    """The swing's correction goes over into the plants' without a jump."""
    feet = _sliding_feet()
    none = np.zeros(120)
    pinned = plant(feet, none.astype(bool), none, height=0.02)
    correction = (pinned.toe - feet.toe)[..., [0, 2]]
    lifts = np.flatnonzero(feet.planted[:-1, 0] & ~feet.planted[1:, 0])
    assert len(lifts) > 1
    assert np.abs(correction[lifts + 1, 0] - correction[lifts, 0]).max() < 2e-4


def test_a_pivoting_foot_turns_by_its_share() -> None:
    """With pivot 0.5 the planted heading keeps half of its turning, the toe none of its sliding."""
    feet = _sliding_feet()
    none = np.zeros(120)
    pinned = plant(feet, none.astype(bool), np.full(120, 0.5), height=0.02)
    start, end = stances(feet.planted[:, 0])[1]
    np.testing.assert_allclose(
        np.ptp(pinned.yaw[start:end, 0]), 0.5 * np.ptp(feet.yaw[start:end, 0])
    )
    assert np.ptp(pinned.toe[start:end, 0, 0]) == 0.0


def test_channels_are_decoded_as_encoded() -> None:
    """Rotations and positions survive the way through the model's channels."""
    rng = np.random.default_rng(1)
    rotations = quaternion.from_scaled_axis(0.5 * rng.normal(size=(9, len(REFERENCE), 3)))
    positions = rng.normal(size=(9, 5, 3))
    channels = encode(rotations, positions, MODEL.base)
    assert channels.shape == (9, CHANNELS)
    again, places = decode(channels, MODEL.base)
    np.testing.assert_allclose(
        quaternion.absolute(again), quaternion.absolute(rotations), atol=1e-9
    )
    np.testing.assert_allclose(places, positions)


def test_the_model_is_symmetric() -> None:
    """Half a cycle later the right ankle is where the left one was, on the other side."""
    phase = np.linspace(0.0, 1.0, 24, endpoint=False)
    none = np.zeros_like(phase)
    for gait in (MODEL.walk, MODEL.run):
        _, now = decode(design(phase, none, none, none) @ gait.coefficients, MODEL.base)
        _, later = decode(design(phase + 0.5, none, none, none) @ gait.coefficients, MODEL.base)
        np.testing.assert_allclose(now[:, 1] * [-1.0, 1.0, 1.0], later[:, 3], atol=0.01)


def test_the_file_keeps_the_model() -> None:
    """Saving and loading twice gives the same bytes."""
    first, second = io.BytesIO(), io.BytesIO()
    MODEL.save(first)
    GaitModel.load(io.BytesIO(first.getvalue())).save(second)
    assert first.getvalue() == second.getvalue()
    assert len(first.getvalue()) < 1_000_000


def test_a_file_of_another_model_is_refused() -> None:
    """A missing and a misshapen array are named, with the command that repairs."""
    empty = io.BytesIO()
    np.savez(empty, base=np.zeros((len(REFERENCE), 4)))
    with pytest.raises(GaitModelError, match=r"lacks the array .*stridewire train gait"):
        GaitModel.load(io.BytesIO(empty.getvalue()))
    wrong = io.BytesIO()
    replace(MODEL, standing=np.zeros(3)).save(wrong)
    with pytest.raises(GaitModelError, match=r"standing has shape \(3,\); expected \(81,\)"):
        GaitModel.load(io.BytesIO(wrong.getvalue()))


def test_reversed_walking_goes_backward_with_its_contacts() -> None:
    """The reversed clip has the same poses from the end, tagged backward."""
    clip = draw_clip(MODEL, "walk", START_WALK_STOP, np.random.default_rng(5))
    back = reverse(clip)
    np.testing.assert_array_equal(back.pose.hips, clip.pose.hips[::-1])
    np.testing.assert_array_equal(back.contacts, clip.contacts[::-1])
    assert "walk" in {tag.name for tag in clip.tags}
    assert "backward" in {tag.name for tag in back.tags}
