"""Inertialization: what is shown goes on in value and rate, whenever the jump comes."""

import numpy as np
import pytest

from stridewire.motion import quaternion
from stridewire_engine.stitchers import STITCHERS, Stitcher
from stridewire_engine.stitchers.cut import Cut
from stridewire_engine.stitchers.dead_blend import DeadBlend
from stridewire_engine.stitchers.inertialization import SpringInertialization
from stridewire_engine.stitchers.quintic import QuinticInertialization, quintic
from unit.stitchers.motions import ROOTS, N, advance, angles, empty, random_motion, sample_of

TINY = np.full(N, 1e-6)
CONTINUOUS: tuple[Stitcher, ...] = (SpringInertialization(), DeadBlend())


def by_name(stitcher: Stitcher) -> str:
    """Return a name for a parameter."""
    return stitcher.name


def shown(stitcher: Stitcher, state: object, motion: object, dt: np.ndarray) -> tuple:
    """Let time pass as the tick does, and apply."""
    state.stitch_time += dt  # type: ignore[attr-defined]
    return stitcher.apply(state, sample_of(motion), dt)  # type: ignore[arg-type]


@pytest.mark.parametrize("stitcher", [*CONTINUOUS, QuinticInertialization()], ids=by_name)
def test_values_continue(rng: np.random.Generator, stitcher: Stitcher) -> None:
    """Right after a jump the shown pose is the old one."""
    state, source, target = empty(), random_motion(rng), random_motion(rng)
    stitcher.begin(state, source, target, ROOTS)
    hips, rotations = shown(stitcher, state, target, np.zeros(N))
    assert np.allclose(hips, source.hips, atol=1e-12)
    assert np.allclose(np.abs(np.sum(rotations * source.rotations, axis=-1)), 1.0, atol=1e-12)


@pytest.mark.parametrize("stitcher", CONTINUOUS, ids=by_name)
def test_rates_continue(rng: np.random.Generator, stitcher: Stitcher) -> None:
    """What is shown moves on at the old rates, even across large differences."""
    state, source, target = empty(), random_motion(rng), random_motion(rng)
    stitcher.begin(state, source, target, ROOTS)
    hips, before = shown(stitcher, state, target, np.zeros(N))
    later, after = shown(stitcher, state, advance(target, TINY[0]), TINY)
    assert np.allclose((later - hips) / TINY[0], source.hips_velocity, atol=1e-2)
    assert np.allclose(angles(after, before) / TINY[0], source.angular_velocity, atol=1e-2)


@pytest.mark.parametrize("first", [*CONTINUOUS, QuinticInertialization()], ids=by_name)
@pytest.mark.parametrize("second", [*CONTINUOUS, QuinticInertialization()], ids=by_name)
def test_any_stitcher_takes_over_from_any_other(
    rng: np.random.Generator, first: Stitcher, second: Stitcher
) -> None:
    """A jump in the middle of a transition continues what is shown, offsets and all."""
    state = empty()
    one, two, three = (random_motion(rng) for _ in range(3))
    first.begin(state, one, two, ROOTS)
    before_hips, before = shown(first, state, two, np.full(N, 0.05))
    state.stitch_time[...] = 0.0
    second.begin(state, two, three, ROOTS)
    hips, rotations = shown(second, state, three, np.zeros(N))
    assert np.allclose(hips, before_hips, atol=1e-12)
    assert np.allclose(np.abs(np.sum(rotations * before, axis=-1)), 1.0, atol=1e-9)


def test_springs_die_out(rng: np.random.Generator) -> None:
    """After `settled_s` about a tenth of an offset at rest is left, after a second nothing."""
    stitcher, state = SpringInertialization(), empty()
    still = random_motion(rng)._replace(hips_velocity=np.zeros((N, 3)))
    target = still._replace(hips=still.hips + 1.0)
    stitcher.begin(state, still, target, ROOTS)
    hips, _ = shown(stitcher, state, target, np.full(N, stitcher.settled_s))
    assert np.allclose(np.abs(hips - target.hips), 0.1, atol=0.01)
    hips, _ = shown(stitcher, state, target, np.ones(N))
    assert np.allclose(hips, target.hips, atol=1e-4)


@pytest.mark.parametrize("stitcher", [DeadBlend(), QuinticInertialization()], ids=by_name)
def test_ends_in_time(rng: np.random.Generator, stitcher: Stitcher) -> None:
    """After `settled_s` the clip is shown, exactly."""
    state, source, target = empty(), random_motion(rng), random_motion(rng)
    stitcher.begin(state, source, target, ROOTS)
    hips, rotations = shown(stitcher, state, target, np.full(N, stitcher.settled_s))
    assert np.allclose(hips, target.hips, atol=1e-9)
    assert np.allclose(angles(rotations, target.rotations), 0.0, atol=1e-9)


def test_the_step_does_not_matter(rng: np.random.Generator) -> None:
    """One step of 50 ms equals five of 10 ms."""
    stitcher = SpringInertialization()
    source, target = random_motion(rng), random_motion(rng)
    once, often = empty(), empty()
    stitcher.begin(once, source, target, ROOTS)
    stitcher.begin(often, source, target, ROOTS)
    hips, _ = shown(stitcher, once, target, np.full(N, 0.05))
    for _ in range(5):
        again, _ = shown(stitcher, often, target, np.full(N, 0.01))
    assert np.allclose(hips, again, atol=1e-12)


def test_the_long_way_round_is_never_taken() -> None:
    """A difference of 350 degrees is an offset of 10."""
    stitcher, state = SpringInertialization(), empty()
    motion = random_motion(np.random.default_rng(1))
    joints = motion.rotations.shape[1]
    identity = quaternion.identity(N, joints, dtype=np.float64)
    turned = np.tile(quaternion.from_axis_angle((0.0, 1.0, 0.0), np.radians(350.0)), (N, joints, 1))
    still = motion._replace(rotations=identity, angular_velocity=np.zeros((N, joints, 3)))
    stitcher.begin(state, still._replace(rotations=turned), still, ROOTS)
    assert np.allclose(np.linalg.norm(state.offset_rotations, axis=-1), np.radians(10.0))


def test_a_quintic_starts_and_ends_as_asked() -> None:
    """Value and slope at the start are those given, at the end both are nothing, and it falls."""
    x0, v0, end = np.array([0.5, 1.0]), np.array([-2.0, 0.0]), np.array([0.4, 0.3])
    assert np.allclose(quintic(x0, v0, end, np.zeros(2)), (x0, v0))
    value, slope = quintic(x0, v0, end, end - 1e-9)
    assert np.allclose(value, 0.0, atol=1e-9)
    assert np.allclose(slope, 0.0, atol=1e-6)
    middle = np.stack([quintic(x0, v0, end, s * end)[0] for s in np.linspace(0, 1, 30)])
    assert np.all(np.diff(middle, axis=0) <= 1e-12)


def test_interruptions_shorten_what_follows(rng: np.random.Generator) -> None:
    """A quintic that was interrupted after 0.1 s leaves the next one less time."""
    stitcher, state = QuinticInertialization(0.4), empty()
    one, two = random_motion(rng), random_motion(rng)
    stitcher.begin(state, one, two, ROOTS)
    first = state.curve_end.max()
    shown(stitcher, state, two, np.full(N, 0.1))
    stitcher.begin(state, two, one, ROOTS)
    assert first == pytest.approx(0.4)
    assert state.curve_end.max() < 0.3


def test_dead_blending_never_overshoots(rng: np.random.Generator) -> None:
    """Hips at rest go straight to the new clip's, never beyond: no offset changes its sign."""
    stitcher, state = DeadBlend(), empty()
    source = random_motion(rng)._replace(hips_velocity=np.zeros((N, 3)))
    target = random_motion(rng)
    stitcher.begin(state, source, target, ROOTS)
    begin = source.hips - target.hips
    for _ in range(30):
        hips, _ = shown(stitcher, state, target, np.full(N, 1 / 60))
        part = (hips - target.hips) / begin
        assert np.all((part >= -1e-9) & (part <= 1.0 + 1e-9))


def test_none_hides_nothing(rng: np.random.Generator) -> None:
    """The stitcher `none` forgets every offset and shows the clip."""
    state = empty()
    SpringInertialization().begin(state, random_motion(rng), random_motion(rng), ROOTS)
    target = random_motion(rng)
    cut = Cut()
    cut.begin(state, random_motion(rng), target, ROOTS)
    hips, rotations = shown(cut, state, target, TINY)
    assert np.array_equal(hips, target.hips)
    assert np.array_equal(rotations, target.rotations)
    assert not state.offset_rotations.any()


@pytest.mark.parametrize("stitcher", STITCHERS, ids=by_name)
def test_float32_stays_float32(rng: np.random.Generator, stitcher: Stitcher) -> None:
    """The tick's float32 is kept."""
    state = empty(np.float32)
    source, target = random_motion(rng, dtype=np.float32), random_motion(rng, dtype=np.float32)
    stitcher.begin(state, source, target, ROOTS)
    dt = np.full(N, 1 / 60, np.float32)
    hips, rotations = stitcher.apply(state, sample_of(target), dt)
    assert hips.dtype == rotations.dtype == np.float32
