"""Standing: who stands stays in one clip, which goes forth and back without a seam."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from stridewire._messages import ClipEnd, Frame, Step, Transition
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session, TickSettings, sampling, standing
from unit.runtime.conftest import DT, opening

Walk = Callable[..., Iterator[Frame]]
SECONDS = 20.0


@pytest.fixture
def session(runtime: Runtime) -> Session:
    """Return a session of four characters."""
    return runtime.open(opening(4))


def test_who_stands_needs_no_transition(runtime: Runtime, session: Session, walk: Walk) -> None:
    """Twenty seconds of standing, longer than any clip, hold no transition and no clip's end."""
    list(walk(session, 2.0, (0.0, 0.0)))
    state, library = session.crowd.state, session.crowd.library
    assert (library.clip_frames[state.clip] < SECONDS * library.frame_rate).all()
    events = [e for frame in walk(session, SECONDS, (0.0, 0.0)) for e in frame.events]
    assert not [e for e in events if isinstance(e, Transition | ClipEnd)]


def test_playback_turns_round_smoothly_and_stays_in_its_span(
    small_library: Library, session: Session, walk: Walk
) -> None:
    """Forth and back both come, the pace never steps, and the clip is never left."""
    spans = standing.Spans.of(small_library, TickSettings().clip_end_margin)
    list(walk(session, 2.0, (0.0, 0.0)))
    state, paces = session.crowd.state, []
    for _ in walk(session, SECONDS, (0.0, 0.0)):
        row = sampling.moments(small_library, state.clip, state.clip_time).nearest
        assert (spans.first[row] >= 0).all()
        paces.append(state.pace.copy())
    assert np.min(paces) < -0.5
    assert np.max(paces) > 0.5
    # a damper of 0.2 s makes 5.6 % of the way from 1 to -1 in a frame
    assert np.abs(np.diff(paces, axis=0)).max() < 0.12


def test_who_goes_back_walks_off_forwards(session: Session, walk: Walk) -> None:
    """A command ends standing at once: a transition within a few frames, at the clip's own pace."""
    list(walk(session, 6.0, (0.0, 0.0)))
    frames = list(walk(session, 0.5, (0.0, 1.4)))
    moved = {e.character for f in frames for e in f.events if isinstance(e, Transition)}
    assert moved == {10, 11, 12, 13}
    assert np.all(session.crowd.state.pace > 0.9)


def test_standing_is_the_same_however_time_is_cut(small_library: Library) -> None:
    """A frame of a tenth of a second goes about as far as six of a sixtieth."""
    places = []
    for dt in (DT, 6 * DT):
        runtime = Runtime([small_library], clock=lambda: 0.0)
        one = runtime.open(opening(1))
        for i in range(round(4.0 / dt)):
            runtime.advance([(one, Step(i, dt, velocity_xz=[[0.0, 0.0]]))])
        places.append(one.crowd.state.root_position[0].copy())
    assert np.allclose(*places, atol=0.02)
