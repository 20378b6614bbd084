"""Inertialization: what is shown goes on in value and rate, whenever the jump comes."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire_engine.stitchers import STITCHERS, Motion, StitchState
from stridewire_engine.stitchers.cut import Cut
from stridewire_engine.stitchers.inertialization import SpringInertialization

N, J = 5, 22
TINY = np.full(N, 1e-6)


def empty() -> StitchState:
    """Return a state without offsets, in float64 so that rates can be measured."""
    return StitchState(np.zeros((N, 3)), np.zeros((N, 3)), np.zeros((N, J, 3)), np.zeros((N, J, 3)))


def random_motion(rng: np.random.Generator, spread: float = 0.5) -> Motion:
    """Return arbitrary poses and rates."""
    return Motion(
        rng.normal(size=(N, 3)),
        quaternion.from_scaled_axis(rng.normal(scale=spread, size=(N, J, 3))),
        rng.normal(size=(N, 3)),
        rng.normal(size=(N, J, 3)),
    )


def advance(motion: Motion, dt: float) -> Motion:
    """Go on along the motion's rates."""
    turned = quaternion.multiply(
        quaternion.from_scaled_axis(motion.angular_velocity * dt), motion.rotations
    )
    return motion._replace(hips=motion.hips + motion.hips_velocity * dt, rotations=turned)


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the rotation vectors from b to a."""
    return quaternion.to_scaled_axis(quaternion.multiply(a, quaternion.conjugate(b)))


def test_value_and_rate_continue(rng: np.random.Generator) -> None:
    """Right after a jump the shown pose is the old one, moving on at the old rate."""
    stitcher, state = SpringInertialization(), empty()
    source, target = random_motion(rng), random_motion(rng)
    stitcher.begin(state, source, target)
    hips, rotations = stitcher.apply(state, target.hips, target.rotations, np.zeros(N))
    assert np.allclose(hips, source.hips, atol=1e-12)
    assert np.allclose(np.abs(np.sum(rotations * source.rotations, axis=-1)), 1.0, atol=1e-12)
    soon = advance(target, TINY[0])
    later_hips, _ = stitcher.apply(state, soon.hips, soon.rotations, TINY)
    assert np.allclose((later_hips - hips) / TINY[0], source.hips_velocity, atol=1e-2)


def test_angular_rate_continues(rng: np.random.Generator) -> None:
    """The angular velocity goes on, too, even across large differences."""
    stitcher, state = SpringInertialization(), empty()
    source, target = random_motion(rng), random_motion(rng)
    stitcher.begin(state, source, target)
    soon = advance(target, TINY[0])
    _, before = stitcher.apply(state, target.hips, target.rotations, np.zeros(N))
    _, after = stitcher.apply(state, soon.hips, soon.rotations, TINY)
    assert np.allclose(angles(after, before) / TINY[0], source.angular_velocity, atol=1e-2)


def test_a_second_jump_in_the_middle_continues_what_is_shown(rng: np.random.Generator) -> None:
    """An interruption takes over the shown pose, offsets and all, not the clip's."""
    stitcher, state = SpringInertialization(), empty()
    first, second, third = (random_motion(rng) for _ in range(3))
    stitcher.begin(state, first, second)
    shown_hips, shown = stitcher.apply(state, second.hips, second.rotations, np.full(N, 0.05))
    stitcher.begin(state, second, third)
    hips, rotations = stitcher.apply(state, third.hips, third.rotations, np.zeros(N))
    assert np.allclose(hips, shown_hips, atol=1e-12)
    assert np.allclose(np.abs(np.sum(rotations * shown, axis=-1)), 1.0, atol=1e-12)


def test_offsets_die_out(rng: np.random.Generator) -> None:
    """After `settled_s` about a tenth of an offset at rest is left, after a second nothing."""
    stitcher, state = SpringInertialization(), empty()
    still = random_motion(rng)._replace(hips_velocity=np.zeros((N, 3)))
    target = still._replace(hips=still.hips + 1.0)
    stitcher.begin(state, still, target)
    hips, _ = stitcher.apply(state, target.hips, target.rotations, np.full(N, stitcher.settled_s))
    assert np.allclose(np.abs(hips - target.hips), 0.1, atol=0.01)
    hips, _ = stitcher.apply(state, target.hips, target.rotations, np.ones(N))
    assert np.allclose(hips, target.hips, atol=1e-4)


def test_the_step_does_not_matter(rng: np.random.Generator) -> None:
    """One step of 50 ms equals five of 10 ms."""
    stitcher = SpringInertialization()
    source, target = random_motion(rng), random_motion(rng)
    once, often = empty(), empty()
    stitcher.begin(once, source, target)
    stitcher.begin(often, source, target)
    hips, _ = stitcher.apply(once, target.hips, target.rotations, np.full(N, 0.05))
    for _ in range(5):
        again, _ = stitcher.apply(often, target.hips, target.rotations, np.full(N, 0.01))
    assert np.allclose(hips, again, atol=1e-12)


def test_the_long_way_round_is_never_taken() -> None:
    """A difference of 350 degrees is an offset of 10."""
    stitcher, state = SpringInertialization(), empty()
    identity = quaternion.identity(N, J, dtype=np.float64)
    zero = np.zeros((N, 3))
    turned = np.tile(quaternion.from_axis_angle((0.0, 1.0, 0.0), np.radians(350.0)), (N, J, 1))
    still = Motion(zero, identity, zero, np.zeros((N, J, 3)))
    stitcher.begin(state, still._replace(rotations=turned), still)
    assert np.allclose(np.linalg.norm(state.rotations, axis=-1), np.radians(10.0))


def test_none_hides_nothing(rng: np.random.Generator) -> None:
    """The stitcher `none` forgets every offset and shows the clip."""
    state = empty()
    SpringInertialization().begin(state, random_motion(rng), random_motion(rng))
    target = random_motion(rng)
    cut = Cut()
    cut.begin(state, random_motion(rng), target)
    hips, rotations = cut.apply(state, target.hips, target.rotations, TINY)
    assert np.array_equal(hips, target.hips)
    assert np.array_equal(rotations, target.rotations)
    assert not state.rotations.any()


@pytest.mark.parametrize("stitcher", STITCHERS, ids=lambda stitcher: stitcher.name)
def test_float32_stays_float32(rng: np.random.Generator, stitcher: object) -> None:
    """The tick's float32 is kept."""
    state = StitchState(*(a.astype(np.float32) for a in vars(empty()).values()))
    source, target = (Motion(*(a.astype(np.float32) for a in random_motion(rng))) for _ in range(2))
    stitcher.begin(state, source, target)  # type: ignore[attr-defined]
    dt = np.full(N, 1 / 60, np.float32)
    hips, rotations = stitcher.apply(state, target.hips, target.rotations, dt)  # type: ignore[attr-defined]
    assert hips.dtype == rotations.dtype == np.float32
