"""Fixtures of the runtime's tests."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from stridewire._messages import CharacterSpec, Detail, Frame, GroundPose, Open, Step
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session

DT = 1.0 / 60.0


@pytest.fixture
def runtime(small_library: Library) -> Runtime:
    """Return a runtime over the small library, with a clock that stands still."""
    return Runtime([small_library], clock=lambda: 0.0)


def opening(count: int, **changes: object) -> Open:
    """Return an Open of characters 10, 11 … side by side, three metres apart."""
    specs = [CharacterSpec(10 + i, GroundPose((3.0 * i, 0.0, 0.0))) for i in range(count)]
    return Open(**{"characters": specs, "detail": Detail.COSTS, "seed": 7, **changes})  # type: ignore[arg-type]


def one(runtime: Runtime, session: Session, step: Step | float) -> tuple[Frame, list[str]]:
    """Advance by a step, or by seconds, and return the frame and the fields that were refused."""
    ((frame, error),) = runtime.advance([(session, step)])
    return frame, [violation.field for violation in error.violations] if error else []


@pytest.fixture
def walk(runtime: Runtime) -> Callable[..., Iterator[Frame]]:
    """Return a maker of frames of characters that all have one desired velocity."""

    def frames(
        session: Session, seconds: float, velocity: tuple[float, float], dt: float = DT
    ) -> Iterator[Frame]:
        for i in range(round(seconds / dt)):
            step = Step(i + 1, dt, velocity_xz=np.tile(velocity, (len(session), 1)))
            ((frame, error),) = runtime.advance([(session, step)])
            assert error is None
            yield frame

    return frames
