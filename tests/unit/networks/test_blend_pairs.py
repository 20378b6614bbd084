"""Pairs: from one clip, with the captured postures between, in the start's frame."""

import numpy as np
import pytest

from stridewire.motion.clip import Clip
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.networks.blend.pairs import Frames


@pytest.fixture(scope="module")
def clips() -> list[Clip]:
    """Return a few clips of different length."""
    return synthetic_clips()[:4]


@pytest.fixture(scope="module")
def frames(clips: list[Clip]) -> Frames:
    """Return their frames."""
    return Frames.of(clips)


def test_the_truth_at_the_ends_is_start_and_end(frames: Frames) -> None:
    """Weight 0 and 1 of the captured way are the ends of the pair."""
    pairs = frames.every(0.5, 1.0, np.array([0.0, 0.5, 1.0]))
    np.testing.assert_allclose(pairs.truth.hips[:, 0], pairs.start.hips, atol=1e-5)
    np.testing.assert_allclose(pairs.truth.hips[:, 2], pairs.end.hips, atol=1e-5)
    np.testing.assert_array_equal(pairs.truth.rotations[:, 2, 5], pairs.end.rotations[:, 5])


def test_pairs_start_at_the_origin_and_look_ahead(frames: Frames) -> None:
    """The start's hips are above the origin and look along +Z."""
    pairs = frames.every(0.3, 0.7, np.array([0.5]))
    np.testing.assert_allclose(pairs.start.hips[:, [0, 2]], 0.0, atol=1e-5)
    forward = 2.0 * (
        pairs.start.rotations[:, 0, 1] * pairs.start.rotations[:, 0, 3]
        + pairs.start.rotations[:, 0, 0] * pairs.start.rotations[:, 0, 2]
    )
    np.testing.assert_allclose(forward, 0.0, atol=1e-5)


def test_pairs_stay_within_their_clip(frames: Frames, rng: np.random.Generator) -> None:
    """No row of a pair lies outside of the clip that it names; durations are 0.1 to 1 s."""
    pairs = frames.draw(rng, 500, 6)
    first = frames.starts[pairs.clip][:, None]
    last = first + frames.lengths[pairs.clip][:, None] - 1
    assert np.all((pairs.rows >= first) & (pairs.rows <= last))
    assert pairs.duration.min() >= 0.1 - 1e-6
    assert pairs.duration.max() <= 1.0 + 1e-6
    assert np.ptp(pairs.duration) > 0.5


def test_the_same_seed_draws_the_same_pairs(frames: Frames) -> None:
    """Drawing is by the generator alone."""
    a, b = (frames.draw(np.random.default_rng(3), 20, 2) for _ in range(2))
    np.testing.assert_array_equal(a.rows, b.rows)


def test_mirrored_copies_double_the_frames(clips: list[Clip], frames: Frames) -> None:
    """Mirroring adds each clip once more, left and right exchanged."""
    both = Frames.of(clips, mirror=True)
    half = len(frames.postures.hips)
    assert len(both.postures.hips) == 2 * half
    np.testing.assert_allclose(both.postures.hips[half:, 0], -both.postures.hips[:half, 0])
    np.testing.assert_array_equal(both.contacts[half:, :2], both.contacts[:half, 2:])


def test_clips_too_short_are_refused(clips: list[Clip]) -> None:
    """Nothing to draw from is an error, not an empty batch."""
    with pytest.raises(ValueError, match="long enough"):
        Frames.of([clips[0].cut(0, 5)])
