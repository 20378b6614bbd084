"""`auto`: the spring where it drags no planted foot, stance anywhere else."""

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, GroundPose, Open, Step
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_engine.stitchers import STITCHER_NAMES
from stridewire_engine.stitchers.auto import spring_will_do

TIMES = np.arange(24) / 60.0


@pytest.mark.parametrize(
    ("gap", "lands_at", "spring"),
    [(0.01, 0, True), (0.05, 0, False), (0.05, 12, True), (0.05, 3, False), (0.3, 99, True)],
)
def test_a_spring_will_do_where_it_drags_no_planted_toe(
    gap: float, lands_at: int, spring: bool
) -> None:
    """Small gaps, and wide ones that are closed before the toe lands, or where none lands."""
    gaps = np.zeros((1, 2, 3))
    gaps[0, 1, 2] = gap
    planted = np.zeros((1, len(TIMES), 2), bool)
    planted[0, lands_at:, 1] = True
    assert spring_will_do(gaps, 0.0 * gaps, planted, TIMES)[0] == spring


def test_height_alone_drags_nothing() -> None:
    """A toe that only stands higher is lowered, not dragged."""
    gaps = np.zeros((1, 2, 3))
    gaps[..., 1] = 0.2
    planted = np.ones((1, len(TIMES), 2), bool)
    assert spring_will_do(gaps, 0.0 * gaps, planted, TIMES)[0]


def test_characters_take_the_better_of_two(small_library: Library) -> None:
    """Characters that turn now and then are stitched by spring or refine, by nothing else."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    specs = [CharacterSpec(i, GroundPose((3.0 * i, 0, 0)), stitcher="auto") for i in range(6)]
    session = runtime.open(Open(specs, seed=5))
    used = set()
    for i in range(240):
        velocity = np.tile([[1.4, 0.0], [0.0, 1.4]][i // 60 % 2], (6, 1))
        runtime.advance([(session, Step(i, 1 / 60, velocity_xz=velocity))])
        used |= {STITCHER_NAMES[by] for by in session.crowd.state.stitched_by}
    assert "refine" in used
    assert used <= {"spring", "refine"}
