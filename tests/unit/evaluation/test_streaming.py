"""Streaming for evaluation is the serving tick, with what is forced on it made around it."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, GroundPose, Open, Step
from stridewire_engine.evaluation.captured import Captured
from stridewire_engine.evaluation.cell import Cell
from stridewire_engine.evaluation.figures import Judged
from stridewire_engine.evaluation.naive import naive_streams
from stridewire_engine.evaluation.streaming import Stream, perturbed, streams, wanted_of
from stridewire_engine.evaluation.tally import interval
from stridewire_engine.library import Library
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime import Runtime

CELL = Cell("u-turns", seeds=(3,), seconds=4.0)


@pytest.fixture(scope="module")
def matcher(small_library: Library) -> Matcher:
    """Return the small library's index."""
    return Matcher(small_library)


def made(library: Library, matcher: Matcher, cell: Cell) -> Stream:
    """Return the stream of a cell."""
    return next(streams(library, matcher, [cell], [wanted_of(cell)]))


def test_what_is_measured_is_what_is_served(small_library: Library, matcher: Matcher) -> None:
    """A session of the runtime with the same places and controls sends the same poses."""
    measured = made(small_library, matcher, CELL)
    asked = wanted_of(CELL)
    yaw = np.arctan2(asked.velocity[0, :, 0], asked.velocity[0, :, 1])
    specs = [CharacterSpec(i, GroundPose((3.0 * i, 0.0, 0.0), float(yaw[i]))) for i in range(2)]
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(Open(specs, seed=3))
    for i, (velocity, facing) in enumerate(zip(*asked, strict=True)):
        step = Step(i, 1.0 / 60.0, velocity_xz=velocity, facing_yaw=facing)
        ((frame, _),) = runtime.advance([(session, step)])
        assert np.allclose(frame.rotations, measured.pose.rotations[i], atol=1e-5)
        assert np.allclose(frame.root[:, :3], measured.pose.root_position[i], atol=1e-4)


def test_transitions_come_when_forced(small_library: Library, matcher: Matcher) -> None:
    """Every character jumps every 20 frames, whatever it costs; clip ends may add some."""
    forced = made(small_library, matcher, replace(CELL, forced_interval_frames=20))
    frames = len(forced.rows)
    for character in range(2):
        mine = np.sort(forced.seams.frame[forced.seams.character == character])
        assert len(mine) >= frames // 20 - 1
        assert np.diff(mine).max() <= 21
    assert forced.since[:25].max() >= 1000
    assert forced.since[60:].max() <= 20


def test_cells_that_share_their_ticks_do_not_meet(small_library: Library, matcher: Matcher) -> None:
    """Two scripts and two stitchers in one tick show what each shows alone, to 1e-5."""
    cells = [CELL, replace(CELL, script="stroll", stitch="stance", foot_lock=False)]
    both = streams(small_library, matcher, cells, [wanted_of(cell) for cell in cells])
    for cell, together in zip(cells, both, strict=True):
        alone = made(small_library, matcher, cell)
        assert np.array_equal(together.rows, alone.rows)
        assert np.array_equal(together.seams.frame, alone.seams.frame)
        assert np.allclose(together.positions, alone.positions, atol=1e-5)


def test_a_lower_rank_is_a_worse_match(small_library: Library, matcher: Matcher) -> None:
    """The fortieth match is another one than the best, and the stream stays whole."""
    cell = replace(CELL, forced_interval_frames=20)
    best, bad = (made(small_library, matcher, replace(cell, match_rank=k)) for k in (1, 40))
    assert not np.array_equal(best.rows, bad.rows)
    assert np.isfinite(bad.positions).all()


def test_a_perturbed_library_leaves_the_true_one_alone(small_library: Library) -> None:
    """Roots go 1.2 times as far, labels come three frames late, the original keeps both."""
    before = small_library.contacts.copy()
    other = perturbed(small_library, 1.2, 3)
    assert np.allclose(other.root_position, 1.2 * small_library.root_position)
    entry = small_library.clips[0]
    rows = slice(entry.start, entry.start + entry.frames)
    assert np.array_equal(other.contacts[rows][3:], small_library.contacts[rows][:-3])
    assert np.array_equal(small_library.contacts, before)


def test_the_naive_baseline_slides_and_locks_nothing(
    small_library: Library, matcher: Matcher
) -> None:
    """Without foot work its planted toes slide at least twice as fast as those of stance."""
    captured, every = Captured(small_library), np.ones((240, 2), bool)
    ours = made(small_library, matcher, replace(CELL, stitch="stance"))
    naive = next(naive_streams(small_library, matcher, [CELL], [wanted_of(CELL)]))
    assert np.isnan(naive.foot_targets).all()
    sliding = [
        interval(Judged(one, captured).streamed(every)["sliding_c_cm_s"])[0]
        for one in (ours, naive)
    ]
    assert sliding[1] > 2.0 * sliding[0]
