"""Blends: exact ends, no jumps, masks, fallbacks that say why, many pairs as one."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import BlendMethod
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.kinematics import forward_world
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.blending import Blended, Pair, blend
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.networks.blend import blend_network

EXACT = 1e-6
"""Largest difference at the ends; rotations are the very numbers."""

MakePair = Callable[..., Pair]


@pytest.fixture(scope="module")
def walk() -> Clip:
    """Return a walk."""
    return next(clip for clip in synthetic_clips() if clip.name == "walk-1.4")


@pytest.fixture
def pair(walk: Clip) -> MakePair:
    """Return a maker of pairs of moments of the walk."""

    def make(start_s: float = 1.0, end_s: float = 1.6, steps: int = 5, **changes: object) -> Pair:
        made = Pair(
            walk.sample(start_s),
            walk.sample(end_s),
            np.linspace(0.0, 1.0, steps),
            np.ones(len(REFERENCE)),
            duration=end_s - start_s,
        )
        return replace(made, **changes)  # type: ignore[arg-type]

    return make


def one(pair: Pair) -> Blended:
    """Blend one pair."""
    (blended,) = blend([pair], blend_network())
    return blended


def moved(pair: Pair, x: float) -> Pair:
    """Return the pair elsewhere in the world."""
    there = np.array([x, 0.0, -x])
    return replace(
        pair,
        start=replace(pair.start, root_position=pair.start.root_position + there),
        end=replace(pair.end, root_position=pair.end.root_position + there),
    )


@pytest.mark.parametrize("method", BlendMethod)
@pytest.mark.parametrize("far", [0.0, 1000.0])
def test_ends_are_exact(pair: MakePair, method: BlendMethod, far: float) -> None:
    """Weight 0 gives the start and 1 the end, also a kilometre from the origin."""
    asked = moved(pair(method=method), far)
    pose = one(asked).pose
    for at, side in ((0, asked.start), (-1, asked.end)):
        for name in ("root_position", "root_rotation", "hips", "rotations"):
            np.testing.assert_allclose(
                getattr(pose, name)[at], getattr(side, name), rtol=EXACT, atol=EXACT
            )


@pytest.mark.parametrize("start_s", [0.3, 1.0, 1.35, 2.1])
def test_nothing_jumps_along_the_weight(pair: MakePair, start_s: float) -> None:
    """Over 101 weights no joint's step is larger than twice the larger of its neighbours."""
    blended = one(pair(start_s, start_s + 0.7, 101))
    assert blended.method is BlendMethod.NEURAL
    positions = forward_world(REFERENCE, blended.pose)[0]
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1)
    beside = np.maximum(steps[:-2], steps[2:])
    assert np.all(steps[1:-1] <= 2.0 * beside + 1e-3)


def test_finer_weights_make_finer_steps(pair: MakePair) -> None:
    """Ten times as many weights, a tenth of the largest step: it is continuous."""
    coarse, fine = (
        np.abs(np.diff(one(pair(steps=n)).pose.rotations, axis=0)).max() for n in (101, 1001)
    )
    assert fine < 0.2 * coarse


def test_a_masked_joint_takes_its_share(pair: MakePair) -> None:
    """Share 0 keeps the start's rotation, share a half is half-way at weight 1."""
    head, hand = REFERENCE.index("Head"), REFERENCE.index("LeftArm")
    shares = np.ones(len(REFERENCE))
    shares[head], shares[hand] = 0.0, 0.5
    asked = pair(shares=shares)
    pose = one(asked).pose
    plain = one(pair()).pose
    np.testing.assert_allclose(
        pose.rotations[:, head], np.tile(asked.start.rotations[head], (5, 1)), atol=EXACT
    )
    np.testing.assert_allclose(pose.rotations[-1, hand], plain.rotations[2, hand], atol=1e-5)


def test_the_linear_method_is_linear(pair: MakePair) -> None:
    """Half-way each joint has turned half its way, in the parent's frame."""
    asked = pair(steps=3, method=BlendMethod.SLERP)
    blended = one(asked)
    assert (blended.method, blended.reason) == (BlendMethod.SLERP, "")
    half = quaternion.slerp(asked.start.rotations, asked.end.rotations, np.array(0.5))
    np.testing.assert_allclose(
        np.abs(np.sum(blended.pose.rotations[1, 1:] * half[1:], axis=-1)), 1.0, atol=1e-5
    )


def test_the_network_changes_the_way(pair: MakePair) -> None:
    """What it gives between differs from the linear blend."""
    neural, linear = one(pair()), one(pair(method=BlendMethod.SLERP))
    assert neural.method is BlendMethod.NEURAL
    assert np.abs(neural.pose.rotations[2] - linear.pose.rotations[2]).max() > 1e-3


def test_one_posture_is_blended_to_itself(pair: MakePair) -> None:
    """Between a moment and itself there is nothing else, whatever time is said to lie between."""
    blended = one(pair(1.0, 1.0, method=BlendMethod.NEURAL, duration=0.5))
    assert blended.method is BlendMethod.NEURAL
    positions = forward_world(REFERENCE, blended.pose)[0]
    np.testing.assert_allclose(
        positions, np.broadcast_to(positions[:1], positions.shape), atol=EXACT
    )


@pytest.mark.parametrize("method", [BlendMethod.NEURAL, BlendMethod.AUTO])
def test_what_is_too_far_out_is_blended_linearly(
    pair: MakePair, random_pose: Callable[..., Pose], method: BlendMethod
) -> None:
    """Joints turned at random are like nothing in the training data; the answer says so."""
    blended = one(pair(start=random_pose(), end=random_pose(), method=method))
    assert blended.method is BlendMethod.SLERP
    assert "too unlike what the network was trained on" in blended.reason


def test_long_pairs_are_blended_linearly_unless_asked(pair: MakePair) -> None:
    """AUTO leaves 3 s to the linear blend and says why; NEURAL is obeyed."""
    auto = one(pair(duration=3.0))
    assert auto.method is BlendMethod.SLERP
    assert "trained on up to 1 s" in auto.reason
    assert one(pair(duration=3.0, method=BlendMethod.NEURAL)).method is BlendMethod.NEURAL


def test_many_pairs_are_each_pair(pair: MakePair) -> None:
    """A batch of pairs, methods and numbers of weights gives what each gives alone."""
    pairs = [
        pair(0.2, 0.6, 3),
        pair(1.0, 1.9, 7, method=BlendMethod.SLERP),
        pair(2.0, 2.3, 1, ground=0.1),
    ]
    for together, asked in zip(blend(pairs, blend_network()), pairs, strict=True):
        alone = one(asked)
        assert together.method is alone.method
        np.testing.assert_allclose(together.pose.rotations, alone.pose.rotations, atol=1e-5)
        np.testing.assert_allclose(together.pose.hips, alone.pose.hips, atol=1e-5)


def test_the_place_and_the_ground_do_not_matter(pair: MakePair) -> None:
    """A pair moved up a hill whose height is told blends alike."""
    up = np.array([4.0, 2.5, 1.0])
    here = pair()
    there = replace(
        here,
        start=replace(here.start, root_position=here.start.root_position + up),
        end=replace(here.end, root_position=here.end.root_position + up),
        ground=2.5,
    )
    low, high = one(here).pose, one(there).pose
    np.testing.assert_allclose(high.rotations, low.rotations, atol=1e-5)
    np.testing.assert_allclose(high.root_position, low.root_position + up, atol=1e-5)


def test_feet_stay_out_of_the_ground(walk: Clip, pair: MakePair) -> None:
    """No toe is lower than at both ends and at rest, to a millimetre."""
    for start_s in np.arange(0.0, 3.0, 0.25):
        toes = _toes(one(pair(start_s, start_s + 0.8, 21)).pose)
        lowest = np.minimum(np.minimum(toes[0], toes[-1]), 0.02)
        assert np.all(toes >= lowest - 1e-3)


def _toes(pose: Pose) -> Floats:
    positions = forward_world(REFERENCE, pose)[0]
    return positions[:, REFERENCE.indices(["LeftToe", "RightToe"]), 1]


def test_a_foot_that_stands_stays(walk: Clip, pair: MakePair) -> None:
    """Where a toe is on one spot at both ends it is there at every weight."""
    toe = REFERENCE.index("LeftToe")
    found = 0
    for start_s in np.arange(0.0, 4.0, 0.1):
        blended = one(pair(start_s, start_s + 0.3, 9))
        places = forward_world(REFERENCE, blended.pose)[0][:, toe]
        if places[:, 1].max() < 0.05 and np.linalg.norm(places[-1] - places[0]) < 0.015:
            found += 1
            away = np.linalg.norm((places - places[0])[:, [0, 2]], axis=-1)
            assert away.max() < 0.03
    assert found > 3
