"""Boxes: what overlaps and by how much, and which pairs count."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.evaluation.body_boxes import BOXES, admissible_pairs, collisions, overlap
from stridewire_engine.networks.blend.postures import Postures

UNIT = np.eye(3)[None]
HALF = np.ones((1, 3))


def _at_rest(count: int = 1) -> Postures:
    hips = np.tile([0.0, 0.95, 0.0], (count, 1))
    return Postures(hips, quaternion.identity(count, len(REFERENCE), dtype=np.float64))


@pytest.mark.parametrize(("apart", "depth"), [(1.5, 0.5), (2.0, 0.0), (3.0, -1.0)])
def test_aligned_boxes(apart: float, depth: float) -> None:
    """Along an axis they overlap by what is left of their sizes."""
    found = overlap(np.array([[apart, 0.2, 0.1]]), UNIT, UNIT, HALF, HALF)
    np.testing.assert_allclose(found, depth, atol=1e-12)


def test_edges_keep_boxes_apart() -> None:
    """Two bars that cross at a distance are told apart by an axis across both."""
    turn = quaternion.from_axis_angle((0.0, 0.0, 1.0), 0.25 * np.pi)
    other = quaternion.rotate(np.broadcast_to(turn, (3, 4)), np.eye(3))[None]
    bar = np.array([[5.0, 0.1, 0.1]])
    assert overlap(np.array([[0.0, 0.0, 0.25]]), UNIT, other, bar, bar)[0] < 0.0
    assert overlap(np.array([[0.0, 0.0, 0.15]]), UNIT, other, bar, bar)[0] > 0.0


def test_overlap_does_not_depend_on_the_order(rng: np.random.Generator) -> None:
    """Box a against b is box b against a."""
    turns = quaternion.normalize(rng.normal(size=(2, 200, 1, 4)))
    a, b = (quaternion.rotate(np.repeat(t, 3, 1), np.tile(np.eye(3), (200, 1, 1))) for t in turns)
    halves = rng.uniform(0.1, 1.0, (2, 200, 3))
    way = rng.normal(size=(200, 3))
    np.testing.assert_allclose(
        overlap(way, a, b, halves[0], halves[1]),
        overlap(-way, b, a, halves[1], halves[0]),
        atol=1e-9,
    )


def test_fifteen_boxes_and_the_pairs_that_count() -> None:
    """86 pairs of other segments that are no neighbours, but for 13 that bodies always touch."""
    assert len(BOXES) == 15
    assert len(admissible_pairs()) == 86 - 13


def test_nobody_collides_at_rest() -> None:
    """The T-pose is free."""
    assert not collisions(_at_rest()).any()


def test_clapping_hands_collide() -> None:
    """Arms turned forward and inward bring the hands together, and nothing else."""
    posture = _at_rest()
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        arm = REFERENCE.index(f"{side}Arm")
        posture.rotations[0, arm] = quaternion.from_axis_angle((0.0, 1.0, 0.0), sign * 1.85)
    pairs = admissible_pairs()[collisions(posture)[0]]
    names = {BOXES[i].name for i in pairs.reshape(-1)}
    assert names >= {"Left hand", "Right hand"}
    assert all("leg" not in BOXES[i].segment for i in pairs.reshape(-1))


def test_the_place_does_not_matter(rng: np.random.Generator) -> None:
    """The same postures elsewhere collide alike."""
    here = _at_rest(30)
    here.rotations[:] = quaternion.normalize(
        here.rotations + 0.5 * rng.normal(size=here.rotations.shape)
    )
    there = Postures(here.hips + np.array([5.0, 0.0, -3.0]), here.rotations)
    found = collisions(here)
    assert found.any()
    np.testing.assert_array_equal(found, collisions(there))
