"""Skeletons: refusals, identity, the reference."""

import numpy as np
import pytest

from stridewire.motion.skeleton import HEAD_TOP, REFERENCE, Skeleton, SkeletonError

ZEROS = np.zeros((2, 3))


@pytest.mark.parametrize(
    ("names", "parents", "offsets", "message"),
    [
        (("a", "b"), (-1,), ZEROS, "2 names, 1 parents"),
        (("a", "b"), (-1, 0), np.zeros((2, 2)), r"expected J, J and \(J, 3\)"),
        (("a", "a"), (-1, 0), ZEROS, "'a' occurs twice"),
        (("a", "b"), (-1, 1), ZEROS, "'b' has parent 1"),
        (("a", "b"), (-1, -1), ZEROS, "'b' has parent -1"),
        (("a", "b"), (1, 0), ZEROS, "'a' has parent 1"),
        (("a", "b"), (-1, 0), np.full((2, 3), np.nan), "not finite"),
    ],
)
def test_malformed_skeletons_are_refused(
    names: tuple[str, ...], parents: tuple[int, ...], offsets: np.ndarray, message: str
) -> None:
    """Each way to be wrong has a message of its own."""
    with pytest.raises(SkeletonError, match=message):
        Skeleton(names, parents, offsets)


def test_an_unknown_joint_is_named_with_those_present() -> None:
    """A wrong name gets the list of right ones."""
    with pytest.raises(SkeletonError, match=r"no joint 'Tail'.*Hips, LeftUpLeg"):
        REFERENCE.index("Tail")


def test_the_reference_is_175_cm_tall_with_the_hips_first() -> None:
    """22 joints, toes at the ground, the head's top at 1.75 m."""
    height = sum(REFERENCE.offsets[REFERENCE.index(j), 1] for j in ("Hips", "Spine", "Spine1"))
    height += sum(REFERENCE.offsets[REFERENCE.index(j), 1] for j in ("Spine2", "Neck", "Head"))
    assert height + HEAD_TOP == pytest.approx(1.75)
    assert (len(REFERENCE), REFERENCE.names[0]) == (22, "Hips")


def test_skeletons_are_equal_by_content() -> None:
    """Hash and equality come from names, parents and offsets."""
    same = Skeleton(REFERENCE.names, REFERENCE.parents, REFERENCE.offsets.copy())
    assert same == REFERENCE
    assert hash(same) == hash(REFERENCE)
    assert REFERENCE.scaled(1.1) != REFERENCE


def test_levels_hold_every_joint_below_its_parent() -> None:
    """Each joint but the first lies on one level, after its parent's."""
    seen = {0}
    for joints, parents in REFERENCE.levels:
        assert set(parents.tolist()) <= seen
        seen |= set(joints.tolist())
    assert seen == set(range(len(REFERENCE)))
