"""A skipped frame's root motion, flags and events go into its successor."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stridewire._messages import ClipEnd, Frame, FrameFlag
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire_server.streaming.skipping import MAX_EVENTS, compose, skip

TURNED = np.uint32(1 << FrameFlag.TELEPORTED)
HELD = np.uint32(1 << FrameFlag.HELD)


def frame(number: int, ids: list[int], delta: Floats, flags: int = 0) -> Frame:
    """Return a frame with a root motion for each character."""
    count = len(ids)
    return Frame(
        number,
        0,
        0.0,
        0.0,
        np.array(ids, np.uint32),
        np.zeros((count, 7)),
        np.asarray(delta, np.float32),
        np.zeros((count, 3)),
        np.zeros((count, 1, 4)),
        np.zeros(count, np.uint32),
        np.zeros((count, 2, 3)),
        np.full(count, flags, np.uint32),
        events=(ClipEnd(ids[0], number, "clip"),),
    )


def walk(root: Floats, delta: Floats) -> Floats:
    """Move a root x, y, z, yaw by a root motion, with the kernel's quaternions."""
    turn = quaternion.from_yaw(np.asarray(root[3]))
    return np.append(root[:3] + quaternion.rotate(turn, delta[:3]), root[3] + delta[3])


numbers = st.floats(-3.0, 3.0)
motions = st.tuples(numbers, numbers, numbers, numbers).map(np.array)


@given(motions, motions, motions)
def test_composed_motion_is_one_after_the_other(root: Floats, a: Floats, b: Floats) -> None:
    """Walking a and then b ends where walking their composition does."""
    together = compose(a[None], b[None])[0]
    np.testing.assert_allclose(walk(root, together), walk(walk(root, a), b), atol=1e-9)


def test_a_skipped_frame_is_counted_and_told() -> None:
    """Drops add up, events of both come in order, flags of both hold, inputs stay as they were."""
    a = replace(frame(1, [3, 4], np.ones((2, 4)), HELD), dropped=2)
    b = frame(2, [3, 4], np.ones((2, 4)))
    got = skip(a, b)
    assert (got.frame, got.dropped) == (2, 3)
    assert [event.frame for event in got.events] == [1, 2]
    assert got.flags.tolist() == [HELD, HELD]
    assert b.flags.tolist() == [0, 0]
    np.testing.assert_array_equal(b.root_delta, 1.0)


def test_characters_are_matched_by_id() -> None:
    """Order may change, characters may come and go between the two frames."""
    a = frame(1, [1, 2, 3], [[1, 0, 0, 0], [2, 0, 0, 0], [3, 0, 0, 0]])
    b = frame(2, [3, 4, 1], np.zeros((3, 4)))
    np.testing.assert_array_equal(skip(a, b).root_delta[:, 0], [3.0, 0.0, 1.0])


def test_a_teleport_breaks_the_root_motion() -> None:
    """What was walked before a teleport is no part of the motion after it."""
    before = frame(1, [1], [[5, 0, 0, 1]])
    after = frame(2, [1], [[0.1, 0, 0, 0]], TURNED)
    np.testing.assert_allclose(skip(before, after).root_delta, [[0.1, 0, 0, 0]], rtol=1e-6)
    later = skip(skip(before, after), frame(3, [1], [[0.2, 0, 0, 0]]))
    np.testing.assert_allclose(later.root_delta, [[0.3, 0, 0, 0]], rtol=1e-6)
    assert later.flagged(FrameFlag.TELEPORTED).tolist() == [1]


@pytest.mark.parametrize("skipped", [10, 3 * MAX_EVENTS])
def test_events_are_bounded(skipped: int) -> None:
    """The newest events are kept."""
    got = frame(0, [1], np.zeros((1, 4)))
    for number in range(1, skipped + 1):
        got = skip(got, frame(number, [1], np.zeros((1, 4))))
    assert len(got.events) == min(skipped + 1, MAX_EVENTS)
    assert got.events[-1].frame == skipped
