"""The compiled passes of a tick: the same motion as by numpy, which is the reference."""

from collections.abc import Iterator

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, Detail, Frame, GroundPose, Open, Step
from stridewire.scripts import script
from stridewire_engine import compiled
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime
from stridewire_engine.stitchers import STITCHER_NAMES
from unit.runtime.conftest import DT

pytestmark = pytest.mark.skipif(not compiled.ENABLED, reason="numba is absent")


def streamed(
    library: Library, names: tuple[str, ...], ticks: int, rate: float = 1.0
) -> Iterator[Frame]:
    """Yield the frames of four characters a stitcher under `random-stick`, some of them paused."""
    specs = [
        CharacterSpec(i, GroundPose((3.0 * i, 0.2, -i), 0.7 * i), stitcher=names[i % len(names)])
        for i in range(4 * len(names))
    ]
    runtime = Runtime([library])
    session = runtime.open(Open(characters=specs, detail=Detail.EVENTS, seed=3))
    for i in range(ticks):
        asked = script("random-stick").controls(i * DT, len(specs), 5)
        dt = 0.0 if i % 37 == 36 else DT * rate
        step = Step(i, dt, velocity_xz=asked.velocity, facing_yaw=asked.facing)
        ((frame, _),) = runtime.advance([(session, step)])
        yield frame


@pytest.mark.parametrize(
    ("names", "rate"),
    [(STITCHER_NAMES, 1.0), (("refine",), 1.0), (("stance",), 2.3), (("refine", "spring"), 0.3)],
)
def test_both_ways_show_the_same(
    small_library: Library, monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...], rate: float
) -> None:
    """Clips and times are equal, poses, roots and feet to 1e-4, for every stitcher and rate."""
    ours = list(streamed(small_library, names, 150, rate))
    monkeypatch.setattr(compiled, "ENABLED", False)
    for mine, theirs in zip(ours, streamed(small_library, names, 150, rate), strict=True):
        assert tuple(mine.events) == tuple(theirs.events)
        assert np.array_equal(mine.contacts, theirs.contacts)
        for name in ("root", "root_delta", "hips", "rotations", "foot_targets"):
            a, b = getattr(mine, name), getattr(theirs, name)
            np.testing.assert_allclose(a, b, atol=1e-4, err_msg=name)


def test_a_character_alone_is_shown_as_among_others(small_library: Library) -> None:
    """What a compiled pass does for a row does not depend on the other rows, to the bit."""
    crowd = list(streamed(small_library, ("stance",), 60))
    runtime = Runtime([small_library])
    spec = CharacterSpec(0, GroundPose((0.0, 0.2, 0.0)), stitcher="stance")
    session = runtime.open(Open(characters=[spec], detail=Detail.EVENTS, seed=3))
    for i in range(60):
        asked = script("random-stick").controls(i * DT, 4, 5)
        dt = 0.0 if i % 37 == 36 else DT
        step = Step(i, dt, velocity_xz=asked.velocity[:1], facing_yaw=asked.facing[:1])
        ((frame, _),) = runtime.advance([(session, step)])
        np.testing.assert_allclose(frame.rotations[0], crowd[i].rotations[0], atol=1e-6)
