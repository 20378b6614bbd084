"""Blends over every transport: the same answers, bad input named by field, pasteable text."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from stridewire import BlendMethod, BlendQuery, ClipTime, InvalidRequestError, NotFoundError
from stridewire.motion.clip import Pose
from stridewire_engine.library import Library

FIVE = (0.0, 0.25, 0.5, 0.75, 1.0)
EXACT = 1e-6


@pytest.fixture
def moments(small_library: Library) -> tuple[ClipTime, ClipTime]:
    """Return two moments of one clip."""
    name = small_library.clips[0].name
    return ClipTime(name, 0.5), ClipTime(name, 1.0)


def at(library: Library, moment: ClipTime) -> Pose:
    """Return the pose of a moment."""
    return library.clip(moment.clip).sample(moment.time_s)


def test_references_and_poses_are_the_same(
    either: Any, small_library: Library, moments: tuple[ClipTime, ClipTime]
) -> None:
    """By reference, inline or both, with the duration told: one answer, exact at the ends."""
    start, end = moments
    poses = at(small_library, start), at(small_library, end)
    answers = [
        either.blend(a, b, FIVE, duration_s=0.5)
        for a, b in ((start, end), poses, (start, poses[1]), (poses[0], end))
    ]
    for answer in answers:
        assert len(answer.pose.rotations) == 5
        np.testing.assert_allclose(answer.pose.rotations, answers[0].pose.rotations, atol=1e-5)
        for i, pose in ((0, poses[0]), (-1, poses[1])):
            np.testing.assert_allclose(answer.pose.rotations[i], pose.rotations, atol=EXACT)
            np.testing.assert_allclose(answer.pose.hips[i], pose.hips, atol=EXACT)


def test_an_end_of_another_clip_comes_to_the_start(either: Any, small_library: Library) -> None:
    """Clips share no space: all postures stand where the start stands."""
    start = ClipTime(small_library.clips[0].name, 0.5)
    end = ClipTime(small_library.clips[2].name, 1.0, small_library.name)
    answer = either.blend(start, end, FIVE, method=BlendMethod.SLERP)
    root = at(small_library, start).root_position
    np.testing.assert_allclose(answer.pose.root_position, np.tile(root, (5, 1)), atol=EXACT)
    np.testing.assert_allclose(
        answer.pose.rotations[-1], at(small_library, end).rotations, atol=EXACT
    )


def test_many_are_each(either: Any, moments: tuple[ClipTime, ClipTime]) -> None:
    """One call for many pairs gives what a call for each gives."""
    requests = [
        BlendQuery(*moments, FIVE),
        BlendQuery(*moments, (0.3,), BlendMethod.SLERP),
        BlendQuery(*moments[::-1], (0.1, 0.9), joint_mask={"Head": 0.0}),
    ]
    for together, query in zip(either.blend_many(requests), requests, strict=True):
        alone = either.blend(
            query.start,
            query.end,
            query.weights,
            method=query.method,
            joint_mask=query.joint_mask,
        )
        assert together.method is alone.method
        np.testing.assert_allclose(together.pose.rotations, alone.pose.rotations, atol=1e-5)


def broken(pose: Pose, **changes: Callable[[Any], Any]) -> Pose:
    """Return a pose with fields changed."""
    fields = {name: change(getattr(pose, name).copy()) for name, change in changes.items()}
    return Pose(**{**vars(pose), **fields})


def nan(values: Any) -> Any:
    """Put a NaN in."""
    values[..., 0] = np.nan
    return values


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"weights": ()}, "weights"),
        ({"weights": [0.5] * 10_001}, "weights"),
        ({"weights": (0.5, 1.5)}, "weights[1]"),
        ({"weights": (-0.1,)}, "weights[0]"),
        ({"weights": (float("nan"),)}, "weights[0]"),
        ({"joint_mask": {"Tail": 1.0}}, "joint_mask[Tail]"),
        ({"joint_mask": {"Head": 2.0}}, "joint_mask[Head]"),
        ({"joint_mask": {"Head": float("nan")}}, "joint_mask[Head]"),
        ({"ground_height": float("inf")}, "ground_height"),
        ({"duration_s": -1.0}, "duration_s"),
        ({"duration_s": float("nan")}, "duration_s"),
    ],
)
def test_bad_numbers_are_named(
    either: Any, moments: tuple[ClipTime, ClipTime], changes: dict[str, Any], field: str
) -> None:
    """INVALID_ARGUMENT with the path of the field."""
    given = {"weights": FIVE, **changes}
    weights = given.pop("weights")
    with pytest.raises(InvalidRequestError) as raised:
        either.blend(*moments, weights, **given)
    assert [violation.field for violation in raised.value.violations] == [field]


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"rotations": lambda r: 2.0 * r}, "rotations"),
        ({"rotations": nan}, "rotations"),
        ({"rotations": lambda r: r[:-1]}, "rotations"),
        ({"root_rotation": lambda r: 0.0 * r}, "root"),
        ({"root_position": nan}, "root"),
        ({"hips": nan}, "hips"),
    ],
)
def test_bad_poses_are_named(
    either: Any,
    small_library: Library,
    moments: tuple[ClipTime, ClipTime],
    changes: dict[str, Callable[[Any], Any]],
    field: str,
) -> None:
    """Joints missing, numbers that are none, quaternions of no length: the block is named."""
    pose = broken(at(small_library, moments[1]), **changes)
    with pytest.raises(InvalidRequestError) as raised:
        either.blend(moments[0], pose, FIVE)
    assert {v.field for v in raised.value.violations} == {f"end.inline.{field}"}


@pytest.mark.parametrize(
    ("moment", "error"),
    [
        (ClipTime("nobody", 0.0), NotFoundError),
        (ClipTime("nobody", 0.0, "nowhere"), NotFoundError),
    ],
)
def test_unknown_references_are_not_found(
    either: Any, moments: tuple[ClipTime, ClipTime], moment: ClipTime, error: type[Exception]
) -> None:
    """NOT_FOUND for a clip or a library that is not there."""
    with pytest.raises(error):
        either.blend(moments[0], moment, FIVE)


def test_a_time_outside_of_the_clip_is_named(
    either: Any, moments: tuple[ClipTime, ClipTime]
) -> None:
    """The message says how long the clip is."""
    late = ClipTime(moments[0].clip, 1e6)
    with pytest.raises(InvalidRequestError, match="lasts from 0 to") as raised:
        either.blend(moments[0], late, FIVE)
    assert raised.value.violations[0].field == "end.clip.time_s"


def test_many_name_the_request(either: Any, moments: tuple[ClipTime, ClipTime]) -> None:
    """The path has the place of the pair; none, too many and too many weights are refused."""
    good = BlendQuery(*moments, FIVE)
    for requests, field in (
        ([good, BlendQuery(*moments, (7.0,))], "requests[1].weights[0]"),
        ([], "requests"),
        ([good] * 1001, "requests"),
        ([BlendQuery(*moments, np.zeros(6000))] * 2, "requests"),
    ):
        with pytest.raises(InvalidRequestError) as raised:
            either.blend_many(requests)
        assert raised.value.violations[0].field == field
