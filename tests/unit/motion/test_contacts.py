"""Contacts on constructed motion, where the answer is known."""

import numpy as np
import pytest

from stridewire.motion.array_types import Vectors
from stridewire.motion.contacts import detect_contacts, rest_heights, to_mask
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE

RATE = 60.0
JOINTS = REFERENCE.indices(CONTACT_JOINTS)
LEFT_TOE = REFERENCE.index("LeftToe")


def standing(frames: int) -> Vectors:
    """Return joints `(frames, J, 3)` at rest height that do not move."""
    positions = np.zeros((frames, len(REFERENCE), 3))
    positions[:, JOINTS, 1] = rest_heights(REFERENCE, JOINTS)
    return positions


def test_who_stands_has_all_four_planted() -> None:
    """Still and low is planted."""
    assert detect_contacts(REFERENCE, standing(30), RATE).all()


def test_rest_heights_are_those_of_the_rest_pose() -> None:
    """Ankles at 7 cm, toes at 2 cm."""
    np.testing.assert_allclose(rest_heights(REFERENCE, JOINTS), [0.07, 0.02, 0.07, 0.02])


def test_a_lifted_toe_is_free_and_the_others_are_not() -> None:
    """A toe held 20 cm up touches nothing, however still."""
    positions = standing(60)
    positions[20:40, LEFT_TOE, 1] += 0.2
    contacts = detect_contacts(REFERENCE, positions, RATE)
    assert not contacts[21:39, 1].any()
    assert contacts[:15, 1].all()
    assert contacts[45:, 1].all()
    assert contacts[:, [0, 2, 3]].all()


@pytest.mark.parametrize(("speed", "planted"), [(0.1, True), (0.2, False), (0.4, False)])
def test_a_sliding_toe_is_planted_only_below_15_cm_a_second(speed: float, planted: bool) -> None:
    """Low is not enough."""
    positions = standing(60)
    positions[:, LEFT_TOE, 0] = speed * np.arange(60) / RATE
    assert detect_contacts(REFERENCE, positions, RATE)[:, 1].all() == planted


def test_a_planted_toe_stays_planted_up_to_25_cm_a_second() -> None:
    """Hysteresis: what is planted is let go later than it was taken."""
    positions = standing(120)
    speed = np.where(np.arange(120) < 60, 0.05, 0.2)
    positions[:, LEFT_TOE, 0] = np.cumsum(speed) / RATE
    assert detect_contacts(REFERENCE, positions, RATE)[:, 1].all()


def test_a_flicker_of_one_frame_is_removed() -> None:
    """The median over 0.1 s takes single frames away."""
    positions = standing(60)
    positions[30, LEFT_TOE, 1] += 0.2
    assert detect_contacts(REFERENCE, positions, RATE)[:, 1].all()


def test_masks_are_one_bit_a_joint() -> None:
    """1 left foot, 2 left toe, 4 right foot, 8 right toe."""
    flags = np.array([[True, False, False, True], [False, True, True, False]])
    masks = to_mask(flags)
    assert masks.dtype == np.uint32
    np.testing.assert_array_equal(masks, [9, 6])
